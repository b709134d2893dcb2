"""Result of load sharing at one speed, as users see it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bem.contact import ContactSolution
from bem.errors import Status
from bem.friction.balance import Continuation, Regime
from bem.friction.boundary import BoundaryFrictionGiven, boundary_law, filled_part, sliding_sign
from bem.friction.film import PatchFilm, middle_line
from bem.friction.oil_sensitivity import OilVolumeSensitivity
from bem.grid import FloatArray, Grid
from bem.lubrication import FilmSolution
from bem.notes import Note
from bem.representation import readable

if TYPE_CHECKING:
    from bem.friction.asperities import AsperityContact
    from bem.friction.rough_contact import SpreadContact
    from bem.lubrication import PointFilmSolution


@readable
@dataclass(frozen=True)
class MixedSolution:
    """Load and friction shared between film and rough contact; forces on the whole width.

    Attributes
    ----------
    speeds : (u1, u2) of flat and cylinder or ball [m/s].
    friction : coefficient, (boundary part + film part) / load, positive where it resists the sliding.
    boundary_force, film_force : parts of the friction force [N]; without sliding the boundary part is zero.
    load, contact_load, film_load : [N]; the last is that under which the film was solved.
    film : smooth film under `film_load`.
    contact : rough contact of one slice as long as the grid is wide (`SpreadContact` of a repeated cell); None in full
        film.
    separation : (nx,) distance [m] between the mean planes, deformed by film pressure alone, at the grid's abscissae:
        gap of the smooth bodies under film pressure (`PatchFilm.gap`) less the approach that keeps the volume of oil;
        of a ball on y = 0. In full film the film thickness, without the shift at which rough surfaces hold that oil.
    lambda_ratio : minimum of the smooth film under the whole load over the rms height of the patch. Of a cylinder whose
        film on the coarse mesh does not clear the roughness it is that film; where the film model ends below the load,
        it is the film under the largest load of the model.
    minimum_film : minimum thickness [m] of `film`.
    contact_area : real contact area on the whole width [m^2].
    evaluations : number of films solved: those of the balance and those under the whole load. A film with heat counts
        as one; films of the second balance (`oil`) do not count.
    contact_solves : number of rough contacts solved.
    imbalance : (film_load + contact_load - load) / load, of these three.
    balance_slope : slope of ln(opening / film thickness) over ln(film_load), a warm start of the next speed.
    continuation : other parts of the next speed's warm start; its film load, slope and pressure are those of this
        solution.
    status : converged where the imbalance of the load is within the tolerance, that of the oil is within the tolerance
        or within the error of the opening that the tightest contact leaves (contact tolerance times the standard
        deviation of the gap), and film, contact and heat conduction are converged themselves. At an end of the balance
        the oil is not tested. With heat the film's temperatures must balance its heat as well; the thickness that
        inlet heating leaves is then known to 5e-3 of a line (`ThermalFilm.inlet_missed`), which no imbalance shows.
        Infeasible where film and surfaces cannot carry the load within their models.
    grid : as given.
    boundary_friction : as given; a law over temperature has the temperature of the contact.
    oil_imbalance : (mean opening - mean film thickness) / mean film thickness where oil is counted (`oil_volume`), of
        this film and contact; not evaluated at an end of the balance, where it is set to 0.
    oil : sensitivity of contact share and friction to the area where oil is counted.
    patch_film : film as the patch sees it. Film, pressures and stresses of a repeated cell are those at the centre of
        the contact.
    regime : "full film", "mixed" or "boundary".
    contact_temperature, flash_temperature : of the surfaces in contact [K], mean weighted by pressure, and maximum;
        None without heat, contact or sliding. Temperatures of the film are in `film`.
    oil_on_contact : friction that the film's shear stress on the part of cells in contact would add; `friction` is
        without it.
    notes : on unusual arguments, on the oil, on the validity of the models and on the end of the balance.
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
    continuation: Continuation = field(default_factory=Continuation, repr=False, compare=False)
    contact_temperature: float | None = None
    flash_temperature: float | None = None
    oil_on_contact: float = 0.0
    notes: tuple[Note, ...] = ()

    @property
    def full_film(self) -> bool:
        """Return True if the surfaces do not touch."""
        return self.contact is None

    @property
    def contact_pressure(self) -> FloatArray:
        """Pressure of the rough contact (nx, ny) [Pa]; zero everywhere in full film."""
        return np.zeros(self.grid.shape) if self.contact is None else self.contact.pressure

    @property
    def film_pressure(self) -> FloatArray:
        """Pressure of the oil (nx, ny) [Pa], zero on cells in contact.

        Its sum is not `film_load`, which is that of the smooth film.
        """
        return np.where(self.contact_pressure > 0, 0.0, self.patch_film.pressure)

    @property
    def film_along_x(self) -> tuple[FloatArray, FloatArray]:
        """Film pressure [Pa] and film thickness [m] at the grid's abscissae (nx,); of a ball on y = 0."""
        if isinstance(self.film, FilmSolution):
            return self.film.at(self.grid.x)
        fields = (middle_line(self.patch_film.pressure), middle_line(self.patch_film.thickness))
        return np.broadcast_to(fields[0], self.grid.shape[:1]), np.broadcast_to(fields[1], self.grid.shape[:1])

    @property
    def film_section(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Abscissae [m], film pressure [Pa] and film thickness [m] on the film's mesh; of a ball on y = 0."""
        if isinstance(self.film, FilmSolution):
            return self.film.position, self.film.pressure, self.film.thickness
        return self.film.x, middle_line(self.film.pressure), middle_line(self.film.thickness)

    @property
    def film_shear_stress(self) -> FloatArray:
        """Shear stress of the oil (nx, ny) [Pa], zero on cells in contact; signed like `boundary_shear_stress`.

        Its sum is not `film_force`, to which cells in contact add by the fraction of them that does not touch.
        """
        return np.where(self.contact_pressure > 0, 0.0, self.patch_film.shear_stress)

    @property
    def boundary_shear_stress(self) -> FloatArray:
        """Boundary shear stress (nx, ny) [Pa], positive where u1 > u2: the flat drags the other surface along.

        Zero without sliding, as `boundary_force` is.
        """
        sign, speed = sliding_sign(self.speeds), abs(self.speeds[0] - self.speeds[1])
        if self.contact is None or speed == 0:
            return np.zeros(self.grid.shape)
        if isinstance(self.boundary_friction, float):
            return sign * self.boundary_friction * self.contact.pressure
        filled = filled_part(self.contact.pressure, self.contact.contact_area, self.grid)
        return sign * boundary_law(self.boundary_friction).cell_stress(self.contact.pressure, filled, speed)
