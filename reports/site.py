"""The guide as a site, built offline: `python -m reports.site [--out DIR]`, a page for each kind of scene.

Pictures are of built-in scenes at reduced size; their runs lie under the site's folder and are not run again. Verified
in tests/docs/test_site.py.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from bem.errors import InputError
from bem.results.read import FinishedRun
from bem.scenes import get_kind, kind_names, library
from bem.scenes.records import Figure, described
from bem.scenes.template import scene_template
from reports import error_bars, guide, validation, wear_lengths
from reports.builder import HERE, Page, Section, picture, table, text, write_site
from reports.gallery import run_gallery
from reports.prose import prose

WORDS: dict[str, Any] = prose("site")
SITE = HERE / "site"
_MOST_PICTURES = 3
_SPEEDS = 9
"""Points of a curve over speed in the guide's pictures."""


def pages(runs: Mapping[str, FinishedRun | str]) -> list[Page]:
    """All pages, with pictures of the runs by the names of their scenes."""
    start = [*guide.using(), *guide.scenes()]
    made = [Page("start", "Start", WORDS["lead"], start)]
    for name, title in (("app", "The page"), ("elements", "Machine elements")):
        lead, *rest = WORDS[name]["about"]
        body = guide.code(WORDS[name]["commands"]) + "".join(text(item) for item in rest)
        made.append(Page(name, title, lead.replace("`", ""), [Section("How it goes", body)]))
    made += [kind_page(kind, runs) for kind in documented()]
    theory, *others = guide.theory()
    made += [
        Page("theory", "Theory", "All formulas with sources and errata, and the laws by name.", [theory, *others]),
        Page(
            "errors",
            "Errors",
            "How wrong a figure is, and how that was found.",
            [*error_bars.chapter(), *wear_lengths.chapter()],
        ),
        Page("extending", "Extending", "A part of your own, one file each.", [*guide.contributing(), *guide.kinds()]),
        Page("thesis", "The thesis", WORDS["thesis"]["lead"], validation.build().sections),
    ]
    return made


def documented() -> list[str]:
    """The package's kinds: in the order of the prose, then those that it has no words for yet."""
    known = [kind for kind in WORDS["kinds"] if kind in kind_names()]
    return [*known, *(kind for kind in kind_names() if kind not in known)]


def words_of(kind: str) -> dict[str, Any]:
    """What the prose says of a kind; of one without words its first built-in scene."""
    scenes = [name for name, scene in library().items() if scene["kind"] == kind]
    plain = {"scenes": scenes[:1], "about": "", "theory": [], "limits": []}
    return plain | WORDS["kinds"].get(kind, {})


def kind_page(kind: str, runs: Mapping[str, FinishedRun | str]) -> Page:
    """What the kind answers, its pictures, a scene, its theory, errors and limits."""
    words, found = words_of(kind), get_kind(kind)
    formulas = [item for item in guide.THEORY if item[0] in words["theory"]]
    limits = [item for item in guide.LIMITS if item[0] in words["limits"]]
    sections = [
        Section("Pictures", "".join(_pictures(scene, runs.get(scene)) for scene in words["scenes"])),
        Section("Built-in scenes", table(("name", "what it is", "redoes"), list(_scenes(kind)))),
        Section("A scene", _scene(kind)),
        Section("Keys", table(("key", "level", "default", "allowed", "meaning"), list(guide.keys_of(found.model, "")))),
        Section("Figures and their errors", _errors(kind)),
        Section("Theory", "".join(guide.formula(*item) for item in formulas)),
        Section("Limits", table(("assumption", "what it means"), limits)),
    ]
    return Page(f"kind-{kind}", kind, f"{found.title[0].upper()}{found.title[1:]}. {words['about']}", sections)


def _pictures(scene: str, run: FinishedRun | str | None) -> str:
    if not isinstance(run, FinishedRun):
        return text(f"No picture: {run or f'{scene} was not run'}.")
    drawn = [run.path / "figures" / f"{name}.png" for name in get_kind(run.summary["kind"]).figures]
    found = [path for path in drawn if path.is_file()][:_MOST_PICTURES]
    about = f"of the scene {scene}, with fewer cells, cycles and speeds than it has"
    return "".join(picture(path.read_bytes(), f"{path.stem.replace('-', ' ')} {about}") for path in found)


def _scenes(kind: str) -> Iterator[tuple[str, str, str]]:
    for name, scene in library().items():
        if scene["kind"] == kind:
            yield name, scene.get("description", ""), scene.get("redoes", "")


def _scene(kind: str) -> str:
    try:
        return text(f"`bem new {kind}` writes this, with every other key as a comment:") + guide.code(
            scene_template(kind)
        )
    except InputError:
        return text("`bem scenes` lists those that are built in.")


def _errors(kind: str) -> str:
    """Every figure with its unit and its bar, then what bars of this kind covered in the stored experiments."""
    rows = []
    for name, item in described(get_kind(kind).record).items():
        if isinstance(item, Figure):
            bar = item.no_bar or ("none is made of it" if item.unjudged else "has one where the run makes one")
            rows.append((item.key(name), item.text, bar))
    said = table(("figure", "what it is", "error bar"), rows)
    covered = list(error_bars.covered_of(kind))
    if covered:
        said += text("What the bars covered, on problems drawn at random and solved again far finer:")
        said += table(
            ("drawn at random", "figure", "bars", "covered", "bar over error, median", "error, median"), covered
        )
    return said


def build(folder: Path = SITE) -> list[Path]:
    """Run what pictures are missing of, and write the site; what was written, the index last."""
    names = [scene for kind in documented() for scene in words_of(kind)["scenes"]]
    runs = run_gallery(folder / "runs", names=names, reduced=True, speeds=_SPEEDS, say=_say)
    for name, found in runs.items():
        if isinstance(found, str):
            _say(f"no picture of {name}: {found}")
    return write_site(pages(runs), folder, title="guide", about=WORDS["about"])


def _say(words: str) -> None:
    print(f"docs: {words}", file=sys.stderr, flush=True)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m reports.site", description=__doc__)
    parser.add_argument("--out", type=Path, default=SITE, help="folder to write into")
    print(build(parser.parse_args().out)[-1])


if __name__ == "__main__":
    main()
