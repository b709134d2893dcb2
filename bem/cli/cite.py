"""`bem cite`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from bem.scenes.common import SceneModel


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Sources of the laws and methods of a run, as text and BibTeX.")
    def cite(
        scene: Annotated[
            str, typer.Argument(metavar="RUN", help="Folder of a run, file of a scene or element, or built-in scene.")
        ],
        bibtex: Annotated[bool, typer.Option("--bibtex", help="Print the BibTeX entries alone.")] = False,
    ) -> None:
        """Print the papers of the laws and methods that a run, scene or machine element uses, as text and as BibTeX,
        and the sources of the constants of its materials and oils as text.

        \b
        Examples:
          bem cite runs/traction-001
          bem cite stribeck-ball-on-disc --bibtex > references.bib
          bem cite gears.toml
        """
        from bem.campaigns.cited import catalogue_sources, sources_of
        from bem.cli._terminal import print_text
        from bem.references import references

        found, constants = _of_element(scene)
        if not found:
            used = _resolved(_scene_of(scene))
            found, constants = sources_of(used), catalogue_sources(used)
        known = references()
        keys = sorted(found, key=lambda key: known[key].text)
        if not bibtex:
            for key in keys:
                print_text(f"{'; '.join(found[key])}: {known[key].text}")
            for name, source in constants.items():
                print_text(f"{name}: {source}")
            print()
        for key in keys:
            print(known[key].bibtex)


def _resolved(source: str) -> SceneModel:
    """Return a scene with its defaults; maps that do not exist are replaced by one of the package's, as sources of
    methods do not depend on heights.

    Raises
    ------
    InputError : a bad scene.
    """
    from bem.runs import plan_scene
    from bem.scenes.load import read_table

    table = read_table(source)
    return plan_scene(_with_maps(table))[0]


def _with_maps(value: Any) -> Any:
    """Return a value of a scene in which every measured surface without a file has a map of the package."""
    from pathlib import Path

    from bem.surfaces.examples import FOLDER

    if isinstance(value, list):
        return [_with_maps(one) for one in value]
    if not isinstance(value, dict):
        return value
    found = {key: _with_maps(one) for key, one in value.items()}
    if found.get("kind") == "measured" and not Path(str(found.get("path"))).is_file():
        found["path"] = str(FOLDER / "ground-disk.al3d")
    return found


_SURELY_MEANT = 0.8
"""Likeness of a word to the name of a scene above which it is proposed."""


def _scene_of(name: str) -> str:
    """Return the scene of a run, a file or a name; of a sweep that of its first point, whose methods all points have.

    Raises
    ------
    InputError : a file of a run in place of its folder; a name that is no scene.
    """
    from difflib import get_close_matches
    from pathlib import Path

    from bem.errors import InputError
    from bem.scenes.load import library

    path = Path(name)
    if path.is_dir() and not (path / "scene.toml").is_file():
        points = sorted(path.glob("points/*/scene.toml"))
        if not points:
            raise InputError(f"{name}: a folder without a run or a sweep; allowed: the folder of a run or a sweep")
        return str(points[0])
    if path.is_file() and path.suffix != ".toml":
        folder = path.parent
        run = f"the folder of the run, {folder}" if (folder / "scene.toml").is_file() else "the folder of a run"
        raise InputError(f"{name}: not a scene; allowed: {run}, or the file of a scene")
    if not path.exists() and len(path.parts) == 1 and name not in library():
        close = get_close_matches(name, library(), n=1, cutoff=_SURELY_MEANT)
        meant = f' - did you mean "{close[0]}"?' if close else "."
        raise InputError(
            f'"{name}": no such file, run folder or built-in scene{meant} `bem scenes` lists the built-in scenes.'
        )
    return name


def _of_element(name: str) -> tuple[dict[str, list[str]], dict[str, str]]:
    """Return the sources of a machine element's file and of the film of its most loaded contact, and those of their
    constants; none of others."""
    from pathlib import Path

    if not name.endswith(".toml") or not Path(name).is_file():
        return {}, {}
    from contextlib import suppress

    import bem
    from bem.campaigns.cited import PROGRAM, catalogue_sources, sources_of
    from bem.elements import running
    from bem.elements.element import load_element, read_element
    from bem.elements.plain_bush import PlainBushModel
    from bem.elements.running import operating_places
    from bem.elements.sources import constants_of_element, sources_of_element
    from bem.errors import InputError
    from bem.scenes.load import load_scene

    table = read_element(name)
    if "element" not in table:
        return {}, {}
    element = load_element(table)
    found, constants = sources_of_element(element), {}
    found = {**found, PROGRAM: [f"this program, version {bem.__version__}"]}
    with suppress(InputError):
        # its materials are those of the file; the film of a bush has a modulus that stands for the wall
        constants = catalogue_sources(load_scene(element.scene(element.worst(), "contact")))
    with suppress(InputError):
        film = load_scene(element.scene(operating_places(element)[0], "traction"))
        constants = catalogue_sources(film) | constants
        for key, methods in sources_of(film).items():
            found[key] = list(dict.fromkeys([*found.get(key, []), *methods]))
    model = element.model
    if isinstance(model, PlainBushModel) and model.oil is not None and model.rms_roughness is not None:
        with suppress(InputError):  # the load sharing of kind friction takes the place of the estimate
            shared = load_scene(element.scene(operating_places(element)[0], "friction"))
            found = {key: methods for key, methods in found.items() if key not in running.CITES}
            for key, methods in sources_of(shared).items():
                found[key] = list(dict.fromkeys([*found.get(key, []), *methods]))
            constants = catalogue_sources(shared) | constants
    return found, constants | constants_of_element(element)
