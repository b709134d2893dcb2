"""`bem new`."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from bem.scenes.own_surfaces import MapScale, MeasuredMap


def complete_kind(incomplete: str) -> list[str]:
    """Kinds of scene that begin like this, for tab completion; loads nothing."""
    folder = Path(__file__).resolve().parents[1] / "kinds"
    names = (item.parent.name.replace("_", "-") for item in folder.glob("*/kind.py"))
    return sorted(name for name in names if name.startswith(incomplete))


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Write a commented scene of a kind, to start from.")
    def new(
        kind: Annotated[
            str | None,
            typer.Argument(
                metavar="[KIND]",
                help="Kind of scene, such as contact (or what it is called elsewhere, such as stribeck), a built-in "
                "scene, or a machine element: rolling-bearing, gear-pair, cam-follower, piston-ring, plain-bush; "
                "without it all are listed.",
                autocompletion=complete_kind,
            ),
        ] = None,
        file: Annotated[
            Path | None, typer.Argument(metavar="[FILE]", help="File to write; without it KIND.toml.")
        ] = None,
        everything: Annotated[
            bool, typer.Option("--all", help="Write all keys, with those that few users set behind a #.")
        ] = False,
        lower: Annotated[
            str | None,
            typer.Option(metavar="FILE", help="Measured surface of the lower body; the mesh is chosen to fit it."),
        ] = None,
        upper: Annotated[str | None, typer.Option(metavar="FILE", help="Measured surface of the upper body.")] = None,
        spacing: Annotated[
            str | None,
            typer.Option(help='Distance of points of a file that does not say it, "0.5 um" or "0.5 um,1 um".'),
        ] = None,
        height_unit: Annotated[
            str | None, typer.Option(help="Unit of the heights of a file that does not say it, such as nm.")
        ] = None,
    ) -> None:
        """Write a commented scene of a kind to start from: the keys that every user sets, with meaning and unit.

        \b
        Examples:
          bem new
          bem new contact
          bem new contact --all
          bem new wear my-wear.toml
          bem new stribeck
          bem new gear-pair gears.toml
          bem new running-in mine.toml --lower disk.al3d --upper pin.x3p
          bem new contact mine.toml --lower disk.txt --spacing "0.5 um" --height-unit nm
        """
        from bem.cli._terminal import print_written
        from bem.errors import InputError, ResultsError
        from bem.results.atomic import write_text
        from bem.scenes.template import scene_template

        if kind is None:
            _list_all()
            return
        element = element_text(kind)
        if not element:
            _check_kind(kind)
        elif everything:
            raise InputError(f"--all: {kind} is a machine element; its file has all keys; allowed: without --all")
        path = file or Path(f"{'-'.join(kind.split())}.toml")
        surfaces = {body: one for body, one in (("lower", lower), ("upper", upper)) if one is not None}
        if element and surfaces:
            raise InputError(f"--lower, --upper: {kind} is a machine element; allowed: kinds of scene")
        scale = _map_scale(spacing, height_unit)
        if scale is not None and not surfaces:
            raise InputError("--spacing, --height-unit: there is no measured surface; allowed: with --lower or --upper")
        maps = _maps(surfaces, path.resolve().parent, scale)
        _print_notes(maps)
        text = element or scene_template(kind, everything=everything, surfaces=maps)
        if path.exists():
            raise ResultsError(f"{path}: exists; give another FILE")
        if not path.parent.is_dir():
            raise ResultsError(f"{path.parent}: no such folder")
        write_text(path, text)
        typed = shlex.quote(str(path))
        after = f"bem element {typed}" if element else f"bem plan {typed}; bem run {typed}"
        print_written(path)
        print(f"next:    {after}")


def _maps(files: dict[str, str], folder: Path, scale: MapScale | None) -> dict[str, MeasuredMap]:
    """Return the maps of measured surfaces, by body."""
    if not files:
        return {}
    from bem.scenes.own_surfaces import read_maps

    return read_maps(files, folder, scale)


def _print_notes(maps: dict[str, MeasuredMap]) -> None:
    """Say what is doubtful of maps."""
    if not maps:
        return
    from bem.cli._terminal import print_text
    from bem.scenes.own_surfaces import notes_on_maps

    for text in notes_on_maps(maps):
        print_text(f"bem: note: {text}", file=sys.stderr)


def _map_scale(spacing: str | None, height_unit: str | None) -> MapScale | None:
    """Return the scale of files that do not say it; None if neither option is given."""
    if spacing is None and height_unit is None:
        return None
    from bem.cli._quantity import spacing_of_points
    from bem.errors import InputError
    from bem.scenes.own_surfaces import MapScale
    from bem.surfaces.read import METRES

    if height_unit is not None and height_unit not in METRES:
        raise InputError(f'--height-unit "{height_unit}": allowed: {", ".join(METRES)}')
    return MapScale(spacing_of_points(spacing, "--spacing"), height_unit)


def element_text(name: str) -> str:
    """The file of a machine element to start from; empty for what is none.

    Raises
    ------
    InputError : an element that is not here, and why.
    """
    word = name.strip().lower().replace("_", "-").replace(" ", "-")
    if word not in _ELEMENTS:
        return ""
    from bem.elements.element import element_template

    return element_template(name)


_ELEMENTS = (
    *(
        "rolling-bearing",
        "bearing",
        "gear-pair",
        "gear",
        "gears",
        "helical-gear",
        "cam-follower",
        "cam",
        "piston-ring",
        "ring",
    ),
    *("ball-bearing", "deep-groove-ball-bearing", "deep-groove-bearing", "roller-bearing"),
    *("cylindrical-roller-bearing", "needle-bearing"),
    *("angular-contact-bearing", "angular-contact-ball-bearing", "tapered-roller-bearing", "taper-roller-bearing"),
    *("spherical-roller-bearing", "self-aligning-ball-bearing", "thrust-bearing", "thrust-ball-bearing"),
    *("plain-bush", "plain-bearing", "sleeve-bearing", "sliding-bearing"),
    *("journal-bearing", "hydrodynamic-bearing"),
    *("polymer-bush", "polymer-bushing", "polymer-bearing"),
    *("bush", "bushing", "bushes", "bushings", "grease"),
    *("seal", "seals", "lip-seal", "scuffing", "scoring", "bearing-life", "rating-life", "l10"),
    *("worm-gear", "bevel-gear", "hypoid-gear", "internal-gear", "planetary-gear"),
)
"""Words for elements, and for what is none of them with the reason; known without loading them."""


def _list_all() -> None:
    """Show the kinds of scene and the machine elements, a line each."""
    from bem.cli._terminal import table
    from bem.elements.element import TITLES
    from bem.scenes.kind import get_kind, kinds_by_task

    rows = [
        (task if name == names[0] else "", name, get_kind(name).title)
        for task, names in kinds_by_task().items()
        for name in names
    ]
    table(("task", "kind", "what it computes"), rows, title="kinds of calculation")
    table(("element", "what it shows"), list(TITLES.items()), title="machine elements")
    print("next: bem new KIND writes a commented file to start from; `bem scenes` lists finished scenes")


_SCENES_MEANT = {
    "adhesion": "adhesive-sphere",
    "adhesive": "adhesive-sphere",
    "jkr": "adhesive-sphere",
    "hysteresis": "sliding-hysteresis",
    "viscoelastic": "viscoelastic-ball",
    "viscoelasticity": "viscoelastic-ball",
}
"""Words for what a kind can do, and the built-in scenes that show it."""


def _check_kind(word: str) -> None:
    """Refuse a word that is no kind, element or built-in scene, listing kinds and elements.

    Raises
    ------
    InputError : with the nearest names.
    """
    from bem.arguments import did_you_mean
    from bem.elements.element import TITLES
    from bem.errors import InputError
    from bem.scenes.kind import kind_aliases, kind_names
    from bem.scenes.load import library
    from bem.scenes.template import kind_meant

    if kind_meant(word) in kind_names() or word in library():
        return
    kinds = kind_names()
    if word.endswith(".toml"):
        raise InputError(f"{word}: the kind is missing; allowed: bem new KIND {word}, such as bem new contact {word}")
    scene = _SCENES_MEANT.get(word.lower())
    hint = f' - did you mean the built-in scene "{scene}"?' if scene in library() else ""
    raise InputError(
        f'"{word}": neither a kind of scene nor a machine element'
        f"{hint or did_you_mean(word, [*kinds, *TITLES, *kind_aliases(), *library()])}; allowed: kinds and elements "
        f"that `bem new` lists ({', '.join([*kinds, *TITLES])}), or a scene of `bem scenes`"
    )
