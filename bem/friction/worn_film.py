"""Film model of a line contact between worn bodies: films of the unworn cylinder, corrected for the worn shape.

The shape w(x) is the worn depth of the body that stands with the contact, a smooth profile along x. Films with and
without it are solved on one fixed mesh (`bem.lubrication.line.shaped`) at a few loads of a lattice in ln(load). Their
ratio multiplies the thickness of the unworn film, their differences add to pressure, shear stress and friction force.
Load sharing takes thickness and friction force. Film pressure only weights the volume of oil
(`bem.friction.oil_volume`) and is a result; shear stress counts where cells in contact displace the film and in the
heat of the contact.
Between two loads of the lattice ratio and differences are linear in ln(load); beyond them they stay those of the
nearest, so that there is a film under any load. Without a change the films are the unworn ones to the last bit.
Verified in tests/friction/test_worn_film.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from bem.errors import Status
from bem.friction.film import Film, PatchFilm, smooth_gap
from bem.friction.smooth import LineContact
from bem.grid import FloatArray
from bem.lubrication import FilmSolution
from bem.lubrication.line.case import LineCase, load_range
from bem.lubrication.line.shaped import ShapedContact, ShapedOutcome, ShapedStart
from bem.numerics.monotone import MonotoneCubic

LATTICE_STEP = 0.125
"""Distance of the loads of the lattice in ln(load): linear interpolation of the ratio is good to about 1e-3 of it."""


class UnwornFilms(Film, Protocol):
    """Films of the unworn contact, with those that were solved at the loads of the lattice."""

    def solved(self, load: float) -> FilmSolution:
        """Return the solved film at a load of the lattice [N]."""


@dataclass(frozen=True, eq=False)
class ShapeChange:
    """Change of the film under one load by the worn shape; arrays (nx, 1) on the patch.

    thickness, minimum_thickness : natural logarithm of the ratio of worn to unworn film. pressure, shear_stress :
    worn less unworn [Pa]. shear_force : of the whole contact, worn less unworn [N].
    """

    thickness: FloatArray
    minimum_thickness: float
    pressure: FloatArray
    shear_stress: FloatArray
    shear_force: float

    def between(self, other: ShapeChange, weight: float) -> ShapeChange:
        """Return (1 - weight) of this change and weight of another."""
        own = 1 - weight
        return ShapeChange(
            thickness=own * self.thickness + weight * other.thickness,
            minimum_thickness=own * self.minimum_thickness + weight * other.minimum_thickness,
            pressure=own * self.pressure + weight * other.pressure,
            shear_stress=own * self.shear_stress + weight * other.shear_stress,
            shear_force=own * self.shear_force + weight * other.shear_force,
        )


@dataclass(frozen=True, eq=False)
class WornFilms:
    """Films over the load they carry, changed by a worn shape; a `Film`.

    unworn : films of the unworn contact. shape : (nx,) worn depth [m]. changes : by index of the lattice.
    """

    unworn: UnwornFilms
    contact: LineContact
    parabola: FloatArray
    shape: FloatArray
    changes: Mapping[int, ShapeChange]

    @property
    def largest_load(self) -> float:
        """Load [N] up to which there are films; see `Film`."""
        return self.unworn.largest_load

    @property
    def level_errors(self) -> tuple[float, ...]:
        """Errors of the films; see `Film`."""
        return self.unworn.level_errors

    def under(self, load: float, level: int = 0, start: PatchFilm | None = None) -> PatchFilm:
        """Return the film under a load; see `Film`."""
        film = self.unworn.under(load, level, start)
        if not self.changes:
            return film
        change = self._change(lattice_place(load, self.largest_load))
        thickness = film.thickness * np.exp(change.thickness)
        return replace(
            film,
            thickness=thickness,
            pressure=np.maximum(film.pressure + change.pressure, 0.0),
            shear_stress=film.shear_stress + change.shear_stress,
            sliding_stress=None,
            shear_force=film.shear_force + change.shear_force,
            minimum_thickness=film.minimum_thickness * math.exp(change.minimum_thickness),
            smooth_gap=smooth_gap(thickness, self.parabola + self.shape[:, None], load, self.contact),
        )

    def _change(self, place: float) -> ShapeChange:
        known = sorted(self.changes)
        above = int(np.searchsorted(known, place))
        if above == 0 or above == len(known):
            return self.changes[known[min(above, len(known) - 1)]]
        low, high = known[above - 1], known[above]
        return self.changes[low].between(self.changes[high], (place - low) / (high - low))


def lattice_place(load: float, largest: float) -> float:
    """Return the place of a load [N] on the lattice that begins at the largest load."""
    return max(math.log(largest / load) / LATTICE_STEP, 0.0)


def neighbours(load: float, largest: float) -> tuple[int, ...]:
    """Return the indices of the lattice on both sides of a load [N]; one if it lies on the lattice."""
    place = lattice_place(load, largest)
    low = math.floor(place + 1e-9)
    return (low,) if abs(place - low) < 1e-9 else (low, low + 1)


@dataclass(frozen=True, eq=False)
class ShapedFilm:
    """Change of the film at one load of the lattice, with its warm start for others and the number of solves."""

    change: ShapeChange
    start: ShapedStart
    solves: int


@dataclass(frozen=True, eq=False)
class ShapeSolver:
    """Films with and without a worn shape at the loads of the lattice.

    unworn : films of the unworn contact. contact, speeds, position : as of `SolvedLineFilm`.
    """

    unworn: UnwornFilms
    contact: LineContact
    speeds: tuple[float, float]
    position: FloatArray
    _known: dict[int, tuple[ShapedContact, ShapedOutcome] | None] = field(default_factory=dict)

    def films(self, shape: FloatArray, changes: Mapping[int, ShapeChange]) -> WornFilms:
        """Return the films of a shape (nx,) [m] by their changes."""
        parabola = self.contact.parabola(self.position, self.position[:0])
        return WornFilms(self.unworn, self.contact, parabola, shape, changes)

    def load(self, index: int) -> float:
        """Return a load of the lattice [N]."""
        return self.unworn.largest_load * math.exp(-LATTICE_STEP * index)

    def film(self, index: int, shape: FloatArray, starts: Mapping[int, ShapedStart]) -> ShapedFilm | None:
        """Return the film at an index under a shape (nx,) [m]; None where no film is found.

        starts : films of the same contact by index, of this shape or one near it. The start is the film at the same
        index, else the film of the nearest index, at last the film without a shape.
        """
        unworn = self._unworn(index)
        if unworn is None:
            return None
        shaped, without = unworn
        profile, found = extended(shape, self.position, shaped.position), None
        for start in self._starts(index, starts):
            found = shaped.solve(profile, start)
            if found is not None:
                break
        if found is None:
            return None
        (thin, pressure, stress), (thin0, pressure0, stress0) = (self._sampled(one.film) for one in (found, without))
        lower, lower0 = found.film.minimum_thickness, without.film.minimum_thickness
        change = ShapeChange(
            np.log(thin / thin0)[:, None],
            math.log(lower / lower0),
            (pressure - pressure0)[:, None],
            (stress - stress0)[:, None],
            (found.film.shear_force - without.film.shear_force) * self.contact.width,
        )
        return ShapedFilm(change, found.start, found.solves)

    def _starts(self, index: int, starts: Mapping[int, ShapedStart]) -> Iterator[ShapedStart]:
        own, without = self._known[index] or (None, None)
        assert own is not None
        assert without is not None
        if index in starts:
            yield starts[index]
        elif starts:
            near = min(starts, key=lambda other: (abs(other - index), other))
            other = self._unworn(near)
            if other is not None:
                yield own.start_from(other[0], starts[near])
        yield without.start

    def _unworn(self, index: int) -> tuple[ShapedContact, ShapedOutcome] | None:
        """Return the contact at an index with its film without a shape; None where that is not found."""
        if index not in self._known:
            self._known[index] = self._solved_unworn(self.load(index))
        return self._known[index]

    def _solved_unworn(self, load: float) -> tuple[ShapedContact, ShapedOutcome] | None:
        contact = self.contact
        modulus = contact.film_modulus(load)
        lowest, _ = load_range(contact.radius, modulus, self.speeds, contact.lubricant)
        case = LineCase(
            load=load / contact.width,
            radius=contact.radius,
            contact_modulus=math.inf if load / contact.width < lowest else modulus,
            speeds=self.speeds,
            lubricant=contact.lubricant,
        )
        shaped = ShapedContact.of(case, self.unworn.solved(load), float(np.abs(self.position).max()))
        outcome = shaped.solve(np.zeros_like(shaped.position), shaped.unworn)
        return None if outcome is None else (shaped, outcome)

    def _sampled(self, film: FilmSolution) -> tuple[FloatArray, FloatArray, FloatArray]:
        pressure, thickness = film.at(self.position)
        return thickness, pressure, film.shear_stress(self.position)


@dataclass(frozen=True, eq=False)
class SearchedWornFilms:
    """Films of one worn shape (nx,) [m], solved when they are requested; a `Film`.

    Where no film of the worn shape is found, the film of the unworn contact is returned with the status `stalled`.
    """

    solver: ShapeSolver
    shape: FloatArray
    _found: dict[int, ShapedFilm] = field(default_factory=dict)

    @property
    def largest_load(self) -> float:
        """Load [N] up to which there are films; see `Film`."""
        return self.solver.unworn.largest_load

    @property
    def level_errors(self) -> tuple[float, ...]:
        """Errors of the films; see `Film`."""
        return self.solver.unworn.level_errors

    def under(self, load: float, level: int = 0, start: PatchFilm | None = None) -> PatchFilm:
        """Return the film under a load; see `Film`."""
        for index in neighbours(load, self.largest_load):
            if index in self._found:
                continue
            starts = {known: film.start for known, film in self._found.items()}
            film = self.solver.film(index, self.shape, starts)
            if film is None:
                return replace(self.solver.unworn.under(load, level, start), status=Status.STALLED)
            self._found[index] = film
        changes = {index: film.change for index, film in self._found.items()}
        return self.solver.films(self.shape, changes).under(load, level, start)


def extended(shape: FloatArray, position: FloatArray, at: FloatArray) -> FloatArray:
    """Return a shape (nx,) [m] at abscissae [m]: cubics on the patch, beyond it the value at the patch's end."""
    return MonotoneCubic(position, shape)(np.clip(at, position[0], position[-1]))
