"""Refinement studies."""

from __future__ import annotations

from bem.verification.rows import Gate


def gates() -> list[Gate]:
    """Gates of refinement."""
    return []
