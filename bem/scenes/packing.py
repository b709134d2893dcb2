"""State of a case in its checkpoint: a frozen dataclass, such as a solution that the case goes on from.

Verified in tests/scenes/test_packing.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from bem.packing import packed, unpacked

if TYPE_CHECKING:
    from bem.scenes.context import Context


def keep(context: Context, state: Any, given: Sequence[Any] = ()) -> None:
    """Replace the checkpoint of a case by its state, which `kept` returns."""
    context.save({"state": packed(state, given)})


def kept(context: Context, given: Sequence[Any] = ()) -> Any:
    """Return the state that was saved last; None for a case that begins."""
    saved = context.saved()
    return None if saved is None else unpacked(saved["state"], given)


def kept_coarser(context: Context, given: Sequence[Any] = ()) -> Any:
    """Return the state saved last on the level before, where an accuracy is refined to; None on the first level."""
    saved = context.coarser()
    return None if saved is None else unpacked(saved["state"], given)
