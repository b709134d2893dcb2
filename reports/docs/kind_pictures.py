"""Pictures of kinds that have no worked example: `python -m reports.docs.kind_pictures [KIND ...]` draws them again.

They are of built-in scenes at reduced size, as the gallery runs them; the guide of a kind names scene and figure.
"""

from __future__ import annotations

import argparse
import re
import tempfile
from pathlib import Path

from bem.scenes.kind import KINDS
from reports.docs.tasks import save_small
from reports.gallery import gallery_scene

HERE = Path(__file__).resolve().parent / "kinds" / "pictures"
_PICTURE = re.compile(r"^% picture: figure ([\w-]+) of the built-in scene ([\w-]+)$", re.MULTILINE)


def pictures() -> dict[str, tuple[str, str]]:
    """Return built-in scene and figure of each kind whose guide names them in a comment."""
    found = {}
    for guide in sorted(KINDS.glob("*/guide.md")):
        if named := _PICTURE.search(guide.read_text("utf-8")):
            found[guide.parent.name.replace("_", "-")] = (named[2], named[1])
    return found


def renew(kind: str) -> None:
    """Run the scene of a kind at reduced size and store its picture."""
    from bem import run_scene

    scene, picture = pictures()[kind]
    HERE.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        run = run_scene(gallery_scene(scene, Path(scratch), reduced=True), Path(scratch) / "run")
        save_small(run.path / "figures" / f"{picture}.png", HERE / f"{kind}.png")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m reports.docs.kind_pictures", description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"any of {', '.join(pictures())}")
    for kind in parser.parse_args().kinds or pictures():
        print(kind, flush=True)
        renew(kind)
