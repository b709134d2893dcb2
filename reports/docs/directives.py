"""Sphinx directives that fill pages from the code."""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib import import_module
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from reports import lumped_heat, wear_lengths
from reports.builder import Section
from reports.docs import content
from reports.docs.tasks import HERE as TASKS

MARKDOWN: dict[str, Callable[..., str]] = {
    "kinds": content.kinds,
    "scene-keys": content.scene_keys,
    "kind-keys": content.kind_keys,
    "shared-tables": content.shared_tables,
    "built-in-scenes": content.built_in_scenes,
    "results": content.results,
    "laws": content.laws,
    "notes": content.notes,
    "processes": content.processes,
    "task-numbers": content.task_numbers,
    "gates": content.gates,
    "verdicts": content.verdicts,
    "measured": content.measured,
    "error-coverage": content.error_coverage,
    "error-factors": content.error_factors,
    "accuracy-met": content.accuracy_met,
    "commands": content.commands,
}
"""Functions of the words behind the directive that return Markdown."""

CHAPTERS: dict[str, Callable[[], Section]] = {
    "wear-lengths": wear_lengths.verdicts,
    "lumped-heat": lumped_heat.chapter,
}
"""Chapters of the reports, filled from stored experiments."""


class Markdown(SphinxDirective):
    """Markdown from a function of `MARKDOWN`, as if it stood on the page."""

    optional_arguments = 2

    def run(self) -> list[nodes.Node]:
        """Parse the text."""
        return self.parse_text_to_nodes(MARKDOWN[self.name](*self.arguments), allow_section_headings=True)


class TaskFile(SphinxDirective):
    """The file of an example, to copy."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Show the file under its name."""
        text = (TASKS / self.arguments[0]).read_text("utf-8").rstrip()
        name = self.arguments[0].rpartition("/")[2]
        return self.parse_text_to_nodes(f"```{{code-block}} toml\n:caption: {name}\n\n{text}\n```\n")


class Chapter(SphinxDirective):
    """The text, tables and pictures of a chapter of the reports, below a heading of the page."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the chapter's HTML."""
        body = CHAPTERS[self.arguments[0]]().body.replace(
            '<div class="wide">', '<div class="pst-scrollable-table-container">'
        )
        return [nodes.raw("", body.replace("<table>", '<table class="table">'), format="html")]


class Api(SphinxDirective):
    """Public names of bem or of a package of it (`adhesion.follow_path`), one a line, with their docstrings."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Document each name as the class, function or value that it is."""
        calls = "".join(_call(name) for name in " ".join(self.content).split())
        return self.parse_text_to_nodes("```{eval-rst}\n" + calls + "```\n")


def _call(name: str) -> str:
    """Return the directive of autodoc that documents a name."""
    package, _, last = f"bem.{name}".rpartition(".")
    item = getattr(import_module(package), last)
    if isinstance(item, type):
        return f".. autoclass:: bem.{name}\n   :members:\n\n"
    return f".. autofunction:: bem.{name}\n\n" if callable(item) else f".. autodata:: bem.{name}\n   :no-value:\n\n"


_SECTIONS = ("Parameters", "Attributes", "Returns", "Yields", "Raises")
_ENTRY = re.compile(r"\w+(, \w+)* : ")


def docstring_lines(lines: list[str]) -> list[str]:
    """Return a docstring as numpydoc reads it.

    In the docstrings of bem a description follows its name on the same line, `name : description`, where numpydoc has
    the type. It moves to a line of its own. A list of fields without a heading gets one. Bars are escaped: |x| is an
    absolute value, no substitution.
    """
    found: list[str] = []
    inside = False
    for number, line in enumerate(lines):
        following = lines[number + 1] if number + 1 < len(lines) else ""
        if following and set(following.strip()) == {"-"}:
            inside = line.strip() in _SECTIONS
        elif not inside and _ENTRY.match(line) and number > 0 and not lines[number - 1].strip():
            found += ["Attributes", "----------"]
            inside = True
        parts = re.split("(`[^`]*`)", line)
        line = "".join(part if part.startswith("`") else part.replace("|", r"\|") for part in parts)
        name, colon, words = line.partition(" : ")
        if inside and colon and not line.startswith(" "):
            found += [name, f"    {words}"]
        else:
            found.append(line)
    return found


def arrange_docstring(app: Sphinx, what: str, name: str, item: Any, options: Any, lines: list[str]) -> None:
    """Arrange a docstring before numpydoc reads it."""
    del app, what, name, item, options
    lines[:] = docstring_lines(lines)


def hide_signature(
    app: Sphinx, what: str, name: str, item: Any, options: Any, signature: str | None, returned: str | None
) -> tuple[str, None] | None:
    """Hide the arguments of classes that list their attributes: results, which solvers make."""
    del app, name, options, signature, returned
    return ("", None) if what == "class" and "Attributes\n" in (item.__doc__ or "") else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Enter the directives."""
    app.connect("autodoc-process-docstring", arrange_docstring, priority=100)
    app.connect("autodoc-process-signature", hide_signature)
    for name in MARKDOWN:
        app.add_directive(name, Markdown)
    app.add_directive("task-file", TaskFile)
    app.add_directive("chapter", Chapter)
    app.add_directive("api", Api)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
