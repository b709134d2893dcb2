"""Interrupts of a process that computes: SIGTERM as KeyboardInterrupt, and none lost."""

from __future__ import annotations

import signal
import sys
from typing import Any


def catch_interrupts() -> None:
    """Raise KeyboardInterrupt on SIGTERM, and repeat an interrupt that fell where Python only prints it."""
    signal.signal(signal.SIGTERM, _interrupt)
    sys.unraisablehook = _unraisable


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def _unraisable(lost: Any) -> None:
    """Repeat an interrupt that fell into a destructor or a callback a moment later; at once it could fall into this
    very function."""
    if isinstance(lost.exc_value, KeyboardInterrupt):
        signal.signal(signal.SIGALRM, _interrupt)
        signal.setitimer(signal.ITIMER_REAL, 0.01)
    else:
        sys.__unraisablehook__(lost)
