"""`bem element`."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bem.physical_constants import ZERO_CELSIUS

if TYPE_CHECKING:
    from bem.elements.contact import ElementContact
    from bem.elements.element import Element
    from bem.elements.running import Running
    from bem.notes import Note


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(short_help="Bearing, gear pair, cam, piston ring, bush: contacts, and scenes of them.")(element)


def element(
    file: Annotated[Path, typer.Argument(help="An element's file; `bem new gear-pair` writes one to start from.")],
    scene: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a scene of one contact.")] = None,
    kind: Annotated[
        str,
        typer.Option(
            help="Kind of that scene: traction, point-film (of balls), contact (dry), friction and running-in (mixed "
            "lubrication), running-in-life (wear by a rate, of rollers, gears, cams), surface-temperature."
        ),
    ] = "traction",
    at: Annotated[
        str,
        typer.Option(
            help="Which contact: worst (highest pressure), thinnest (film), a mark such as C, a row number; path: all "
            "along a path. Without it worst, for friction, running-in and running-in-life thinnest.",
        ),
    ] = "",
    path: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the path of contact as .csv, for `along` of kind traction."),
    ] = None,
    table: Annotated[Path | None, typer.Option(metavar="FILE", help="Write all contacts as .csv.")] = None,
    figure: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw all contacts, with A to E of gears: .png, .pdf or .svg.")
    ] = None,
    contacts: Annotated[
        bool,
        typer.Option(
            "--contacts",
            help="Show the table of all contacts in place of the answer; solves no film but of bushes and of a heat "
            "balance.",
        ),
    ] = False,
    running: Annotated[
        bool, typer.Option("--running", help="Solve the film at every position, for the answer, table and figure.")
    ] = False,
    cases: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Rows of keys to change, .csv with units: a line for each.")
    ] = None,
    remarks: Annotated[bool, typer.Option("--remarks", help="Show the whole text of cautions and remarks.")] = False,
) -> None:
    """Answer for a machine element on one screen: critical contact, lambda ratio, friction power, temperatures, and
    safety: rating life of bearings, scuffing and micropitting of gears, p v and wear life of bushes. Films are solved
    at about a dozen places, with --running at all.

    \b
    Examples, of the file that `bem new gear-pair gears.toml` writes:
      bem element gears.toml
      bem element gears.toml --running --table gears.csv --figure gears.png
      bem element gears.toml --contacts
      bem element gears.toml --scene flank.toml --at path
      bem element gears.toml --scene worst.toml --at thinnest
      bem element gears.toml --scene mixed.toml --kind friction --at 20
      bem element bearing.toml --cases loads.csv --table worst.csv
    """
    from bem.cli._quantity import new_file
    from bem.cli._terminal import Terminal, print_text, print_written, show_warnings
    from bem.cli.run import tell_compiling
    from bem.elements.answer import all_notes, balance_heat, contact_words, place_words, scene_notes, table_columns
    from bem.elements.element import load_element, unusual_values_named
    from bem.elements.figure import draw_element
    from bem.elements.plain_bush import PlainBushModel
    from bem.elements.scene_text import element_scene_text
    from bem.errors import InputError
    from bem.notes.checks import YIELDS
    from bem.results.atomic import write_text
    from bem.scenes.load import scene_from_table

    if scene is None and kind != "traction":
        raise InputError(f"--kind {kind}: the kind of a scene; allowed: --scene FILE beside it, which is written")
    if at and scene is None and not contacts:
        raise InputError(f"--at {at}: which contact a scene is of; allowed: --scene FILE or --contacts beside it")
    if table is not None:
        new_file(table, "--table", (".csv",))
    if path is not None:
        new_file(path, "--path", (".csv",))
    if figure is not None:
        new_file(figure, "--figure", (".png", ".pdf", ".svg"))
    if scene is not None:
        new_file(scene, "--scene", (".toml",))
    if cases is not None:
        _cases(file, cases, table, (scene, path, running, contacts, figure), remarks=remarks)
        return
    loaded = load_element(file)
    tell_compiling(loaded)
    with unusual_values_named(loaded), Terminal() as terminal:
        found = balance_heat(
            loaded, told=lambda done, total: terminal.progress(done, total, "heat balance, films of a round", {})
        )
    whole = at == "path"
    chosen = found.critical() if whole or not at else _chosen(found, at)
    if not at and scene is not None:
        chosen, critical = found.contact_for(kind), found.critical()
        if _thinnest_unsteady(found, kind):
            chosen = _with_steady_film(found, found.thinnest(), "thinnest", kind)
        elif chosen is not critical:
            print_text(f"Scene of the contact with the thinnest film, {place_words(found, chosen)}.")
        lower = chosen.hertz(found.modulus).maximum_pressure < critical.hertz(found.modulus).maximum_pressure
        if lower and abs(critical.slide_roll_ratio) <= 2:
            print_text(f"The highest pressure is at {place_words(found, critical)}: --at worst.")
    if scene is not None and at in ("worst", "thinnest"):
        chosen = _with_steady_film(found, chosen, at, kind)
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
    runs: Sequence[Running] = ()
    lubricated = found.model.oil is not None
    bush = isinstance(found.model, PlainBushModel)  # its one film gives its friction and temperature
    film = made is None or kind in _FILM_KINDS  # the scene of a bush's film has its limits
    if running or (lubricated and (film if bush else made is None and not contacts)):
        with unusual_values_named(found):
            runs = _solve(found, whole=running or table is not None)
    if contacts:
        _show(found, chosen, runs)
    elif made is None or running:
        _answer(found, runs)
    else:
        for sentence in (contact_words(found, chosen), *found.found.geometry):
            print_text(sentence)
        if kind == "point-film":
            print_text("The film of kind point-film has no heat; the line film of the answer has it.")
    shown = made is None or running
    notes: Sequence[Note] = all_notes(found, runs) if shown else scene_notes(found, runs, kind)
    if made is not None and not whole:  # the scene's own checks judge its place
        notes = [note for note in notes if note.code != YIELDS.code or note.values["place"] == chosen.name]
    if remarks:
        for note in notes:
            print_text(f"  {note}")
    else:
        show_warnings(notes, remarks="--remarks shows them")
    if path is not None and rows is not None:
        write_text(path, rows)
        print_written(path)
    if table is not None:
        write_text(table, found.csv(table_columns(found, runs)))
        print_written(table)
    if figure is not None:
        draw_element(found, runs, figure)
        print_written(figure)
    if scene is not None and made is not None:
        write_text(scene, element_scene_text(found, made))
        print_written(scene)
        print(f"next:    bem plan {scene}; bem run {scene}")


def _cases(file: Path, rows: Path, out: Path | None, others: tuple[object, ...], *, remarks: bool) -> None:
    """A line for each case. remarks : whether notes are shown whole, with remarks."""
    from bem.cli._terminal import Terminal, print_text, print_written, show_warnings, table
    from bem.cli.run import tell_compiling
    from bem.elements.answer import PLACES, all_notes, balance_heat
    from bem.elements.cases import changed_keys, columns, load_cases, notes_of_cases, power_source
    from bem.elements.element import csv_text, read_element
    from bem.elements.plain_bush import PlainBushModel
    from bem.elements.running import run_all
    from bem.errors import InputError
    from bem.notes import Level
    from bem.notes.elements import BUSH_TOUCHES, SURFACES_TOUCH
    from bem.notes.note import has_code
    from bem.results.atomic import write_text

    if any(others):
        raise InputError(
            "--cases: goes with --table alone; allowed: no --scene, --path, --figure, --contacts or --running beside it"
        )
    cases, changed = load_cases(file, rows), changed_keys(file, rows)
    runs: list[Sequence[Running]] = []
    if not any(one.model.oil is None for one in cases):
        tell_compiling(cases[0])
        with Terminal() as terminal:
            balanced = []

            def show_films(done: int, total: int) -> None:
                terminal.progress(done, total, "films of the case", {})

            for done, one in enumerate(cases):
                terminal.progress(done, len(cases), "cases", {})
                balanced.append(balance_heat(one, told=show_films))
                runs.append(run_all(balanced[-1], show_films, most=PLACES))
        cases = tuple(balanced)
    found = columns(cases, runs, changed)
    told: list[Sequence[Note]] = []
    for one, each in zip(cases, runs or [()] * len(cases), strict=True):
        every = all_notes(one, each)
        bush = isinstance(one.model, PlainBushModel)
        told.append([note for note in every if bush or remarks or note.level is not Level.INFO])
    if remarks:
        for note in notes_of_cases(told):
            print_text(f"  {note}")
    else:
        show_warnings(notes_of_cases(told), remarks="--remarks shows them")
    if has_code(chain.from_iterable(told), SURFACES_TOUCH, BUSH_TOUCHES):
        print_text("For the scene of a row put its keys in FILE.")
    unnamed = [f"{read_element(file)['name']}-{number}" for number in range(1, len(cases) + 1)]
    named = found["case"] != unnamed
    hidden = {*([] if named else ["case"]), *([*_BY_FORMULA, "thinnest_by_formula"] if runs else [])}
    if all(isinstance(one.model, PlainBushModel) for one in cases):  # one contact, under the radial load
        hidden |= {"worst", "thinnest", *(["load [N]"] if "radial_load" in changed else [])}
    shown = [name for name in found if name not in hidden]
    rough = [_estimates(found, row) for row in range(len(cases))]
    lines = [
        tuple(
            one if isinstance(one, str) else _rounded(name, one) if name in about else _spelled(name, one)
            for name, one in zip(shown, row, strict=True)
        )
        for about, row in zip(rough, zip(*(_life_words(found, name) for name in shown), strict=True), strict=True)
    ]
    source = power_source(cases)
    heads = _CASE_HEADS | ({"friction_power [W]": f"friction power ({source})"} if source else {})
    head = tuple(heads.get(name, name.partition(" [")[0].replace("_", " ")) for name in shown)
    leading = len(changed) + named
    table(head, lines, right=range(leading, len(shown)), leading=leading)
    if out is not None:
        write_text(out, csv_text(found))
        print_written(out)


def _life_words(found: Mapping[str, list[float | str]], name: str) -> list[float | str]:
    """Return a column of the cases, of modified lives with "not defined" where kappa is too small for ISO 281."""
    if name not in ("modified_life [h]", "modified_reference_life [h]"):
        return found[name]
    return [
        "not defined" if math.isnan(float(life)) and not math.isnan(float(kappa)) else life
        for life, kappa in zip(found[name], found["viscosity_ratio"], strict=True)
    ]


def _estimates(found: Mapping[str, list[float | str]], row: int) -> tuple[str, ...]:
    """Return the columns of a case that are known as estimates: film and lambda ratio of a bush beside those of a
    journal bearing, and where that stands in place of the film the friction, too."""
    from bem.elements.cases import JOURNAL

    journal = float(found[JOURNAL][row]) if JOURNAL in found else math.nan
    if math.isnan(journal):
        return ()
    films = ("solved_minimum_film [m]", "solved_film_over_roughness")
    return (*films, "friction_coefficient", "friction_power [W]") if found[films[0]][row] == journal else films


def _rounded(name: str, value: float) -> str:
    """Return an estimate in two digits, "about 27 um"."""
    from bem.quantities import plain_digits, si, with_signs

    if math.isnan(value):
        return ""
    unit = name.partition(" [")[2].removesuffix("]")
    return f"about {with_signs(si(value, unit, 2)) if unit else plain_digits(value)}"


def _spelled(name: str, value: float) -> str:
    """A number in the unit of its column's name, "load [N]"."""
    from bem.elements.cases import JOURNAL
    from bem.plots.report import spelled
    from bem.quantities import plain_digits, with_unit

    unit = name.partition(" [")[2].removesuffix("]")
    if unit == "h" and not math.isnan(value):
        return f"{plain_digits(value, 3)} h"
    if unit == "K":
        digits = 4 if name == "bush_temperature [K]" else 3  # beside a limit
        return "" if math.isnan(value) else f"{value - ZERO_CELSIUS:.{digits}g} °C"
    if unit == "m/s":
        return with_unit(value, unit)
    if unit == "Pa*m/s":
        return f"{1e-6 * value:.3g} MPa m/s"
    if name == JOURNAL:
        return _rounded(name, value)
    return "" if math.isnan(value) else spelled(f"x_{unit}" if unit else "x", value)[1]


def _solve(found: Element, *, whole: bool) -> Sequence[Running]:
    """Solve the films of an element, of all its places or of a selection."""
    from bem.cli._terminal import Terminal
    from bem.elements.answer import PLACES
    from bem.elements.running import run_all

    with Terminal() as terminal:
        return run_all(
            found, lambda done, total: terminal.progress(done, total, "films", {}), most=None if whole else PLACES
        )


def _answer(found: Element, runs: Sequence[Running]) -> None:
    from bem.cli._terminal import print_text, table
    from bem.elements.answer import answer
    from bem.elements.element import rpm
    from bem.quantities import plain_digits

    described = f", {found.model.description}" if found.model.description else ""
    speed = getattr(found.model, "speed", None)
    described += f", {plain_digits(rpm(speed), 4)} rpm" if speed else ""
    swing = getattr(found.model, "oscillation", None)
    described += f", ±{math.degrees(swing.amplitude):.3g}°, {swing.frequency:.3g} Hz" if swing else ""
    named = f"{found.model.name}: " if found.model.name != found.model.element else ""
    table(("", ""), answer(found, runs), title=f"{named}{found.model.element}{described}")
    for sentence in found.found.geometry:
        print_text(sentence)
    count = len(found.found.contacts)
    solved = f", {len(runs)} solved film{'s' if len(runs) > 1 else ''}" if runs else ""
    them = "them" if count > 1 else "it"
    options = f"--contacts shows {them}, --table FILE.csv and --figure FILE.png write {them}"
    print_text(f"{count} contact{'s' if count > 1 else ''}{solved}: {options}.")


def _chosen(found: Element, at: str) -> ElementContact:
    from bem.elements.gear_pair import GearModel
    from bem.errors import InputError

    if at == "worst":
        return found.critical()
    if at == "thinnest":
        return found.thinnest()
    contacts, marks = found.found.contacts, "".join(f"{name}, " for name in found.found.marks)
    if at in found.found.marked:
        return found.found.marked[at]
    if at.isdigit() and 1 <= int(at) <= len(contacts):
        return contacts[int(at) - 1]
    path = "path, " if isinstance(found.model, GearModel) else ""
    raise InputError(f'--at "{at}": allowed: worst, thinnest, {path}{marks}or a number from 1 to {len(contacts)}')


_FILM_KINDS = ("traction", "point-film", "friction", "running-in", "running-in-life")
"""Kinds of scene with an oil film."""


def _thinnest_unsteady(found: Element, kind: str) -> bool:
    """Return True if a scene takes the thinnest film and the surfaces run against each other at that place."""
    from bem.elements.element import LIFE, MIXED

    return kind in (*MIXED, LIFE) and found.model.oil is not None and abs(found.thinnest().slide_roll_ratio) > 2


def _with_steady_film(found: Element, chosen: ElementContact, at: str, kind: str) -> ElementContact:
    """Return the contact of a scene with a film: the one named by `at`, or the thinnest steady film, with a sentence,
    where the surfaces of the named one run against each other."""
    from bem.cli._terminal import print_text
    from bem.elements.answer import place_words

    if found.model.oil is None or kind not in _FILM_KINDS or abs(chosen.slide_roll_ratio) <= 2:
        return chosen
    steady = found.thinnest_steady()
    if abs(steady.slide_roll_ratio) <= 2:
        place = "highest pressure" if at == "worst" else "the thinnest film"
        print_text(
            f"At the place of {place} the surfaces run against each other, without a steady film: scene of the "
            f"thinnest steady film, {place_words(found, steady)}."
        )
    return steady


def _show(found: Element, chosen: ElementContact, runs: Sequence[Running]) -> None:
    """Show all contacts as a table, with the solved films where there are any."""
    from bem.cli._terminal import print_text, table
    from bem.elements.answer import table_columns
    from bem.quantities import digits_apart

    contacts = found.found.contacts
    mine = found.columns() | table_columns(found, runs)
    mine["entrainment_speed [m/s]"] = [one.mean_speed for one in contacts]
    mine["slide_roll_ratio"] = [one.slide_roll_ratio for one in contacts]
    shown = [key for key in _HEADS if key in mine and not (runs and key in _BY_FORMULA)]
    shown = [key for key in shown if not all(map(math.isnan, mine[key]))]
    units = {key: _unit(key, mine[key]) for key in shown}
    values = {key: [units[key][1](value) for value in mine[key]] for key in shown}
    digits = dict(zip(shown, digits_apart(list(values.values())), strict=True))
    rows = []
    marked = chosen if chosen in contacts else min(contacts, key=lambda one: abs(one.place - chosen.place))
    for i, one in enumerate(contacts):
        cells = ["" if math.isnan(values[key][i]) else f"{values[key][i]:.{digits[key]}g}" for key in shown]
        rows.append((f"{i + 1} <" if one is marked else str(i + 1), _contact_name(found, i), *cells))
    heads = [f"{_HEADS[key]} ({units[key][0]})" if units[key][0] else _HEADS[key] for key in shown]
    head = ["", "where", *heads]
    title = f"{found.model.name}: {found.model.element}"
    table(head, rows, title=title, right=range(2, len(head)), leading=2)
    if any(one.slide_roll_ratio < 0 for one in contacts):
        print_text(
            "Slide-to-roll ratio and friction coefficient of the film are those of body 1: negative where its surface "
            "is the slower one, as before the pitch point of a driving pinion. Friction power is positive everywhere."
        )
    for sentence in found.found.geometry:
        print_text(sentence)


def _unit(key: str, values: Sequence[float]) -> tuple[str, Callable[[float], float]]:
    """Return the unit of a column's head and the conversion of its numbers to it: one prefix for all."""
    from bem.plots.labels import prefix
    from bem.quantities import with_signs

    unit = key.partition(" [")[2].removesuffix("]")
    if unit == "K" and "flash" not in key:
        return "°C", lambda value: value - ZERO_CELSIUS
    known = [value for value in values if not math.isnan(value)]
    factor, shown = prefix(known, unit)
    return with_signs(shown), lambda value: value * factor


def _contact_name(found: Element, index: int) -> str:
    """Name of a contact in a table: its position along the path, with the letter of a marked point nearest to it."""
    from bem.elements.element import degrees

    one = found.found.contacts[index]
    where = one.name if found.found.along_unit == "rad" else degrees(one, found.found.along_unit)
    return f"{where}  {found.letters()[index]}".rstrip()


_BY_FORMULA = {
    "minimum_film [m]": "minimum film thickness (formula)",
    "film_over_roughness": "lambda ratio (formula)",
}
"""Heads of the columns that follow from a film formula; those of a solved film are other values."""
_CASE_HEADS = {
    **_BY_FORMULA,
    "worst": "highest pressure at",
    "thinnest": "thinnest film at",
    "solved_minimum_film [m]": "minimum film thickness",
    "solved_film_over_roughness": "lambda ratio",
    "journal_bearing_film_estimate [m]": "film as journal bearing (estimate)",
    "viscosity_ratio": "kappa",
    "basic_life [h]": "L10",
    "viscosity_ratio_of_film": "kappa of lambda",
    "modified_life [h]": "L10m",
    "reference_life [h]": "L10r",
    "modified_reference_life [h]": "L10mr",
    "static_safety": "C0 / P0",
    "scuffing_safety_contact_temperature": "scuffing safety (contact temperature)",
    "scuffing_safety_integral_temperature": "scuffing safety (integral temperature)",
}
"""Heads of the table of cases."""
_HEADS = {
    "load [N]": "load",
    "radius [m]": "radius",
    "hertz_pressure [Pa]": "Hertz pressure",
    "peak_pressure [Pa]": "peak pressure of shaft in bush",
    "entrainment_speed [m/s]": "entrainment speed",
    "slide_roll_ratio": "slide-roll",
    **_BY_FORMULA,
    "solved_minimum_film [m]": "minimum film thickness",
    "journal_bearing_film_estimate [m]": "film as journal bearing (estimate)",
    "solved_film_over_roughness": "lambda ratio",
    "friction": "friction coefficient of the film",
    "friction_power [W]": "friction power of the film",
    "rolling_loss [W]": "of it rolling loss",
    "oil_temperature [K]": "oil",
    "friction_power_with_asperities [W]": "friction power with asperities",
    "bush_temperature [K]": "bush",
    "surface_temperature [K]": "hotter surface",
    "flash_temperature [K]": "flash (of the film alone)",
    "wear_per_pass_1 [m]": "wear 1 per pass",
    "wear_per_pass_2 [m]": "wear 2 per pass",
}
"""Columns of the table of contacts with their heads."""
