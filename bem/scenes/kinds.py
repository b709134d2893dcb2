"""Former place of `Kind`, `get_kind` and `kind_names`, for kinds outside the package; import them from `bem.scenes`."""

from bem.scenes.kind import Kind, get_kind, kind_names

__all__ = ["Kind", "get_kind", "kind_names"]
