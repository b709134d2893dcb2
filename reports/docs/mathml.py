"""Formulas as MathML, which browsers show without scripts: the converter that docutils has, as a renderer of Sphinx."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx


def _inline(writer: Any, node: nodes.math) -> None:
    """Write a formula within a line."""
    writer.body.append(latex2mathml.tex2mathml(node.astext()))
    raise nodes.SkipNode


def _block(writer: Any, node: nodes.math_block) -> None:
    """Write a formula on lines of its own."""
    label = node.get("ids", [""])[0] if node.get("ids") else ""
    writer.body.append(f'<div class="formula"{f" id={label!r}" if label else ""}>')
    writer.body.append(latex2mathml.tex2mathml(node.astext().strip(), as_block=True))
    writer.body.append("</div>")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Enter the renderer `mathml`."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
