"""Mutants: one-line changes of the package, named by the text that they replace."""

from __future__ import annotations

import hashlib
import tomllib
from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).with_name("seeds")


@dataclass(frozen=True)
class Mutant:
    """A change of one piece of text, which a file holds exactly once.

    room : name of the list. file : path in the repository. old, new : text, and what takes its place. slip : what was
    done wrong, in words. reason : why it survives the tests of today, if it does: that it is equivalent, or what is
    missing.
    """

    room: str
    file: str
    old: str
    new: str
    slip: str
    reason: str = ""

    @property
    def key(self) -> str:
        """Identifier: room, stem of the file, and the first digits of a hash of the change."""
        digest = hashlib.sha256("\0".join((self.file, self.old, self.new)).encode()).hexdigest()
        return f"{self.room}/{Path(self.file).stem}-{digest[:6]}"

    def apply(self, text: str) -> str | None:
        """Return the changed text of the file; None unless the old text occurs exactly once."""
        return text.replace(self.old, self.new) if text.count(self.old) == 1 else None


def load(folder: Path = FOLDER) -> list[Mutant]:
    """Return all mutants, room by room.

    Raises
    ------
    ValueError : an entry without a change, or two entries that are the same change.
    """
    found: dict[str, Mutant] = {}
    for path in sorted(folder.glob("*.toml")):
        for entry in tomllib.loads(path.read_text(encoding="utf-8"))["mutant"]:
            mutant = Mutant(path.stem, **entry)
            if mutant.old == mutant.new or not mutant.old.strip():
                raise ValueError(f"{path.name}: {mutant.slip!r} changes nothing")
            if mutant.key in found:
                raise ValueError(f"{path.name}: {mutant.slip!r} is listed twice")
            found[mutant.key] = mutant
    return list(found.values())
