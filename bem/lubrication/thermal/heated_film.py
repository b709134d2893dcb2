"""What films with heat have in common, whichever model found their temperatures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.film import FilmSolution


@dataclass(frozen=True)
class HeatedFilm:
    """A film, that without heat, and the middles (m,) and widths (m,) of the cells along it that have temperatures
    [m]. `film_temperature` : (m,) mean across the film [K], of the model."""

    film: FilmSolution
    isothermal: FilmSolution
    position: FloatArray
    width: FloatArray

    if TYPE_CHECKING:  # one model keeps it, the other averages its field

        @property
        def film_temperature(self) -> FloatArray:
            """Mean across the film (m,) [K]."""

    @property
    def minimum_thickness(self) -> float:
        """Of the film [m]."""
        return self.film.minimum_thickness

    @property
    def central_thickness(self) -> float:
        """Of the film [m]."""
        return self.film.central_thickness

    @property
    def mean_film_temperature(self) -> float:
        """Mean along the film by pressure [K], that of the contact."""
        weights = np.interp(self.position, self.film.position, self.film.pressure) * self.width
        return float((weights * self.film_temperature).sum() / weights.sum())

    @property
    def highest_film_temperature(self) -> float:
        """Mean across the film, where it is highest [K]."""
        return float(self.film_temperature.max())
