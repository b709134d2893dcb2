"""Film model of a table: films of a smooth contact interpolated in load, for all cycles of a run at one speed."""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np

from bem.errors import InputError, Status
from bem.friction.film import PatchFilm, smooth_gap
from bem.friction.smooth import SmoothContact
from bem.grid import FloatArray


class TabulatedFilms(Protocol):
    """Films of one contact at one pair of speeds that a table can be built from.

    Profiles are nearly self-similar in x / a (a: Hertz half-width), so they are interpolated in load.
    """

    @property
    def contact(self) -> SmoothContact:
        """The smooth contact and its oil."""

    @property
    def speeds(self) -> tuple[float, float]:
        """(u1, u2) of flat and cylinder or ball [m/s]."""

    @property
    def largest_load(self) -> float:
        """Load [N] up to which there are films."""

    @property
    def step(self) -> float:
        """Spacing of the entries in ln(film load); cubic interpolation is then well within the error of the films."""

    @property
    def growth(self) -> float:
        """Power of the load with which the Hertz half-width grows."""

    @property
    def continued(self) -> bool:
        """Return True if films start from one another, so that their rounding depends on the start."""

    @property
    def parabola(self) -> FloatArray:
        """Undeformed gap on the patch [m]."""

    def solve(self, load: float, initial: Any) -> Any:
        """Solve the film under a load [N] from a neighbour."""

    def sampled(self, film: Any, load: float, stretch: float) -> PatchFilm:
        """Sample a solved film at the patch's abscissae times `stretch`."""


class FilmTable:
    """Table of steady films of one contact at one pair of speeds over the load that they carry; a `Film`.

    Parameters
    ----------
    films : films that are tabulated.
    load : largest load on the whole contact [N]; it is cut to the largest load of the films.

    Notes
    -----
    A film between two entries is interpolated by a cubic in ln(load) through the four nearest entries, at abscissae in
    units of the Hertz half-width, which changes with the load that deforms the bodies. Entries are solved on request,
    each started from the entry above where films start from one another. The result does not depend on the order of
    requests.
    """

    def __init__(self, films: TabulatedFilms, *, load: float) -> None:
        self.films = films
        self.contact = films.contact
        self.speeds = films.speeds
        self.largest_load = min(load, films.largest_load)
        self.level_errors = (0.0,)
        self.entries: dict[int, Any] = {}

    def entry(self, index: int) -> Any:
        """Return the film under the load largest_load exp(-index films.step)."""
        missing = range(len(self.entries), index + 1) if self.films.continued else (index,)
        for at in missing:
            if at not in self.entries:
                self.entries[at] = self.films.solve(self._load(at), self.entries.get(at - 1))
        return self.entries[index]

    def solved(self, load: float) -> Any:
        """Return the film that is solved for a load [N]: the entry at this load, or a film of its own between two."""
        index = round(math.log(self.largest_load / load) / self.films.step)
        entry = self.entry(max(index, 0))
        return entry if abs(math.log(self._load(index) / load)) < 1e-9 else self.films.solve(load, entry)

    def under(self, load: float, level: int = 0, start: PatchFilm | None = None) -> PatchFilm:
        """Interpolate the film under a load [N] up to the largest; `level` and `start` have no effect.

        Raises
        ------
        InputError : a load that is not positive, or larger than the table's.
        """
        if not 0 < load <= self.largest_load * (1 + 1e-12):
            raise InputError(f"load: {load:.6g} N must lie between 0 and the table's {self.largest_load:.6g} N")
        place = max(math.log(self.largest_load / load) / self.films.step, 0.0)
        if place < 1e-9:
            return self._sampled(0)
        first = max(math.floor(place) - 1, 0)
        weights = [math.prod((place - first - j) / (k - j) for j in range(4) if j != k) for k in range(4)]
        # Hertz' contacts of entry and load: the abscissae that correspond
        moves = 0.0 if self.contact.deforming_load is not None else self.films.growth * self.films.step
        stretch = [math.exp(moves * (place - first - k)) for k in range(4)]
        films = [self._sampled(first + k, stretch[k]) for k in range(4)]

        def mean(values: list[FloatArray]) -> FloatArray:
            return sum((w * v for w, v in zip(weights, values, strict=True)), np.zeros_like(values[0]))

        failed = [film.status for film in films if film.status is not Status.CONVERGED]
        sliding = [film.sliding_stress for film in films if film.sliding_stress is not None]
        thickness = np.exp(mean([np.log(film.thickness) for film in films]))
        return PatchFilm(
            load=load,
            thickness=thickness,
            pressure=np.maximum(mean([film.pressure for film in films]), 0.0),
            shear_stress=mean([film.shear_stress for film in films]),
            shear_force=sum(w * film.shear_force for w, film in zip(weights, films, strict=True)),
            minimum_thickness=math.exp(
                sum(w * math.log(film.minimum_thickness) for w, film in zip(weights, films, strict=True))
            ),
            status=failed[0] if failed else Status.CONVERGED,
            notes=films[1].notes,
            plateau=None
            if films[0].plateau is None
            else math.exp(sum(w * math.log(film.carrying_thickness) for w, film in zip(weights, films, strict=True))),
            smooth_gap=smooth_gap(thickness, self.films.parabola, load, self.contact),
            sliding_stress=None if len(sliding) < len(films) else mean(sliding),
        )

    def nearest(self, load: float) -> Any:
        """Return the solved film whose load is nearest to a load [N]."""
        return self.entry(max(round(math.log(self.largest_load / load) / self.films.step), 0))

    def error(self, load: float) -> float:
        """Return the largest relative error of the interpolated thickness under a load [N]. Cost: one film."""
        nearest = self.nearest(load)
        solved = self.films.sampled(self.films.solve(load, nearest), load, 1.0)
        return float(np.max(np.abs(self.under(load).thickness / solved.thickness - 1)))

    def _load(self, index: int) -> float:
        return self.largest_load * math.exp(-self.films.step * index)

    def _sampled(self, index: int, stretch: float = 1.0) -> PatchFilm:
        return self.films.sampled(self.entry(index), self._load(index), stretch)
