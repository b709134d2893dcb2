"""Worn macroscopic shape in the film of a wear loop: wear of the body that stands with the contact.

1. The shape w(x) is the mean along y of the worn depth, smoothed by a Gaussian a quarter as wide as Hertz' half-width.
   A body that moves through the contact wears alike along its whole track and keeps its shape.
2. The shape deepens the gap of the smooth bodies. The rough contact sees the rest, heights plus w, so that no height
   counts twice.
3. The films follow w in steps. The change of w since the films' shape, without its uniform part, over the gap at the
   same place has a largest value c; the film carries the share s of the load. Films of the new shape are solved where
   c > `RESOLUTION` or s c > `SHARE_RESOLUTION`, and films of the same shape where the balance needs other loads.
4. Where no film of a new shape is found, the last shape stays, and a note says so.

Cost: some films per step of the shape, fewer than cycles. Verified in tests/wear/test_worn_shape.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from bem.errors import InputError
from bem.friction.balance import Balance, Regime
from bem.friction.film import Film, PatchFilm, middle_line
from bem.friction.film_table import FilmTable
from bem.friction.setup import MixedSetup
from bem.friction.smooth import LineContact
from bem.friction.worn_film import SearchedWornFilms, ShapeChange, ShapeSolver, WornFilms, neighbours
from bem.grid import FloatArray
from bem.lubrication.line.shaped import ShapedStart
from bem.notes import Note
from bem.notes.wear import FILM_OF_OTHER_SHAPE

FILM_SHAPES = ("worn", "unworn")
"""Macroscopic shapes that the film of a wear loop may have."""
SMOOTHING = 0.25
"""Width of the Gaussian (standard deviation) that the worn depth is smoothed by, in Hertz' half-widths."""
RESOLUTION = 0.2
"""Largest change of the worn depth, relative to the film's gap, for which the films stay as they are."""
SHARE_RESOLUTION = 0.05
"""Largest change as `RESOLUTION`, times the film's share of the load, which weights the effect on the load sharing."""
RETRY = 1.5
"""Growth of the change of the worn depth before a shape without a film is tried again."""


@dataclass(frozen=True, eq=False)
class WornShape:
    """State of the worn shape in a loop, part of its checkpoint.

    unworn : (nx,) heights of the standing body before the first cycle, mean along y [m]; None before it.
    shape : (nx,) worn shape of the films [m]; None while the films are those of the unworn bodies.
    changes, starts : changes of the films and starts of further ones, by index of the lattice of loads.
    updates : number of shapes that films were solved for. solves : solutions of the film's equations, with
        continuation.
    kept : number of cycles with an earlier shape, since no film of the new one was found.
    clamped : number of cycles in which a lattice load next to the film load has no film of the shape.
    retry : change of the worn depth over the gap below which a shape without a film is not tried again.
    behind : change of the worn depth over the gap since the films' shape.
    """

    unworn: FloatArray | None = None
    shape: FloatArray | None = None
    changes: Mapping[int, ShapeChange] = field(default_factory=dict)
    starts: Mapping[int, ShapedStart] = field(default_factory=dict)
    updates: int = 0
    solves: int = 0
    kept: int = 0
    clamped: int = 0
    retry: float = 0.0
    behind: float = 0.0

    def with_groove_filled(self, heights: FloatArray) -> FloatArray:
        """Return heights (nx, ny) [m] for the rough contact: the worn depth that the film's gap has is added back."""
        return heights if self.shape is None else heights + self.shape[:, None]


@dataclass(frozen=True, eq=False)
class ShapeFollower:
    """Rule by which the films of a load sharing follow the worn shape; it keeps no state of the loop.

    solver : None where the films cannot follow: under a ball, and where a supply of oil limits the film.
    """

    setup: MixedSetup
    table: FilmTable
    solver: ShapeSolver | None

    @classmethod
    def of(cls, setup: MixedSetup, table: FilmTable) -> ShapeFollower:
        """Return the rule for a set-up and its table of unworn films."""
        return cls(setup, table, shape_solver(setup, table, table.speeds))

    def films(self, worn: WornShape) -> Film:
        """Return the films of a shape; those of the table where there is none yet."""
        if self.solver is None or worn.shape is None:
            return self.table
        return worn_films(self.solver, worn)

    def followed(self, worn: WornShape, heights: FloatArray, last: Balance | None) -> WornShape:
        """Return the state for the next cycle.

        heights : (nx,) of the standing body, mean along y [m]. last : balance of the last cycle.
        """
        if worn.unworn is None:
            return replace(worn, unworn=heights)
        if last is None:
            return worn
        depth = smoothed(worn.unworn - heights, self.setup)
        behind = self._behind(depth, worn, last.film)
        worn = replace(worn, behind=behind)
        share = last.film.load / self.setup.load
        if self.solver is None or max(behind / RESOLUTION, share * behind / SHARE_RESOLUTION) <= 1:
            return worn
        if behind < worn.retry:
            return replace(worn, kept=worn.kept + 1)
        # in boundary lubrication the film carries a negligible load: no film next to that load is needed
        mixed = last.regime is not Regime.BOUNDARY
        near = neighbours(last.film.load, self.table.largest_load) if mixed else ()
        found = {}
        for index in sorted({0, *near}):
            film = self.solver.film(index, depth, worn.starts)
            if film is None:
                return replace(worn, kept=worn.kept + 1, retry=RETRY * behind)
            found[index] = film
        return replace(
            worn,
            shape=depth,
            changes={index: film.change for index, film in found.items()},
            starts={index: film.start for index, film in found.items()},
            updates=worn.updates + 1,
            solves=worn.solves + sum(film.solves for film in found.values()),
            retry=0.0,
            behind=0.0,
        )

    def completed(self, worn: WornShape, balance: Balance) -> WornShape:
        """Return the state with the films next to the film load of a balance solved; itself where they are there, or
        the film carries nothing that counts. `clamped` rises by one where one of them is not found."""
        if self.solver is None or worn.shape is None or balance.regime is Regime.BOUNDARY:
            return worn
        missing = [
            index for index in neighbours(balance.film.load, self.table.largest_load) if index not in worn.changes
        ]
        for index in missing:
            film = self.solver.film(index, worn.shape, worn.starts)
            if film is None:
                return replace(worn, clamped=worn.clamped + 1)
            worn = replace(
                worn,
                changes={**worn.changes, index: film.change},
                starts={**worn.starts, index: film.start},
                solves=worn.solves + film.solves,
            )
        return worn

    def notes(self, worn: WornShape, cycles: int) -> tuple[Note, ...]:
        """Return the notes on the worn shape after a number of cycles."""
        if self.solver is None:
            if worn.behind <= RESOLUTION:
                return ()
            film = "the film of a ball" if self.setup.radii is not None else "a film with a limited supply of oil"
            return (FILM_OF_OTHER_SHAPE(film=film, behind=worn.behind, reason="unworn"),)
        notes = []
        if worn.shape is not None:
            end, deepest = _end_and_deepest(worn.shape)
            if end > END_SHARE * deepest:
                notes.append(FILM_OF_OTHER_SHAPE(depth=end, reason="end"))
        if worn.kept:
            notes.append(FILM_OF_OTHER_SHAPE(kept=worn.kept, cycles=cycles, behind=worn.behind, reason="earlier"))
        if worn.clamped:
            notes.append(FILM_OF_OTHER_SHAPE(clamped=worn.clamped, cycles=cycles, reason="other-load"))
        return tuple(notes)

    def _behind(self, depth: FloatArray, worn: WornShape, film: PatchFilm) -> float:
        """Return the largest change of the worn depth since the films' shape, over the gap at the same place.

        A uniform change counts as none: it moves the rigid body and leaves the film as it is.
        """
        change, gap = depth if worn.shape is None else depth - worn.shape, middle_line(film.thickness)
        uniform = float(np.average(change, weights=gap**-2))
        return float(np.max(np.abs(change - uniform) / gap))


def shape_solver(setup: MixedSetup, films: Any, speeds: tuple[float, float]) -> ShapeSolver | None:
    """Return the solver of worn films for a set-up and its unworn films; None where films keep the unworn shape."""
    contact = setup.smooth
    if not isinstance(contact, LineContact) or contact.supply is not None:
        return None
    return ShapeSolver(films, contact, speeds, setup.film_grid.x)


def worn_films(solver: ShapeSolver, worn: WornShape) -> WornFilms:
    """Return the films of a state's shape."""
    assert worn.shape is not None
    return solver.films(worn.shape, worn.changes)


def worn_as(shape: FloatArray | None, speeds: tuple[float, float], setup: MixedSetup, unworn: Film) -> Film:
    """Return the films of a set-up between bodies worn by a shape (nx,) [m], from its unworn films; these themselves
    without a shape."""
    solver = None if shape is None else shape_solver(setup, unworn, speeds)
    return unworn if solver is None or shape is None else SearchedWornFilms(solver, shape)


def smoothed(depth: FloatArray, setup: MixedSetup) -> FloatArray:
    """Return a worn depth (nx,) [m] smoothed by a Gaussian of `SMOOTHING` half-widths, at least one cell."""
    half_width, spacing = setup.smooth.half_axes(setup.load)[0], setup.grid.spacing[0]
    width = max(SMOOTHING * half_width / spacing, 1.0)
    reach = math.ceil(4 * width)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    return np.convolve(np.pad(depth, reach, mode="edge"), weights / weights.sum(), mode="valid")


def check_film_shape(film_shape: str) -> None:
    """Check the choice of the film's shape.

    Raises
    ------
    InputError : a choice that is not there.
    """
    if film_shape not in FILM_SHAPES:
        raise InputError(f"film_shape: {film_shape!r} is unknown; choose from {', '.join(FILM_SHAPES)}")


END_SHARE = 0.1
"""Worn depth at the end of the patch, relative to the deepest, from which a note says so."""


def _end_and_deepest(shape: FloatArray) -> tuple[float, float]:
    """Return the depths of a worn shape at the ends of the patch and at its deepest place [m]."""
    return max(abs(float(shape[0])), abs(float(shape[-1]))), float(np.abs(shape).max())


__all__ = [
    "FILM_SHAPES",
    "ShapeFollower",
    "WornShape",
    "check_film_shape",
    "shape_solver",
    "smoothed",
    "worn_as",
    "worn_films",
]
