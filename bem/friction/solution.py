"""The result of load sharing."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bem.contact import ContactSolution
from bem.errors import Status
from bem.friction.asperities import AsperityContact
from bem.friction.balance import BalanceStart, Regime
from bem.friction.boundary import BoundaryFrictionGiven, boundary_law, filled_part, sliding_sign
from bem.friction.film import PatchFilm, middle_line
from bem.friction.oil_sensitivity import OilVolumeSensitivity
from bem.grid import FloatArray, Grid
from bem.lubrication import FilmSolution, PointFilmSolution
from bem.notes import Note
from bem.representation import readable

if TYPE_CHECKING:
    from bem.friction.rough_contact import SpreadContact


@readable
@dataclass(frozen=True)
class MixedSolution:
    """Load and friction shared between oil film and rough contact; forces on the whole width.

    Attributes
    ----------
    speeds : (u1, u2) of flat and cylinder or ball [m/s].
    friction : coefficient, (boundary part + film part) / load, positive where it resists the sliding.
    boundary_force, film_force : the two parts [N]; without sliding the boundary part is zero.
    load, contact_load, film_load : [N].
    film : smooth film under `film_load`.
    contact : rough contact of one slice as long as the grid is wide (`SpreadContact` of a cell that
        repeats); None in full film.
    separation : (nx,) distance [m] between the mean planes of the undeformed surfaces at the grid's abscissae, as the
        rough contact sees it: film thickness less the shift that keeps the volume of oil; of a ball on y = 0.
    lambda_ratio : minimum of the smooth film under the whole load over the rms height of the patch.
    minimum_film : minimum thickness [m] of `film`.
    contact_area : real, on the whole width [m^2].
    evaluations : films solved.
    contact_solves : rough contacts solved.
    imbalance : (film_load + contact_load - load) / load, of these three.
    balance_slope : of ln(opening / film thickness) with ln(film_load): where the next speed's balance starts from.
    continuation : what else the next speed's balance starts from.
    status : converged where the imbalance is within the tolerance and film and contact are converged themselves;
        infeasible where film and surfaces cannot carry the load within their models.
    grid, boundary_friction : as given; a law where one was.
    oil_imbalance : (mean opening between the surfaces - mean thickness of the film) / the latter, where the oil is
        counted (`oil_volume`); of this film and contact, 0 at an end of the balance.
    oil : how far load share and friction hang on the oil beside Hertz' contact.
    patch_film : the film as the patch sees it; a cell that repeats, as at the contact's centre: so are pressures and
        stresses of such a cell.
    regime : "full film", "mixed" or "boundary": the end of the balance, if any, that it is at.
    contact_temperature, flash_temperature : of the surfaces in contact [K], mean by pressure and highest; None without
        heat, contact or sliding. The film's stand in `film`.
    oil_on_contact : what the film's shear stress on cells in contact would add to `friction`, in which it is not.
    notes : sentences on what is outside a model's validity, or at an end of the balance.
    """

    speeds: tuple[float, float]
    friction: float
    boundary_force: float
    film_force: float
    load: float
    contact_load: float
    film_load: float
    film: FilmSolution | PointFilmSolution
    contact: ContactSolution | AsperityContact | SpreadContact | None
    separation: FloatArray
    lambda_ratio: float
    minimum_film: float
    contact_area: float
    evaluations: int
    contact_solves: int
    imbalance: float
    balance_slope: float
    status: Status
    grid: Grid
    boundary_friction: BoundaryFrictionGiven
    oil_imbalance: float
    oil: OilVolumeSensitivity
    patch_film: PatchFilm
    regime: Regime = Regime.MIXED
    continuation: BalanceStart = field(default_factory=BalanceStart, repr=False, compare=False)
    contact_temperature: float | None = None
    flash_temperature: float | None = None
    oil_on_contact: float = 0.0
    notes: tuple[Note, ...] = ()

    @property
    def full_film(self) -> bool:
        """Whether the surfaces do not touch."""
        return self.contact is None

    @property
    def contact_pressure(self) -> FloatArray:
        """Pressure of the rough contact (nx, ny) [Pa]; zero everywhere in full film."""
        return np.zeros(self.grid.shape) if self.contact is None else self.contact.pressure

    @property
    def film_pressure(self) -> FloatArray:
        """Pressure of the oil (nx, ny) [Pa], zero on cells in contact."""
        return np.where(self.contact_pressure > 0, 0.0, self.patch_film.pressure)

    @property
    def film_along_x(self) -> tuple[FloatArray, FloatArray]:
        """Pressure [Pa] and thickness [m] of the film at the grid's abscissae (nx,); of a ball on y = 0."""
        if isinstance(self.film, FilmSolution):
            return self.film.at(self.grid.x)
        fields = (middle_line(self.patch_film.pressure), middle_line(self.patch_film.thickness))
        return np.broadcast_to(fields[0], self.grid.shape[:1]), np.broadcast_to(fields[1], self.grid.shape[:1])

    @property
    def film_section(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Abscissae [m], pressure [Pa] and thickness [m] of the film's own mesh; of a ball on y = 0."""
        if isinstance(self.film, FilmSolution):
            return self.film.position, self.film.pressure, self.film.thickness
        return self.film.x, middle_line(self.film.pressure), middle_line(self.film.thickness)

    @property
    def film_shear_stress(self) -> FloatArray:
        """Shear stress of the oil (nx, ny) [Pa], zero on cells in contact; signed like `boundary_shear_stress`."""
        return np.where(self.contact_pressure > 0, 0.0, self.patch_film.shear_stress)

    @property
    def boundary_shear_stress(self) -> FloatArray:
        """Boundary friction (nx, ny) [Pa]: what the flat takes along with it, positive where u1 > u2."""
        sign, speed = sliding_sign(self.speeds), abs(self.speeds[0] - self.speeds[1])
        if self.contact is None or (speed == 0 and not isinstance(self.boundary_friction, float)):
            return np.zeros(self.grid.shape)
        if isinstance(self.boundary_friction, float):
            return sign * self.boundary_friction * self.contact.pressure
        filled = filled_part(self.contact.pressure, self.contact.contact_area, self.grid)
        return sign * boundary_law(self.boundary_friction).cell_stress(self.contact.pressure, filled, speed)
