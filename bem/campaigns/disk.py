"""Test whether a worker sees the same disk: a file with a secret token in the folder of the run."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from bem.results.atomic import write_text

TOKEN = ".campaign-token"


@contextmanager
def marked(folder: Path) -> Iterator[str]:
    """Put a secret into the folder while in the block, and give it."""
    token = secrets.token_hex(16)
    write_text(folder / TOKEN, token)
    try:
        yield token
    finally:
        with suppress(OSError):
            (folder / TOKEN).unlink()


def sees(folder: Path, token: str) -> bool:
    """Return True if the folder that was given this secret is here."""
    try:
        return (folder / TOKEN).read_text() == token
    except OSError:
        return False
