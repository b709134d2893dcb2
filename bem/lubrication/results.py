"""Result of a line-contact film: pressure, thickness, forces, and shear stress derived from them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear_profile import middle_stress
from bem.lubrication.supply import Starvation
from bem.notes import Note
from bem.numerics.monotone import MonotoneCubic
from bem.representation import readable


class SampledState(Protocol):
    """State that a solver leaves in a result, for resampling and warm starts."""

    def sample(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return pressure [Pa] and thickness [m] at any positions [m]."""


@readable
@dataclass(frozen=True)
class FilmSolution:
    """Film of a line contact: a cylinder (surface 2, above) on a flat (surface 1, below), per unit length.

    Attributes
    ----------
    position : (n,) abscissae, ascending [m]; x = 0 is below the cylinder's axis.
    pressure : (n,) [Pa]; zero in the cavitated exit.
    thickness : (n,) [m].
    minimum_thickness : [m].
    central_thickness : thickness at x = 0 [m].
    load : of the pressure per unit length [N/m] (the flooded inlet upstream of the mesh included).
    shear_force : friction force per unit length [N/m], integral of `shear_stress` over the full film: on the cylinder
        along +x and, by equilibrium, on the flat along -x. Its sliding part has the sign of u1 - u2. Its rolling part,
        integral h/2 dp/dx = -1/(2R) integral p x, has the sign of u1 + u2 and is the larger part near pure rolling, in
        rigid films far beyond. The full film ends where the pressure does (Swift-Stieber exit); oil streamers behind
        it are left out.
    rolling_force : its rolling part [N/m], upstream of the positions included, with the sign of u1 + u2.
    exit_position : where the film ruptures [m].
    inlet_load_fraction : share of the load that lies upstream of the first position.
    iterations : Newton steps in total, continuation and chord steps included.
    residual : largest residual of the equations, relative to the local film.
    status : outcome.
    speeds : as given.
    lubricant : as given; of a film with lumped heat the oil that inlet heating thinned.
    time : [s]; None for a steady film.
    film_fraction : (n,) share of the gap that is filled with oil; 1 in the full film. None with Swift and Stieber's
        cavitation.
    volume_imbalance : relative error of the volume balance of a time step; None for a steady film.
    mean_temperature : of the oil [K], mean across the film, weighted by pressure; None without heat.
    maximum_temperature : of the oil [K], with lumped heat of the mean across the film; None without heat.
    sliding_stress : (n,) in the middle of the film at the temperatures of the oil [Pa]; None without heat.
    starvation : effect of a supply of oil on a steady film; None without a supply: flooded.
    heat : film with its heat, a `ThermalFilm` or a `FullThermalFilm`; None without heat.
    state : discrete solution, for resampling and as a start of similar films; None in time.
    notes : on the validity of the model (`bem.lubrication.checks`).
    """

    position: FloatArray
    pressure: FloatArray
    thickness: FloatArray
    minimum_thickness: float
    central_thickness: float
    load: float
    shear_force: float
    rolling_force: float
    exit_position: float
    inlet_load_fraction: float
    iterations: int
    residual: float
    status: Status
    speeds: tuple[float, float]
    lubricant: Lubricant
    time: float | None = None
    volume_imbalance: float | None = None
    film_fraction: FloatArray | None = None
    notes: tuple[Note, ...] = ()
    starvation: Starvation | None = None
    mean_temperature: float | None = None
    maximum_temperature: float | None = None
    sliding_stress: FloatArray | None = None
    heat: HeatedFilm | None = field(default=None, repr=False, compare=False)
    state: SampledState | None = field(default=None, repr=False, compare=False)

    def shear_stress(self, position: FloatArray | None = None) -> FloatArray:
        """Return the shear stress tau + (h/2) dp/dx on the flat in the full film [Pa], zero in the cavitated exit.

        tau is the stress in the middle of the film: the shear law at mu (u1 - u2)/h, or the stress of the whole profile
        where the oil's `film_rheology` is "shear_law"; with heat it is that at the temperatures of the oil. The second
        part follows from equilibrium across the film whatever the shear law, so it has no limit: next to a wall the
        stress of an oil with "newtonian" film may exceed the limit of tau by it. The stress acts along -x.

        position : [m], at which to interpolate linearly; the positions of the solution by default.
        """
        difference = self.speeds[0] - self.speeds[1]
        full = self.pressure > 0
        gradient = np.gradient(self.pressure, self.position)
        if self.sliding_stress is not None:
            sliding = self.sliding_stress
        else:
            positive = np.maximum(self.pressure, 0.0)
            newtonian = self.lubricant.viscosity_at(positive) * difference / self.thickness
            sliding = middle_stress(self.lubricant, newtonian, positive, self.thickness, gradient)
        stress = np.where(full, sliding + 0.5 * self.thickness * gradient, 0.0)
        return stress if position is None else np.interp(position, self.position, stress, left=0.0, right=0.0)

    def at(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return pressure [Pa] and thickness [m] at positions [m]: anywhere for a steady film, else within its mesh.

        Raises
        ------
        InputError : positions outside the mesh of a transient film.
        """
        position = np.asarray(position, dtype=np.float64)
        if self.state is not None:
            pressure, thickness = self.state.sample(position)
            return pressure, thickness
        low, high = self.position[0], self.position[-1]
        if position.size and (position.min() < low or position.max() > high):
            raise InputError(
                f"position: {position.min():g} to {position.max():g} m reaches beyond the film's {low:g} to {high:g} m"
            )
        return (
            np.interp(position, self.position, self.pressure),
            MonotoneCubic(self.position, self.thickness)(position),
        )


@dataclass(frozen=True)
class HeatedFilm:
    """A film with the heat that is generated in it; what lumped and full heat have in common.

    Places and heat are along +x, on m cells along the film. Where `status` is not `converged`, all temperatures, heat
    flows, stresses and friction are NaN.

    Attributes
    ----------
    film : solution of the film, with the isothermal friction of its oil.
    isothermal : film without heat; of lumped heat a coarse one.
    position : (m,) centres of the cells [m].
    width : (m,) of the cells [m].
    surface_temperatures : (2, m) of flat and cylinder [K].
    sliding_stress : in the middle of the film [Pa], signed like the force.
    heat_made : (m,) generated in the film [W/m^2].
    heat_into : (2, m) into flat and cylinder [W/m^2].
    shear_force : as of `FilmSolution`, at these temperatures [N/m].
    sliding_force : its part from sliding [N/m].
    friction_power, power_into, power_carried : per unit length [W/m]: of the friction; (2,) into flat and cylinder;
        carried out by the oil.
    energy_imbalance : friction power that is not found in bodies and oil, relative.
    iterations : Newton steps of all films.
    status : of film and temperatures.
    notes : on the validity of the model.
    """

    film: FilmSolution
    isothermal: FilmSolution
    position: FloatArray
    width: FloatArray
    surface_temperatures: FloatArray
    sliding_stress: FloatArray
    heat_made: FloatArray
    heat_into: FloatArray
    shear_force: float
    sliding_force: float
    friction_power: float
    power_into: tuple[float, float]
    power_carried: float
    energy_imbalance: float
    iterations: int
    status: Status
    notes: tuple[Note, ...]

    if TYPE_CHECKING:  # a field of lumped heat, a mean over the layers of full heat

        @property
        def film_temperature(self) -> FloatArray:
            """Mean temperature across the film (m,) [K]."""

    @property
    def minimum_thickness(self) -> float:
        """Minimum thickness of the film [m]."""
        return self.film.minimum_thickness

    @property
    def central_thickness(self) -> float:
        """Central thickness of the film [m]."""
        return self.film.central_thickness

    @property
    def mean_film_temperature(self) -> float:
        """Mean temperature of the oil in the contact [K], weighted by pressure."""
        weights = np.interp(self.position, self.film.position, self.film.pressure) * self.width
        return float((weights * self.film_temperature).sum() / weights.sum())

    @property
    def highest_film_temperature(self) -> float:
        """Highest mean temperature across the film [K]."""
        return float(self.film_temperature.max())

    @property
    def highest_oil_temperature(self) -> float:
        """Highest temperature of the oil that the model resolves [K]."""
        return self.highest_film_temperature

    @property
    def stress_at_nodes(self) -> FloatArray:
        """`sliding_stress` at the positions of the film (n,) [Pa]."""
        return np.interp(self.film.position, self.position, self.sliding_stress)

    def as_film(self) -> FilmSolution:
        """Return the film with its friction and temperatures, as `solve_line_film` does."""
        return replace(
            self.film,
            shear_force=self.shear_force,
            sliding_stress=self.stress_at_nodes,
            mean_temperature=self.mean_film_temperature,
            maximum_temperature=self.highest_oil_temperature,
            iterations=self.iterations,
            status=self.status,
            notes=self.notes,
            heat=self,
        )
