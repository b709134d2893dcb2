"""Derivatives of a mixed point with respect to its inputs, from the equation of its balance.

With x the log odds of the film load, k an input, m(x, k) the volume mismatch (`bem.friction.balance`) and f(x, k) a
figure, the balance m = 0 gives

    df/dk = f_k - f_x m_k / m_x.

The partial derivatives are central differences of one film and one rough contact at a given share of the load, so that
no balance is searched: two trials for each input, two for the share x, which all inputs have in common, and one in the
middle, from which the others start. A balance takes three to eight trials. In full film and in boundary lubrication the
share of the load stays and only f_k counts. All models of film, contact and friction are differentiated as they are,
heat and starvation too: there is no one linear system of a mixed point from which these derivatives could be had, since
films with heat and films of a ball are not solved by one Newton iteration.

Where the contact changes its cells between both trials, the derivative is the mean slope over the step; so it is where
the opening jumps. Films without heat are accurate enough for steps of `STEP`; with heat films are known to some
thousandths only, and steps are `STEP_WITH_HEAT`.

Verified in tests/friction/test_friction_sensitivity.py against differences of balances solved anew.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from bem.errors import ConvergenceError
from bem.friction.balance import LEAST_REST, Regime
from bem.friction.film import PatchFilm
from bem.friction.forces import friction_forces
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import films_of
from bem.friction.rough_contact import Pressed
from bem.friction.setup import MixedSetup
from bem.friction.solution import MixedSolution
from bem.grid import FloatArray
from bem.materials import Body, Layer, Material, contact_modulus

STEP, STEP_WITH_HEAT = 3e-4, 2e-2
"""Relative steps of inputs, and steps of the log odds. With 3e-4 truncation and noise are below 1e-5; steps of 1e-3
cross more loads at which a cell comes into contact, where the slope of the opening jumps, and err by up to 1e-4."""

_CONTACT = 1e-9
"""Tolerance of the contacts of trials: the opening's error is then below 1e-5 of its change in a step."""


@dataclass(frozen=True, eq=False)
class PointInputs:
    """Inputs of a mixed point: set-up, heights (nx, ny) of both surfaces together [m], and speeds (u1, u2) [m/s]."""

    setup: MixedSetup
    height: FloatArray
    speeds: tuple[float, float]


@dataclass(frozen=True)
class PointDerivatives:
    """Derivatives of the figures of a mixed point, per unit of one input.

    friction, boundary_part, film_part : coefficient and its parts. contact_load, film_load : [N]. minimum_film : [m].
    lambda_ratio, contact_area_fraction : ratios.
    """

    friction: float
    boundary_part: float
    film_part: float
    contact_load: float
    film_load: float
    minimum_film: float
    lambda_ratio: float
    contact_area_fraction: float


FIGURES = tuple(field.name for field in fields(PointDerivatives))
"""Names of the figures."""


@dataclass(frozen=True)
class FrictionSensitivities:
    """Derivatives of the figures of a mixed point with respect to its inputs.

    Attributes
    ----------
    load : per newton.
    height : per relative change of the roughness.
    modulus : per pascal of the contact modulus E* of the bodies' substrates; all layers change alike.
    hardness : per pascal of the hardness; None of elastic surfaces.
    viscosity : per pascal second of the oil's viscosity; its other constants stay.
    """

    load: PointDerivatives
    height: PointDerivatives
    modulus: PointDerivatives
    hardness: PointDerivatives | None
    viscosity: PointDerivatives


def sensitivities(solution: MixedSolution, *, height: FloatArray, **as_solve_mixed: Any) -> FrictionSensitivities:
    """Return the derivatives of a mixed point with respect to load, height, modulus, hardness and viscosity.

    Parameters
    ----------
    solution : from `solve_mixed`.
    height : (nx, ny), roughness of both surfaces together [m].
    **as_solve_mixed : the other arguments of `solve_mixed`; `speeds` and `initial` are not used.

    Raises
    ------
    InputError : arguments as of `solve_mixed`. ConvergenceError : as `point_derivatives`.
    """
    arguments = {name: value for name, value in as_solve_mixed.items() if name not in ("speeds", "initial")}
    setup = MixedSetup(**arguments)
    step = step_of(setup)
    pair = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    modulus = contact_modulus(*(body.material for body in pair))

    def inputs(name: str, factor: float) -> PointInputs:
        if name == "height":
            return PointInputs(setup, factor * height, solution.speeds)
        if name == "modulus":
            first, last = _stiffer(pair[0], factor), _stiffer(pair[-1], factor)
            own = None if setup.film_modulus is None else factor * setup.film_modulus
            changed = replace(setup, bodies=(first, last) if len(pair) > 1 else first, film_modulus=own)
        elif name == "viscosity":
            changed = replace(setup, lubricant=replace(setup.lubricant, viscosity=factor * setup.lubricant.viscosity))
        else:
            changed = replace(setup, **{name: factor * getattr(setup, name)})
        return PointInputs(changed, height, solution.speeds)

    values = {"load": setup.load, "height": 1.0, "modulus": modulus, "viscosity": setup.lubricant.viscosity}
    if setup.hardness is not None:
        values["hardness"] = setup.hardness
    changes = {
        name: (inputs(name, 1 - step), inputs(name, 1 + step), 2 * step * value) for name, value in values.items()
    }
    found = point_derivatives(solution, PointInputs(setup, height, solution.speeds), changes)
    return FrictionSensitivities(
        found["load"], found["height"], found["modulus"], found.get("hardness"), found["viscosity"]
    )


def _stiffer(body: Body, factor: float) -> Body:
    """Return a body with all Young's moduli times a factor."""

    def stiffer(material: Material) -> Material:
        return replace(material, youngs_modulus=factor * material.youngs_modulus)

    layers = [Layer(stiffer(layer.material), layer.thickness) for layer in body.layers]
    return Body(stiffer(body.material), layers=layers)


def step_of(setup: MixedSetup) -> float:
    """Return the relative step of inputs."""
    return STEP if setup.thermal == "off" else STEP_WITH_HEAT


def point_derivatives(
    solution: MixedSolution, inputs: PointInputs, changes: Mapping[str, tuple[PointInputs, PointInputs, float]]
) -> dict[str, PointDerivatives]:
    """Return the derivatives of a mixed point along changes of its inputs.

    Parameters
    ----------
    solution : of the point.
    inputs : of the solution.
    changes : by name, the inputs before and after a small change, and the difference of the parameter between them.

    Raises
    ------
    ConvergenceError : a trial's film or contact that did not converge, or a balance that does not depend on the share
        of the load.
    """
    middle = _Trial.of(solution, inputs)
    by_odds: tuple[dict[str, float], float] | None = None
    if solution.regime is Regime.MIXED:
        step = step_of(inputs.setup)
        ends = [middle.again(inputs, sign * step) for sign in (-1, 1)]
        by_odds = _difference(ends[0], ends[1], 2 * step)
        if not abs(by_odds[1]) > 0:
            raise ConvergenceError("point_derivatives: the balance does not depend on the share of the load")
    found = {}
    for name, (before, after, difference) in changes.items():
        rates, mismatch = _difference(middle.again(before), middle.again(after), difference)
        if by_odds is not None:
            odds = -mismatch / by_odds[1]
            rates = {figure: rate + odds * by_odds[0][figure] for figure, rate in rates.items()}
        found[name] = PointDerivatives(**rates)
    return found


def _difference(before: _Trial, after: _Trial, difference: float) -> tuple[dict[str, float], float]:
    """Return the difference quotients of the figures and of the mismatch."""
    rates = {name: (after.figures[name] - before.figures[name]) / difference for name in FIGURES}
    return rates, (after.mismatch - before.mismatch) / difference


@dataclass(frozen=True, eq=False)
class _Trial:
    """Film and contact at a share of the load, with figures and volume mismatch; starts others like it.

    log_odds : of the film load. whole : film under the whole load, for the lambda ratio.
    """

    regime: Regime
    log_odds: float
    film: PatchFilm
    contact: Pressed | None
    whole: PatchFilm
    figures: Mapping[str, float]
    mismatch: float

    @classmethod
    def of(cls, solution: MixedSolution, inputs: PointInputs) -> _Trial:
        """Return the trial at the balance of a solution."""
        share = solution.film_load / solution.load
        log_odds = math.log(share / max(1 - share, LEAST_REST))
        return cls._solve(solution.regime, log_odds, inputs, solution, None)

    def again(self, inputs: PointInputs, change: float = 0.0) -> _Trial:
        """Return the trial with other inputs, and with a change of the log odds."""
        return self._solve(self.regime, self.log_odds + change, inputs, None, self)

    @classmethod
    def _solve(
        cls, regime: Regime, log_odds: float, inputs: PointInputs, solution: MixedSolution | None, start: _Trial | None
    ) -> _Trial:
        setup, speeds = inputs.setup, inputs.speeds
        known = start.film.solution if start is not None else None if solution is None else solution.film
        films = films_of(setup, speeds, initial=known)
        sharing = LoadSharing(setup, films, speeds)
        rough, load = sharing.contact_of(inputs.height), setup.load
        film_load = load if regime is Regime.FULL_FILM else load / (1 + math.exp(-log_odds))
        level = len(films.level_errors) - 1
        film = films.under(min(film_load, films.largest_load), level, None if start is None else start.film)
        contact, mismatch = None, 0.0
        if regime is not Regime.FULL_FILM:
            pressure = start.contact.pressure if start is not None and start.contact is not None else None
            rest = min(load - film_load, rough.largest_load)
            contact = rough.at_load(film, rest, min(rough.tolerance, _CONTACT), pressure)
            mismatch = math.log(rough.oil(film) / max(contact.opening, 1e-300))
            if regime is Regime.BOUNDARY:
                film = film.sheared_in(contact.opening, rough.oil(film))
        for part, status in (("film", film.status), ("contact", None if contact is None else contact.status)):
            if status is not None and status.value != "converged":
                raise ConvergenceError(f"point_derivatives: the {part} of a trial is {status.value}")
        whole_start = None if start is None else start.whole
        if whole_start is None and solution is not None:
            whole_start = solution.continuation.whole_film
        whole = sharing.films_under_whole_load(rough, whole_start)[-1]
        figures = cls._figures(film, contact, whole, inputs)
        return cls(regime, log_odds, film, contact, whole, figures, mismatch)

    @staticmethod
    def _figures(film: PatchFilm, contact: Pressed | None, whole: PatchFilm, inputs: PointInputs) -> dict[str, float]:
        setup = inputs.setup
        forces = friction_forces(film, contact, setup, inputs.speeds)
        rms = float(inputs.height.std())
        area = 0.0 if contact is None else contact.solution.contact_area
        return {
            "friction": (forces.boundary + forces.film) / setup.load,
            "boundary_part": forces.boundary / setup.load,
            "film_part": forces.film / setup.load,
            "contact_load": 0.0 if contact is None else contact.load,
            "film_load": film.load,
            "minimum_film": film.minimum_thickness,
            "lambda_ratio": whole.minimum_thickness / rms if rms > 0 else math.inf,
            "contact_area_fraction": area / setup.grid.area,
        }
