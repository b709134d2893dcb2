"""Films of a line contact interpolated in the load they carry: one table serves all cycles of a run at one speed."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bem.errors import InputError, Status
from bem.friction.film import PatchFilm, largest_film_load, sampled, smooth_gap, solved_line_film
from bem.friction.setup import LineContact
from bem.grid import FloatArray
from bem.lubrication import FilmSolution
from bem.lubrication.steady import check_entrainment

LOAD_STEP = 0.125
"""Step in ln(film load): cubic interpolation is then good to about 1e-4 of the film (tested)."""


class FilmTable:
    """Steady films of one line contact at one pair of speeds, over the load they carry; a `Film`.

    Parameters
    ----------
    position : (nx,) abscissae at which films are wanted [m].
    contact : the smooth contact and its oil.
    load : the largest load, on the whole width [N]; more than a film is looked for is cut to that.
    speeds : (u1, u2) of flat and cylinder [m/s].
    points : nodes of the films' own mesh.

    A film between two entries is interpolated by cubics in ln(load) through the four nearest, at abscissae in units of
    the half-width, which moves with the load that deforms the bodies. Entries are solved as far down as is asked for,
    each started from the one above: the same bits whatever is asked for first.

    Raises
    ------
    InputError : speeds that are not finite or entrain nothing.
    """

    def __init__(
        self,
        position: FloatArray,
        contact: LineContact,
        *,
        load: float,
        speeds: Sequence[float],
        points: int = 2000,
    ) -> None:
        check_entrainment(speeds)
        self.position = position
        self.contact = contact
        self.speeds = (float(speeds[0]), float(speeds[1]))
        self.points = points
        self.largest_load = min(load, largest_film_load(contact, self.speeds))
        self.errors = (0.0,)
        self.entries: list[FilmSolution] = []

    def solve(self, load: float, initial: FilmSolution | None = None) -> FilmSolution:
        """The film itself at a load [N]."""
        return solved_line_film(self.contact, self.speeds, load, self.points, initial=initial)

    def entry(self, index: int) -> FilmSolution:
        """The film at largest_load * exp(-index LOAD_STEP)."""
        while len(self.entries) <= index:
            last = self.entries[-1] if self.entries else None
            self.entries.append(self.solve(self._load(len(self.entries)), last))
        return self.entries[index]

    def under(self, load: float, level: int = 0, start: PatchFilm | None = None) -> PatchFilm:
        """The film at a load [N] up to the largest; `level` and `start` make no difference.

        Raises
        ------
        InputError : a load that is not positive, or larger than the table's.
        """
        if not 0 < load <= self.largest_load * (1 + 1e-12):
            raise InputError(f"load: {load!r} N must lie between 0 and the table's {self.largest_load:g} N")
        place = max(math.log(self.largest_load / load) / LOAD_STEP, 0.0)
        if place < 1e-9:
            return self._sampled(0, self.position)
        first = max(math.floor(place) - 1, 0)
        weights = [math.prod((place - first - j) / (k - j) for j in range(4) if j != k) for k in range(4)]
        # half-widths of entry and load: the abscissa that corresponds
        moves = 0.0 if self.contact.deforming_load is not None else 0.5 * LOAD_STEP
        stretch = [math.exp(moves * (place - first - k)) for k in range(4)]
        films = [self._sampled(first + k, self.position * stretch[k]) for k in range(4)]

        def mean(values: list[FloatArray]) -> FloatArray:
            return sum((w * v for w, v in zip(weights, values, strict=True)), np.zeros_like(values[0]))

        failed = [film.status for film in films if film.status is not Status.CONVERGED]
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
            smooth_gap=smooth_gap(thickness, self.position[:, None], load, self.contact),
        )

    def error(self, load: float) -> float:
        """Largest difference between the interpolated thickness and that of the film solved at this very load [N],
        relative to the latter. One film solve."""
        nearest = self.entry(max(round(math.log(self.largest_load / load) / LOAD_STEP), 0))
        solved = sampled(self.solve(load, nearest), self.position, load, self.contact)
        return float(np.max(np.abs(self.under(load).thickness / solved.thickness - 1)))

    def _load(self, index: int) -> float:
        return self.largest_load * math.exp(-LOAD_STEP * index)

    def _sampled(self, index: int, position: FloatArray) -> PatchFilm:
        return sampled(self.entry(index), position, self._load(index), self.contact)
