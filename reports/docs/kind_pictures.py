"""Pictures of kinds that have no worked example: `python -m reports.docs.kind_pictures [KIND ...]` draws them again.

They are of built-in scenes at reduced size, as the gallery runs them.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Mapping
from pathlib import Path

from reports.docs.tasks import save_small
from reports.gallery import gallery_scene

HERE = Path(__file__).resolve().parent / "kinds" / "pictures"
PICTURES: Mapping[str, tuple[str, str]] = {
    "asperities": ("uniform-asperities", "asperity-loads"),
    "film": ("film-start-stop", "film-over-time"),
    "flow-factors": ("flow-factors", "flow-factors"),
    "partial-slip": ("fretting-ball", "slip-map"),
    "particles": ("particles-afm-map", "particle-map"),
    "point-film-time": ("dimple", "passing-sections"),
    "rolling": ("rolling-creepage", "creep-curve"),
    "running-in": ("running-in-ball", "friction-over-cycles"),
    "surface-temperature": ("flash-temperature", "temperature-map"),
}
"""Built-in scene and figure of each kind."""


def renew(kind: str) -> None:
    """Run the scene of a kind at reduced size and store its picture."""
    from bem import run_scene

    scene, picture = PICTURES[kind]
    HERE.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        run = run_scene(gallery_scene(scene, Path(scratch), reduced=True), Path(scratch) / "run")
        save_small(run.path / "figures" / f"{picture}.png", HERE / f"{kind}.png")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m reports.docs.kind_pictures", description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"any of {', '.join(PICTURES)}")
    for kind in parser.parse_args().kinds or PICTURES:
        print(kind, flush=True)
        renew(kind)
