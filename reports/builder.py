"""One look for every report: pages of sections with figures and tables, self-contained HTML, an index, and PDF.

Figures are embedded, so a page is one file that a browser shows without a network.
"""

from __future__ import annotations

import base64
import html
import io
import os
import platform
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import date
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

import bem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent

ORDER = ("verification", "performance", "validation", "friction", "gallery")
"""Of the pages in the index."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Okabe and Ito's palette, told apart by colour-blind readers; first bem, second the reference."""


@dataclass(frozen=True)
class Section:
    """A heading with HTML below it. `body` is trusted HTML made by the functions of this module."""

    title: str
    body: str
    level: int = 2

    @property
    def anchor(self) -> str:
        """Name of the heading's link."""
        return "".join(c if c.isalnum() else "-" for c in self.title.lower()).strip("-")


@dataclass(frozen=True)
class Page:
    """A report. `name` is its file name without ending; `lead` a paragraph for its top and the index."""

    name: str
    title: str
    lead: str
    sections: Sequence[Section]
    facts: dict[str, str] = field(default_factory=dict)


def text(words: str) -> str:
    """A paragraph of plain text; what stands between backticks is shown as code."""
    return f"<p>{_marked(words)}</p>"


def _marked(words: str) -> str:
    return re.sub("`([^`]+)`", r"<code>\1</code>", html.escape(words))


def figure(drawing: Figure, caption: str, *, dpi: int = 130) -> str:
    """A matplotlib figure as an embedded picture with a caption; the figure is closed."""
    import matplotlib.pyplot as plt

    buffer = io.BytesIO()
    drawing.savefig(buffer, format="png", dpi=dpi, bbox_inches="tight")
    plt.close(drawing)
    return picture(buffer.getvalue(), caption)


def picture(png: bytes, caption: str) -> str:
    """PNG bytes as an embedded picture with a caption."""
    data = base64.b64encode(png).decode()
    words = html.escape(caption)
    return f'<figure><img alt="{words}" src="data:image/png;base64,{data}"><figcaption>{words}</figcaption></figure>'


def table(headers: Sequence[str], rows: Iterable[Sequence[Any]], *, caption: str = "") -> str:
    """A table. Numbers are shown to four digits; True and False as passed and FAILED, coloured."""
    head = "".join(f"<th>{html.escape(h)}</th>" for h in headers)
    body = "".join("<tr>" + "".join(_cell(value) for value in row) + "</tr>" for row in rows)
    legend = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    return f'<div class="wide"><table>{legend}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _cell(value: Any) -> str:
    if value is True:
        return '<td class="pass">passed</td>'
    if value is False:
        return '<td class="fail">FAILED</td>'
    if value is None:
        return "<td>–</td>"
    if isinstance(value, float):
        return f'<td class="number">{value:.4g}</td>'
    if isinstance(value, int):
        return f'<td class="number">{value}</td>'
    return f"<td>{_marked(str(value))}</td>"


def machine_facts() -> dict[str, str]:
    """What a figure may depend on: processor count, system, versions."""
    packages = ("numpy", "scipy", "pyfftw", "numba")
    return {
        "date": date.today().isoformat(),
        "system": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "python": platform.python_version(),
        "versions": ", ".join((f"bem {bem.__version__}", *(f"{p} {version(p)}" for p in packages))),
    }


def render(page: Page, pages: Sequence[Page] = ()) -> str:
    """The page as one HTML file; `pages` are offered in its header."""
    return _environment().get_template("page.html").render(page=page, pages=pages, facts=machine_facts() | page.facts)


def write_site(
    pages: Sequence[Page],
    folder: Path = HERE,
    *,
    pdf: bool = False,
    title: str = "reports",
    about: str = "what was checked, how fast it is, and what it predicts.",
) -> list[Path]:
    """Write every page and the index into `folder`, each whole or not at all; PDFs too where a browser is installed.

    Pages that were built before and lie in the folder stay, and stay in the index, which has the title and says what
    it is about.
    """
    folder.mkdir(parents=True, exist_ok=True)
    names = [page.name for page in pages]
    everything = [*pages, *(page for page in _pages_in(folder) if page.name not in names)]
    everything.sort(key=lambda page: ORDER.index(page.name) if page.name in ORDER else len(ORDER))
    written = [_write(folder / f"{page.name}.html", render(page, everything)) for page in pages]
    index = (
        _environment()
        .get_template("index.html")
        .render(pages=everything, facts=machine_facts(), title=title, about=about)
    )
    written.append(_write(folder / "index.html", index))
    if pdf:
        written += [made for path in written[:-1] if (made := print_pdf(path)) is not None]
    return written


def _pages_in(folder: Path) -> list[Page]:
    """What an index needs to know of the pages in a folder."""
    found = []
    for path in sorted(folder.glob("*.html")):
        head = path.read_text(encoding="utf-8", errors="replace")[:100_000]
        match = re.search(r'<h1>([^<]*)</h1>\s*<p class="lead">([^<]*)</p>', head)
        if match and path.stem != "index":
            found.append(Page(path.stem, html.unescape(match[1]), html.unescape(match[2]), []))
    return found


def print_pdf(path: Path) -> Path | None:
    """Print an HTML file to PDF with a headless browser; None where no browser is installed."""
    browser = next((b for b in map(shutil.which, ("chromium", "google-chrome", "chromium-browser")) if b), None)
    if browser is None:
        return None
    target = path.with_suffix(".pdf")
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(
            [
                browser,
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-background-networking",
                "--no-pdf-header-footer",
                f"--user-data-dir={profile}",
                f"--print-to-pdf={target}",
                path.resolve().as_uri(),
            ],
            check=True,
            capture_output=True,
            timeout=180,
        )
    return target


def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(HERE / "templates"), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )


def _write(path: Path, content: str) -> Path:
    temporary = path.with_name(path.name + ".part")
    temporary.write_text(content, encoding="utf-8")
    temporary.replace(path)
    return path
