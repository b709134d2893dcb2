"""`bem element`."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from bem.elements.contact import ElementContact
    from bem.elements.element import Element
    from bem.notes import Note


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(short_help="Bearing, gear pair, cam, piston ring: contacts, and scenes of them.")(element)


def element(
    file: Annotated[Path, typer.Argument(help="An element's file; `bem new gear-pair` writes one to start from.")],
    scene: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a scene of one contact.")] = None,
    kind: Annotated[
        str,
        typer.Option(
            help="Kind of that scene: traction, point-film (of balls), contact (dry), friction and running-in (mixed "
            "lubrication), surface-temperature."
        ),
    ] = "traction",
    at: Annotated[
        str, typer.Option(help="Which contact: worst, thinnest, a row number; path: all along a gear's path.")
    ] = "worst",
    path: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the path of contact as .csv, for `along` of kind traction."),
    ] = None,
    table: Annotated[Path | None, typer.Option(metavar="FILE", help="Write all contacts as .csv.")] = None,
    running: Annotated[
        bool, typer.Option("--running", help="Solve the thermal film at every position: friction, power loss, wear.")
    ] = False,
    cases: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Rows of keys to change, .csv with units: a line for each.")
    ] = None,
    remarks: Annotated[bool, typer.Option("--remarks", help="Show the whole text of remarks, too.")] = False,
) -> None:
    """Show the contacts of a machine element: load, radii, speeds, Hertz contact and film; marks the critical contact
    and reports contacts for which the half-space or line-contact assumption is not valid.

    \b
    Examples, of the file that `bem new gear-pair gears.toml` writes:
      bem element gears.toml --scene flank.toml --at path
      bem element gears.toml --scene worst.toml --at thinnest
      bem element gears.toml --scene mixed.toml --kind friction --at 20
      bem element gears.toml --running --table gears.csv
      bem element bearing.toml --cases loads.csv --table worst.csv
    """
    from bem.cli._quantity import new_file
    from bem.cli._terminal import print_written, show_remarks, show_warnings
    from bem.elements.element import load_element
    from bem.elements.scene_text import scene_text
    from bem.errors import InputError
    from bem.results.atomic import write_text
    from bem.scenes.load import scene_from_table

    if table is not None:
        new_file(table, "--table", (".csv",))
    if path is not None:
        new_file(path, "--path", (".csv",))
    if scene is not None:
        new_file(scene, "--scene", (".toml",))
    if cases is not None:
        _cases(file, cases, table, (scene, path, running))
        return
    found = load_element(file)
    whole = at == "path"
    chosen = found.worst() if whole else _chosen(found, at)
    if scene is not None and whole and kind != "traction":
        raise InputError(f"--at path: makes a scene of kind traction; allowed: no --kind, or one place, not {kind}")
    made = None if scene is None else found.path_scene() if whole else found.scene(chosen, kind)
    if made is not None:
        scene_from_table(made)
    if scene is not None and made is not None and whole:
        path = path or new_file(scene.with_name(f"{scene.stem}-path.csv"), "--scene", (".csv",))
        made["along"] = {"path": os.path.relpath(path, scene.parent)} | {
            key: value for key, value in made["along"].items() if key == "marks"
        }
    rows = None if path is None else found.path_csv()
    notes: Sequence[Note] = found.notes()
    more: dict[str, list[float]] = {}
    if running:
        more, notes = _operation(found)
    else:
        _show(found, chosen)
    show_warnings(notes, remarks="--remarks shows them")
    if remarks:
        show_remarks(notes)
    if path is not None and rows is not None:
        write_text(path, rows)
        print_written(path)
    if table is not None:
        write_text(table, found.csv(more))
        print_written(table)
    if scene is not None and made is not None:
        write_text(scene, scene_text(made))
        print_written(scene)
        print(f"next:    bem plan {scene}; bem run {scene}")


def _cases(file: Path, rows: Path, out: Path | None, others: tuple[object, ...]) -> None:
    """A line for each case."""
    from bem.cli._terminal import print_written, table
    from bem.elements.cases import columns, load_cases
    from bem.elements.element import csv_text
    from bem.errors import InputError
    from bem.results.atomic import write_text

    if any(others):
        raise InputError("--cases: goes with --table alone; allowed: no --scene, --path or --running beside it")
    found = columns(load_cases(file, rows))
    lines = [
        tuple(one if isinstance(one, str) else _spelled(name, one) for name, one in zip(found, row, strict=True))
        for row in zip(*found.values(), strict=True)
    ]
    head = tuple(_BY_FORMULA.get(name, name.partition(" [")[0].replace("_", " ")) for name in found)
    table(head, lines, right=range(2, len(found)), leading=2)
    if out is not None:
        write_text(out, csv_text(found))
        print_written(out)


def _spelled(name: str, value: float) -> str:
    """A number in the unit of its column's name, "load [N]"."""
    from bem.plots.report import spelled

    unit = name.partition(" [")[2].removesuffix("]")
    if unit == "K":
        return "" if math.isnan(value) else f"{value - 273.15:.4g} degC"
    return "" if math.isnan(value) else spelled(f"x_{unit}" if unit else "x", value)[1]


def _operation(found: Element) -> tuple[dict[str, list[float]], list[Note]]:
    """Show the element with the solved film of every contact; return the columns of these films and all notes."""
    from bem.cli._terminal import Terminal, print_text, table
    from bem.elements.running import columns, notes, run_all, summary

    with Terminal() as terminal:
        runs = run_all(found, lambda done, total: terminal.progress(done, total, "films", {}))
    solved = columns(found, runs)
    by_formula = found.columns()
    lines = []
    for i, (contact, *row) in enumerate(zip(found.found.contacts, *solved.values(), strict=True)):
        if all(map(math.isnan, row)):
            continue
        cells = [_spelled(name, value) for name, value in zip(solved, row, strict=True)]
        pressure = _spelled("hertz_pressure [Pa]", by_formula["hertz_pressure [Pa]"][i])
        lines.append((str(i + 1), _contact_name(found, i), pressure, f"{contact.slide_roll_ratio:.3g}", *cells))
    head = (
        *("", "where", "Hertz pressure", "slide-roll", "minimum film thickness (solved)", "lambda ratio (solved)"),
        *("friction coefficient", "friction power", "oil temperature", "surface temperature"),
        *("wear 1 per pass", "wear 2 per pass"),
    )
    title = f"{found.model.name}: {found.model.element}, at operating conditions"
    table(head, lines, title=title, right=range(2, len(head)), leading=2)
    for sentence in found.found.geometry:
        print_text(sentence)
    table(("", ""), summary(found, runs))
    return solved, [*found.notes(), *notes(runs)]


def _chosen(found: Element, at: str) -> ElementContact:
    from bem.errors import InputError

    if at == "worst":
        return found.worst()
    if at == "thinnest":
        return found.thinnest()
    contacts = found.found.contacts
    if at.isdigit() and 1 <= int(at) <= len(contacts):
        return contacts[int(at) - 1]
    raise InputError(f'--at "{at}": allowed: worst, thinnest, path, or a number from 1 to {len(contacts)}')


def _show(found: Element, chosen: ElementContact) -> None:
    from bem.cli._terminal import print_text, table
    from bem.plots.report import spelled

    columns = found.columns()
    shown = (("load", "load [N]", "N"), ("radius", "radius [m]", "m"), ("Hertz pressure", "hertz_pressure [Pa]", "Pa"))
    rows = []
    for i, one in enumerate(found.found.contacts):
        cells = [spelled(f"x_{unit}", columns[key][i])[1] for _, key, unit in shown]
        ratio = one.slide_roll_ratio
        cells += [f"{one.mean_speed:.3g} m/s", f"{ratio:.3g}"]
        if "minimum_film [m]" in columns:
            cells.append(spelled("x_m", columns["minimum_film [m]"][i])[1])
        if "film_over_roughness" in columns:
            cells.append(f"{columns['film_over_roughness'][i]:.3g}")
        number = f"{i + 1} <" if one is chosen else str(i + 1)
        rows.append((number, _contact_name(found, i), *cells))
    head = ["", "where", *(name for name, _, _ in shown), "entrainment speed", "slide-roll"]
    head += [_BY_FORMULA[name] for name in _BY_FORMULA if name in columns]
    title = f"{found.model.name}: {found.model.element}"
    table(head, rows, title=title, right=range(2, len(head)), leading=2)
    for sentence in found.found.geometry:
        print_text(sentence)


def _contact_name(found: Element, index: int) -> str:
    """Name of a contact in a table: its position along the path, with the letter of a marked point nearest to it."""
    from bem.elements.element import degrees

    one = found.found.contacts[index]
    where = one.name if found.found.along_unit == "rad" else degrees(one, found.found.along_unit)
    return f"{where}  {_letters(found)[index]}".rstrip()


def _letters(found: Element) -> list[str]:
    """Letters of the marked places of a path at the rows nearest to them, empty elsewhere."""
    letters = [""] * len(found.found.contacts)
    for name, place in found.found.marks.items():
        nearest = min(range(len(letters)), key=lambda i: abs(found.found.contacts[i].place - place))
        letters[nearest] = f"{letters[nearest]} {name}".strip()
    return letters


_BY_FORMULA = {
    "minimum_film [m]": "minimum film thickness (formula)",
    "film_over_roughness": "lambda ratio (formula)",
}
"""Heads of the columns that follow from a film formula; those of a solved film are other values."""
