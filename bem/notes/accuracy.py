"""Notes on error bars and on an accuracy that was asked for."""

from collections.abc import Iterable
from enum import StrEnum
from typing import Any

from bem.notes.figure_names import figure_name
from bem.notes.note import Level, Note, define

CAUTION, INFO = Level.CAUTION, Level.INFO


INPUT_UNPROPAGATED = define(
    "input-unpropagated",
    CAUTION,
    "The uncertainty of an input is not propagated.",
    "A run with a changed {key} failed ({why}): figures have no error by their inputs.",
    "Give a smaller standard deviation, or leave the key out of uncertain.",
)


class NoBar(StrEnum):
    """Why figures have no error bar."""

    COARSER_UNSOLVED = "coarser-unsolved"
    TOO_SMALL = "too-small"
    FREE_EDGE = "free-edge"
    FEW_CELLS_WIDE = "few-cells-wide"
    IMPOSSIBLE = "impossible"
    NARROW_RING = "narrow-ring"
    SHARP_PRESSURE = "sharp-pressure"
    EVEN_CELLS = "even-cells"
    EVEN_CELLS_OF_LOOP = "even-cells-of-loop"
    SHORT_MARCH = "short-march"
    SPIKE = "spike"
    SPIKE_AT_CENTRE = "spike-at-centre"
    ONE_PLACE_AMONG_BUMPS = "one-place-among-bumps"
    STRESS_OF_CAPPED = "stress-of-capped"
    STRESS_OF_SHARP = "stress-of-sharp"
    SHALLOWEST_DEPTH = "shallowest-depth"
    DEEPEST_DEPTH = "deepest-depth"
    NOTHING_WEARS = "nothing-wears"
    LEAST_FILM = "least-film"
    OTHER_SUMMITS = "other-summits"
    SCALED_FILM = "scaled-film"
    REPEATED_CELL = "repeated-cell"
    FEW_PARTICLES = "few-particles"
    SCATTERED_PARTICLES = "scattered-particles"
    NO_COARSE_FILM = "no-coarse-film"
    FEW_FILM_CELLS = "few-film-cells"
    SINGLE_LOOP = "single-loop"
    OF_KIND = "of-kind"


NO_ERROR_BAR = define(
    "no-error-bar",
    INFO,
    "No error bars for {figures:few}.",
    reasons={
        NoBar.COARSER_UNSOLVED: "The coarser solution to compare with did not converge.",
        NoBar.TOO_SMALL: "The grid is too small to be compared with one of twice the cell; take more cells.",
        NoBar.FREE_EDGE: "The contact reaches a free edge of the grid, where bodies end and pressures keep growing on "
        "finer grids.",
        NoBar.FEW_CELLS_WIDE: (
            "The contact is one or two cells wide, and its figures follow the cells; take a finer grid, of "
            "measured surfaces a finer map."
        ),
        NoBar.IMPOSSIBLE: "What is prescribed cannot be met on the grid of twice the cell.",
        NoBar.NARROW_RING: "The zone that slips is narrower than a cell, and its energy follows the cells; take more.",
        NoBar.SHARP_PRESSURE: (
            "The contact has sharp edges or ridges, where pressures, and stresses close below them, keep "
            "growing on finer grids."
        ),
        NoBar.EVEN_CELLS: "Error bars need even numbers of cells, {fewest} at least.",
        NoBar.EVEN_CELLS_OF_LOOP: (
            "A coarser run needs even numbers of cells, {fewest} at least (or, along y, surfaces that do not "
            "change), and contacts that converge on the grid of twice the cell."
        ),
        NoBar.SHORT_MARCH: "Error bars need four time steps or more.",
        NoBar.SPIKE: "The pressure spike is as high as the mesh is fine.",
        NoBar.SPIKE_AT_CENTRE: (
            "The pressure spike before the outlet lies at the centre, and its height follows the cells."
        ),
        NoBar.ONE_PLACE_AMONG_BUMPS: "They are values at one place among bumps a few cells long.",
        NoBar.STRESS_OF_CAPPED: (
            "The highest stress lies less than a cell below the surface of a capped contact; it follows the cells and "
            "may keep growing on finer grids."
        ),
        NoBar.STRESS_OF_SHARP: (
            "The highest stress lies less than a cell below sharp edges or ridges; it keeps growing on finer grids."
        ),
        NoBar.SHALLOWEST_DEPTH: (
            "The highest stress lies at the shallowest depth; begin outputs.depths nearer the surface."
        ),
        NoBar.DEEPEST_DEPTH: "The highest stress lies at the deepest depth; take deeper outputs.depths.",
        NoBar.NOTHING_WEARS: (
            "Nothing wears on the grid of twice the cell, or here; whether anything does on finer cells is not known."
        ),
        NoBar.LEAST_FILM: (
            "In boundary lubrication the film is that of the largest load that a film can be left with."
        ),
        NoBar.OTHER_SUMMITS: (
            "Uncoupled asperities have other summits on a grid of twice the cell; figures converge where the "
            "shortest waves have some nine cells."
        ),
        NoBar.SCALED_FILM: (
            "The film is extrapolated from a smaller load: such minima were up to 20 times too large, or a third of "
            "the solved one."
        ),
        NoBar.REPEATED_CELL: "The error of a cell that repeats is not known; compare with half the spacing.",
        NoBar.FEW_PARTICLES: "There are fewer than two particles.",
        NoBar.SCATTERED_PARTICLES: "{count} particles: uncertain by more than {most:.0f} times the value.",
        NoBar.NO_COARSE_FILM: "On half as many cells there is no film to compare with.",
        NoBar.FEW_FILM_CELLS: "Half as many cells are too few to compare with: take {nx} x {ny} cells.",
        NoBar.SINGLE_LOOP: (
            "A single loop has none: cycles.coarser_grid = true makes it once more on the grid of twice the cell; "
            "repetitions show how figures scatter with the surface, of measured surfaces runs on other maps."
        ),
        NoBar.OF_KIND: "{why}.",
    },
)
ERROR_BARS_LOST = define(
    "error-bars-lost",
    CAUTION,
    "No error bars: the grid of twice the cell did not converge.",
    "Error bars compare this result with that of a grid of twice the cell.",
    "Halve the cells: this grid, which converged, is then the coarser one.",
)
BARS_PARTIAL = define(
    "error-bars-partial",
    INFO,
    "Error bars do not cover every error.",
    reasons={
        "half-cells": (
            "Those of rough films come from half as many cells, and bumps show no order of convergence there; on "
            "random balls they covered about nine errors in ten."
        ),
        "large-particles": (
            "Those of weighted particle means may be too small: large particles are more frequent than in a log-normal "
            "distribution; of such samples half to two thirds were covered."
        ),
        "scatter": (
            "They are standard errors of the mean over {repetitions} repetitions alone{but}; errors of cells, depths "
            "and tolerances are not in them."
        ),
        "life": "Figures are means over {positions} positions, and bars hold {hold}.",
    },
)
ACCURACY = define(
    "accuracy",
    INFO,
    "The accuracy asked for {met}.",
    reasons={
        "reached": "On {on}. Asked for is {asked}.{steps}",
        "left-out": "{figures:few}: {why}.",
    },
)


def no_error_bar(names: Iterable[str], reason: NoBar, **values: Any) -> Note:
    """Return the note on figures without error bars; names as of a record's fields."""
    return NO_ERROR_BAR(figures=named(names), reason=reason, **values)


def one_note_per_cause(notes: Iterable[Note]) -> list[Note]:
    """Return the notes, those on missing error bars of one cause as one that names all of its figures."""
    notes = list(notes)
    reasons = {note.values["reason"] for note in notes if note.code == NO_ERROR_BAR.code}
    found: dict[Any, Note] = {}
    for number, note in enumerate(notes):
        if note.code != NO_ERROR_BAR.code:
            found[number] = note
            continue
        reason = _WIDER_CAUSES.get(note.values["reason"], note.values["reason"])
        values = {**note.values, "reason": reason if reason in reasons else note.values["reason"]}
        figures = values.pop("figures")
        cause = note.where, note.level, *sorted((key, str(value)) for key, value in values.items())
        before = found[cause].values["figures"] if cause in found else []
        found[cause] = NO_ERROR_BAR(
            note.where, level=note.level, figures=list(dict.fromkeys([*before, *figures])), **values
        )
    return list(found.values())


_WIDER_CAUSES = {NoBar.STRESS_OF_SHARP: NoBar.SHARP_PRESSURE}
"""Reasons that another one covers where both are given."""


def named(names: Iterable[str]) -> list[str]:
    """Return the names of figures in words, as tables have them."""
    keys = list(names)
    rows = [name for name in keys if f"lower_{name}" not in keys]  # tables have these under the body's name alone
    return list(dict.fromkeys(_OTHER_NAMES.get(name) or figure_name(name) for name in rows))


_OTHER_NAMES = {
    "loaded_contact_load": "the contact load with the oil of the loaded zone",
    "loaded_friction": "the friction with the oil of the loaded zone",
}
"""Words for figures whose keys read like others."""
