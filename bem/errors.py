"""What can go wrong: exception taxonomy and the outcomes of solvers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import StrEnum

from bem.quantities import prefixed


class Status(StrEnum):
    """Outcome of an iterative solver; `message` says what it means and what to do."""

    CONVERGED = "converged"
    INACCURATE = "inaccurate"
    MAX_ITERATIONS = "max_iterations"
    STALLED = "stalled"
    INFEASIBLE = "infeasible"

    @property
    def message(self) -> str:
        """Sentence for people."""
        return _MESSAGES[self]


_MESSAGES = {
    Status.CONVERGED: "converged to the requested tolerance",
    Status.INACCURATE: "solved, but the accuracy that was asked for is not met; ask for less, or of fewer figures",
    Status.MAX_ITERATIONS: "stopped at the iteration limit before the tolerance was met; raise either of them",
    Status.STALLED: "the solver stopped making progress before the tolerance; the residual says how far it came",
    Status.INFEASIBLE: (
        "no solution exists within the bounds; lower the load, raise the hardness or ask for a larger mean gap"
    ),
}


class BemError(Exception):
    """Base of every error raised on purpose; `exit_code` is what the command line returns."""

    exit_code = 1


class InputError(BemError, ValueError):
    """An argument, scene or file that cannot be used. The message names it, its value and what is allowed; its numbers
    have prefixed units."""

    exit_code = 2

    def __init__(self, message: str | Sequence[str]) -> None:
        given = (message,) if isinstance(message, str) else tuple(message)
        self.messages: tuple[str, ...] = tuple(map(prefixed, given))
        super().__init__("\n".join(self.messages))


class InfeasibleError(InputError):
    """A load that the bounds cannot carry, such as more than hardness x area."""


class SurfaceFileError(InputError):
    """A surface file that is missing, unreadable, truncated or has points missing where none may be."""


class ConvergenceError(BemError):
    """A run that cannot go on because a solver did not converge; says where."""

    exit_code = 3


class ResultsError(BemError, OSError):
    """Results that cannot be written or read: folder read-only, disk full, damaged file, folder in use."""

    exit_code = 4


@contextmanager
def interrupts_as_they_are() -> Iterator[None]:
    """Raise an interrupt that fell into the call of a compiled loop as itself.

    Python turns such an interrupt into a SystemError, and that one into another for every array and tuple that the loop
    still has to return. The interrupt is the first cause of the chain.

    Raises
    ------
    KeyboardInterrupt : there was one.
    """
    try:
        yield
    except SystemError as error:
        cause: BaseException | None = error
        while isinstance(cause, SystemError):
            cause = cause.__cause__
        if isinstance(cause, KeyboardInterrupt):
            raise cause from None
        raise
