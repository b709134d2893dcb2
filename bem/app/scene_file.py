"""A scene's file as one page knows it: every change is made to what the file says now, and none of another is lost.

Verified in tests/app/test_scene_file.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from bem.app.workspace import Workspace
from bem.scenes.form import text_of
from bem.scenes.paths import parse_key, value_at

Change = Callable[[dict[str, Any]], dict[str, Any]]
"""A copy of a scene's table with one thing changed."""


@dataclass(frozen=True)
class Conflict:
    """A key that was changed here and, meanwhile, elsewhere; `words` name it with both values."""

    words: str


class SceneFile:
    """The file of a scene.

    `text` and `table` are what this page has seen of it last; the table is that of the last text that could be read.
    """

    def __init__(self, workspace: Workspace, name: str) -> None:
        self._workspace, self._name = workspace, name
        self.text = ""
        self.table: dict[str, Any] = {}

    def changed_elsewhere(self) -> bool:
        """Return True if the file says something else than this page has seen."""
        return self._workspace.scene_text(self._name) != self.text

    def read(self) -> dict[str, Any]:
        """Take text and table from the file.

        Raises
        ------
        InputError : the file is no TOML; its text is taken.
        """
        self.text = self._workspace.scene_text(self._name)
        self.table = self._workspace.scene_table(self._name)
        return self.table

    def edit(self, key: str, change: Change, *, mine: bool = False) -> Conflict | None:
        """Change one key of what the file says now.

        Parameters
        ----------
        key : dotted.
        change : makes the changed table.
        mine : whether this change counts where the key was changed elsewhere, too.

        Returns
        -------
        Conflict or None : why nothing was written.

        Raises
        ------
        BemError : the value cannot be put there, or the file cannot be read or written; it is left as it is.
        """
        table = self.table
        if self.changed_elsewhere():
            table = self._workspace.scene_table(self._name)
            theirs, own = _value(table, key), _value(change(self.table), key)
            if not mine and theirs not in (_value(self.table, key), own):
                words = f"{key} was changed elsewhere to {_value_in_words(theirs)}, and here to {_value_in_words(own)}."
                return Conflict(words)
        table = change(table)
        self._workspace.save_scene(self._name, table)
        self.text, self.table = self._workspace.scene_text(self._name), table
        return None

    def write(self, text: str, *, mine: bool = False) -> Conflict | None:
        """Write the text of the file as it is, right or wrong.

        mine : whether it counts where the file was changed elsewhere, too.

        Returns
        -------
        Conflict or None : why nothing was written.
        """
        now = self._workspace.scene_text(self._name)
        if not mine and now not in (self.text, text):
            return Conflict("The file was changed elsewhere while text was typed here.")
        self._workspace.save_scene(self._name, text)
        self.text = text
        return None


def _value(table: dict[str, Any], key: str) -> Any:
    """Return the value of a table at a dotted key; None if there is none."""
    parsed = parse_key(key)
    return None if parsed is None else value_at(table, parsed)


def _value_in_words(value: Any) -> str:
    return text_of(value) or "nothing"
