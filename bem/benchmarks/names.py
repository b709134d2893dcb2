"""Names that a command was given, against those there are."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Sequence

from bem.errors import InputError


def refuse_unknown(option: str, names: Sequence[str], allowed: Collection[str], what: str) -> None:
    """Refuse names that are none of the allowed; `what` says what they are not, such as "a case".

    Raises
    ------
    InputError : one message for each name that is not known.
    """
    messages = []
    for name in names:
        if name not in allowed:
            near = difflib.get_close_matches(name, allowed, 1)
            hint = f"; nearest: {near[0]}" if near else ""
            messages.append(f"{option}: {name!r} is not {what}; allowed: {', '.join(allowed)}{hint}")
    if messages:
        raise InputError(messages)
