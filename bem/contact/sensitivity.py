"""Derivatives of a solved contact with respect to its inputs, from one more linear solution.

Where no cell changes its state, the contact is a smooth function of its inputs. With A the cells between the bounds, C
the capped ones and a dot for the derivative along a direction of the inputs, the contact conditions give

    (K p')_A + d_A = approach',   p'_C = hardness',   p' = 0 on open cells,   sum of p' = load' / cell area,

where d is the derivative of the undeformed gap plus that of the displacement K p at fixed p. It is the linear system of
step 9 of `bem.contact` with another right-hand side: `pcg` (`gcr` with friction in the gap) solves it in single
precision with the preconditioner of the contact, and residuals in double precision refine the solution three or four
times. Cost: 20 to 40 convolutions. A prescribed approach or mean gap combines two such solutions, that of the direction
at fixed load and that of the load alone.

The derivative of every figure, area and highest pressure included, is that of its own formula: `ContactTangent.moved`
returns the contact after a small step along the tangent, with the figures evaluated anew on the moved fields.

Exact scaling laws replace solutions (`sensitivities`). Scaling load, hardness and undeformed gap together scales
pressures and gaps alike and leaves the area; scaling load, hardness and modulus together scales pressures alone. Height
and modulus therefore follow from load and hardness, and an elastic contact takes one solution for all three.

Where a cell changes its state within the step, areas and pressures have a kink and both one-sided derivatives differ:
cells next to the edge join at zero pressure, so that pressures and gaps stay continuous and their derivatives jump by
a part of the order of one cell of the edge. The derivatives here are those of the present states.

Verified in tests/contact/test_contact_sensitivity.py: differences of solved contacts, Hertz, scaling laws.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.contact import gcr, pcg
from bem.contact.bounds import Iterate
from bem.contact.certificate import area_wavenumber, regions_of
from bem.contact.controls import LoadControl
from bem.contact.grid_workspace import ActiveCells, GridWorkspace, IterationBudget, SolverParameters
from bem.contact.peak_pressure import highest_pressure
from bem.contact.solution import ContactSolution
from bem.convolution import DisplacementOperator
from bem.errors import ConvergenceError, InputError
from bem.threads import one_blas_thread

FloatArray = NDArray[np.float64]

PRESCRIBED = ("load", "approach", "mean_gap")
"""Quantities that may be prescribed."""

_TOLERANCE = 1e-11
"""Largest residual of the tangent over the largest right-hand side; differences resolve 1e-8 at best."""

_ROUNDS = 20
"""Limit of refinements; each gains three to four digits."""

_STEP = 1e-6
"""Step of the derivatives of figures, as relative change of the pressures: central differences of a smooth formula."""

_LEAST_PRESSURE = 1e-3
"""Fraction of its pressure that a cell keeps at least in a step: it stays in contact."""


@dataclass(frozen=True)
class InputChange:
    """Direction in the inputs of a contact, per unit of one parameter.

    gap : change of the undeformed gap (nx, ny) [m]; a uniform gap may be a number.
    load [N], approach [m], mean_gap [m] : change of the prescribed quantity; the others are ignored.
    hardness : change of the hardness [Pa].
    modulus : relative change of the contact modulus E*.
    displacement : change of the displacement at fixed pressure (nx, ny) [m]; None for that of `modulus`, which is all
        of it for homogeneous bodies without friction in the gap.
    """

    gap: FloatArray | float = 0.0
    load: float = 0.0
    approach: float = 0.0
    mean_gap: float = 0.0
    hardness: float = 0.0
    modulus: float = 0.0
    displacement: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class ContactTangent:
    """Derivative of a contact along a direction of its inputs; arrays (nx, ny).

    Attributes
    ----------
    solution : the contact. undeformed : its undeformed gap [m]. operator, hardness : as of `solve_contact`.
    change : the direction.
    pressure [Pa], displacement [m], approach [m], load [N] : derivatives per unit of the parameter.
    gap : derivative of undeformed gap + displacement - approach [m], zero between the bounds.
    mean_gap : derivative of the mean of the open gap [m].
    residual : largest residual of the linear system over the largest right-hand side.
    convolutions : applications of the operator.
    """

    solution: ContactSolution
    undeformed: FloatArray
    operator: DisplacementOperator
    hardness: float
    change: InputChange
    pressure: FloatArray
    displacement: FloatArray
    gap: FloatArray
    approach: float
    load: float
    residual: float
    convolutions: float

    @property
    def mean_gap(self) -> float:
        """Derivative of the mean of the open gap [m]."""
        return float(self.gap[self._open].sum()) / self.gap.size

    @property
    def _open(self) -> NDArray[np.bool_]:
        return self.solution.pressure <= 0

    def step(self, relative: float = _STEP) -> float:
        """Return the step of the parameter that changes the pressures, or the gaps, by a relative amount (rms)."""
        sizes = (
            (self.pressure, self.solution.pressure),
            (self.gap, self.solution.gap),
        )
        rates = [float(np.linalg.norm(rate) / norm) for rate, value in sizes if (norm := np.linalg.norm(value)) > 0]
        largest = max([*rates, abs(self.change.modulus)], default=0.0)
        return relative / largest if largest > 0 else relative

    def moved(self, step: float) -> ContactSolution:
        """Return the contact after a step of the parameter along the tangent; every cell keeps its state.

        Area, perimeter and highest pressure are evaluated anew. The step must be small: it does not solve the contact.
        """
        solution, grid = self.solution, self.operator.grid
        cap = self.hardness + step * self.change.hardness
        capped, opened = solution.pressure >= self.hardness, self._open
        below = np.nextafter(cap, 0.0) if math.isfinite(cap) else math.inf
        pressure = np.clip(solution.pressure + step * self.pressure, _LEAST_PRESSURE * solution.pressure, below)
        pressure[opened] = 0.0
        pressure[capped] = cap
        gap = solution.gap + step * self.gap
        gap[opened] = np.maximum(gap[opened], 0.0)
        depth = np.where(capped, np.maximum(solution.plastic_depth - step * self.gap, 0.0), 0.0)
        load = solution.load + step * self.load
        modulus = self.operator.modulus_at(area_wavenumber(grid)) * (1 + step * self.change.modulus)
        contact, plastic, _ = regions_of(
            self.operator,
            self.undeformed + step * self.change.gap,
            pressure,
            gap,
            load=load,
            cap=cap,
            modulus=modulus,
            capped=bool(capped.any()),
        )
        return replace(
            solution,
            pressure=pressure,
            displacement=solution.displacement + step * self.displacement,
            gap=gap,
            approach=solution.approach + step * self.approach,
            load=load,
            contact_area=contact.area,
            plastic_area=min(plastic.area, contact.area),
            counted_area=contact.counted_area,
            counted_plastic_area=plastic.counted_area,
            contact_perimeter=contact.perimeter,
            maximum_pressure=highest_pressure(pressure, grid, cap),
            plastic_depth=depth,
        )

    def figures(self) -> ContactDerivatives:
        """Return the derivatives of the figures."""
        step = self.step()
        after, before = self.moved(step), self.moved(-step)

        def rate(name: str) -> float:
            return (getattr(after, name) - getattr(before, name)) / (2 * step)

        return ContactDerivatives(
            contact_area=rate("contact_area"),
            plastic_area=rate("plastic_area"),
            maximum_pressure=rate("maximum_pressure"),
            mean_gap=self.mean_gap,
            approach=self.approach,
            load=self.load,
        )

    def combined(self, other: ContactTangent, factor: float, change: InputChange) -> ContactTangent:
        """Return this tangent plus a multiple of another one, as the tangent of a direction."""
        names = ("pressure", "displacement", "gap", "approach", "load")
        return replace(
            self,
            change=change,
            residual=self.residual + abs(factor) * other.residual,
            convolutions=self.convolutions + other.convolutions,
            **{name: getattr(self, name) + factor * getattr(other, name) for name in names},
        )


@dataclass(frozen=True)
class ContactDerivatives:
    """Derivatives of the figures of a contact, per unit of one input.

    contact_area, plastic_area [m^2], maximum_pressure [Pa], mean_gap, approach [m], load [N] : per unit of the input.
    """

    contact_area: float
    plastic_area: float
    maximum_pressure: float
    mean_gap: float
    approach: float
    load: float


@dataclass(frozen=True)
class ContactSensitivities:
    """Derivatives of the figures of a contact with respect to its inputs.

    Attributes
    ----------
    load : per newton of load; None where another quantity is prescribed.
    height : per relative change of the undeformed gap, that is scaling form and roughness alike; or of the roughness
        that was given.
    modulus : per pascal of the contact modulus E*.
    hardness : per pascal of the hardness; None of an elastic contact.
    residual : largest residual of the linear systems over their right-hand sides.
    convolutions : applications of the operator, of all systems.
    """

    load: ContactDerivatives | None
    height: ContactDerivatives
    modulus: ContactDerivatives
    hardness: ContactDerivatives | None
    residual: float
    convolutions: float


@one_blas_thread
def contact_tangent(
    solution: ContactSolution,
    gap: FloatArray,
    operator: DisplacementOperator,
    change: InputChange,
    *,
    hardness: float | None = None,
    prescribed: str = "load",
) -> ContactTangent:
    """Return the derivative of a solved contact along a direction of its inputs.

    Parameters
    ----------
    solution : from `solve_contact`.
    gap : (nx, ny), undeformed gap [m].
    operator, hardness : as they were given to `solve_contact`.
    change : direction of the inputs, per unit of a parameter.
    prescribed : quantity that was prescribed and changes as `change` says: "load", "approach" or "mean_gap".

    Raises
    ------
    InputError : an unknown prescribed quantity; no cell between the bounds, where the pressure is not determined by
        the gap; an approach or a mean gap that does not depend on the load, as in full contact on a periodic grid.
    ConvergenceError : the linear system is not solved to 1e-6.
    """
    if prescribed not in PRESCRIBED:
        raise InputError(f"contact_tangent: prescribed {prescribed!r} is unknown; choose from {', '.join(PRESCRIBED)}")
    gap = operator.grid.check_field(gap, "contact_tangent: gap")
    system = _System(solution, gap, operator, math.inf if hardness is None else float(hardness))
    if prescribed == "load":
        return system.at_load(change)
    tangent, unit = system.at_load(replace(change, load=0.0)), system.at_load(InputChange(load=1.0))
    asked = getattr(change, prescribed)
    found, per_load = getattr(tangent, prescribed), getattr(unit, prescribed)
    scale = max(float(np.abs(unit.displacement).max()), float(np.abs(unit.gap).max()))
    if abs(per_load) <= _TOLERANCE * scale:
        raise InputError(f"contact_tangent: the {prescribed} does not depend on the load here; prescribe the load")
    return tangent.combined(unit, (asked - found) / per_load, change)


def sensitivities(
    solution: ContactSolution,
    gap: FloatArray,
    operator: DisplacementOperator,
    *,
    hardness: float | None = None,
    prescribed: str = "load",
    roughness: FloatArray | None = None,
) -> ContactSensitivities:
    """Return the derivatives of a contact with respect to load, height, modulus and hardness.

    One linear solution of an elastic contact under load, one more below a hardness that is reached, for a prescribed
    approach or mean gap, and for `roughness`; scaling laws give the others. The contact has homogeneous bodies.

    Parameters
    ----------
    solution, gap, operator, hardness, prescribed : as of `contact_tangent`.
    roughness : (nx, ny), part of the undeformed gap that `height` scales [m]; by default all of it.

    Raises
    ------
    InputError : layered bodies, surface tension or a local compliance, whose modulus is no scale of all displacements:
        use `contact_tangent`; else as `contact_tangent`.
    ConvergenceError : as `contact_tangent`.
    """
    tense = any(body.material.surface_tension is not None for body in operator.bodies)
    if operator.compliance > 0 or tense or not all(body.homogeneous for body in operator.bodies):
        raise InputError(
            "sensitivities: layered bodies, surface tension and a local compliance have no one modulus; allowed: "
            "homogeneous bodies without tension, or contact_tangent with the change of the displacement"
        )
    gap = operator.grid.check_field(gap, "sensitivities: gap")
    directions: dict[str, InputChange] = {}
    if prescribed == "load":
        directions["load"] = InputChange(load=1.0)
    if hardness is not None:
        directions["hardness"] = InputChange(hardness=1.0)
    if roughness is not None:
        directions["height"] = InputChange(gap=operator.grid.check_field(roughness, "sensitivities: roughness"))

    def tangent(change: InputChange) -> ContactTangent:
        return contact_tangent(solution, gap, operator, change, hardness=hardness, prescribed=prescribed)

    solved = {name: tangent(change) for name, change in directions.items()}
    if prescribed != "load":
        solved["modulus"] = tangent(InputChange(modulus=1 / operator.contact_modulus))
    found = {name: one.figures() for name, one in solved.items()}
    # F d/dF + H d/dH + h d/dh = degree in lengths, F d/dF + H d/dH + E d/dE = degree in pressures
    force = {"load": solution.load, "hardness": hardness or 0.0}
    if "modulus" not in found:
        found["modulus"] = _by_scaling(solution, found, force, _STRESS, 1 / operator.contact_modulus)
    if "height" not in found:
        if prescribed == "load":
            found["height"] = _by_scaling(solution, found, force, _LENGTH, 1.0)
        else:
            found["height"] = tangent(InputChange(gap=gap)).figures()
    return ContactSensitivities(
        found.get("load"),
        found["height"],
        found["modulus"],
        found.get("hardness"),
        max(one.residual for one in solved.values()),
        sum(one.convolutions for one in solved.values()),
    )


_STRESS = {"contact_area": 0, "plastic_area": 0, "maximum_pressure": 1, "mean_gap": 0, "approach": 0, "load": 1}
_LENGTH = {"contact_area": 0, "plastic_area": 0, "maximum_pressure": 1, "mean_gap": 1, "approach": 1, "load": 1}
"""Powers of the scale that multiplies load, hardness and modulus, or load, hardness and undeformed gap."""


def _by_scaling(
    solution: ContactSolution,
    known: dict[str, ContactDerivatives],
    inputs: dict[str, float],
    degrees: dict[str, int],
    per: float,
) -> ContactDerivatives:
    """Return the derivatives with respect to the input that completes a scaling law, by Euler's theorem.

    known : derivatives with respect to the other inputs of the law. inputs : these inputs. degrees : of the figures.
    per : one over the input that is sought.
    """
    rest = {name: degree * _figure(solution, name) for name, degree in degrees.items()}
    for name, value in inputs.items():
        if name in known:
            rest = {figure: left - value * getattr(known[name], figure) for figure, left in rest.items()}
    return ContactDerivatives(**{name: per * left for name, left in rest.items()})


def _figure(solution: ContactSolution, name: str) -> float:
    if name == "mean_gap":
        return float(np.maximum(solution.gap, 0.0).mean())
    value: float = getattr(solution, name)
    return value


class _System:
    """Linear system of a contact whose cells keep their states."""

    def __init__(
        self, solution: ContactSolution, gap: FloatArray, operator: DisplacementOperator, hardness: float
    ) -> None:
        self.solution, self.gap, self.operator, self.hardness = solution, gap, operator, hardness
        flat = solution.pressure.reshape(-1)
        self.capped = flat >= hardness
        self.cells = np.flatnonzero((flat > 0) & ~self.capped)
        if self.cells.size == 0:
            raise InputError("contact_tangent: no cell is between zero pressure and hardness; no derivative exists")

    def at_load(self, change: InputChange) -> ContactTangent:
        """Return the tangent under a prescribed load, which changes as `change` says."""
        operator, shape = self.operator, self.operator.grid.shape
        before = operator.count.weighted
        fixed = np.zeros(shape)  # pressure of the capped cells
        known = np.zeros(shape) + change.gap + self._displacement(change)
        if self.capped.any() and change.hardness != 0:
            fixed.reshape(-1)[self.capped] = change.hardness
            known += operator(fixed)
        force = change.load / operator.grid.cell_area - float(fixed.sum())
        values, residual = self._solve(known.reshape(-1), force)
        pressure = fixed
        pressure.reshape(-1)[self.cells] = values
        own = operator(pressure) if np.any(values) or np.any(fixed) else np.zeros(shape)
        displacement = own + self._displacement(change)
        moved = displacement + change.gap
        approach = float(moved.reshape(-1)[self.cells].mean())
        gap = moved - approach
        gap.reshape(-1)[self.cells] = 0.0
        return ContactTangent(
            solution=self.solution,
            undeformed=self.gap,
            operator=operator,
            hardness=self.hardness,
            change=change,
            pressure=pressure,
            displacement=displacement,
            gap=gap,
            approach=approach,
            load=change.load,
            residual=residual,
            convolutions=operator.count.weighted - before,
        )

    def _displacement(self, change: InputChange) -> FloatArray | float:
        """Return the change of the displacement at fixed pressure [m]."""
        if change.displacement is not None:
            return change.displacement
        if change.modulus == 0:
            return 0.0
        local = self.operator.compliance * self.solution.pressure
        if self.operator.mean_free:
            local = local - local.mean()
        return -change.modulus * (self.solution.displacement - local)

    def _solve(self, known: FloatArray, force: float) -> tuple[FloatArray, float]:
        """Return pressures (n,) of a given sum whose displacement plus `known` is uniform over the cells, and the
        relative residual.

        Pressures and lengths are scaled to order one, for single precision.
        """
        operator, cells = self.operator, self.cells
        pressure = self.solution.pressure.reshape(-1)[cells]
        start = pressure * (force / float(pressure.sum()))
        start_size = float(np.abs(start).max()) * operator.unit
        length = max(float(np.abs(known[cells] - known[cells].mean()).max()), start_size)
        if not length > 0:
            return start, 0.0
        unit = length / operator.unit
        parameters = SolverParameters(clip_residual_ratio=0.0)
        grid = GridWorkspace(operator, known / length, math.inf, parameters)
        grid.extrapolation.trusted = False
        close_gap: Any = pcg.close_gap if operator.symmetric else gcr.close_gap
        control, budget = LoadControl(force / unit), IterationBudget(_ROUNDS * parameters.iterations_per_round)
        nothing = np.empty(0, np.int32)
        values, best, smallest = start / unit, start / unit, math.inf
        reference = 0.0
        for _ in range(_ROUNDS):
            grid.displace(Iterate(cells, values, cells[:0]))
            active: ActiveCells = grid.activate(
                Iterate(cells, values, cells[:0]), nothing, 0.0, with_unit_approach=True
            )
            largest = float(np.abs(active.gap - active.mean_residual).max())
            reference = reference or largest
            if largest < smallest:
                best, improved = values, largest < 0.5 * smallest
                smallest = largest
            else:
                improved = False
            if smallest <= _TOLERANCE * reference or not improved:
                break
            values = close_gap(grid, active, control, 0.0, budget)
        residual = smallest / reference if reference > 0 else 0.0
        if residual > 1e-6:
            raise ConvergenceError(
                f"contact_tangent: the linear system stalled at a relative residual of {residual:.2g}"
            )
        return best * unit, residual
