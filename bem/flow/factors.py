"""Flow factors of a patch of rough surface in deformed contact, over the separation of the mean planes.

Patir and Cheng's averaged flow (Journal of Lubrication Technology 100 (1978) 12; 101 (1979) 220), for speeds U1, U2 of
the walls along x, a separation d and the rms height s of both surfaces together,

    q_x = -phi_x d^3 / (12 mu) dp/dx + (U1 + U2)/2 hbar + (U1 - U2)/2 s phi_s,
    tau = mu (U2 - U1)/d (phi_f + phi_fs) + phi_fp d/2 dp/dx      on the smooth wall 2, where wall 1 is rough,

hbar being the mean gap. Patir and Cheng computed the factors by flow simulation on small patches with sealed sides;
here they are the means of the periodic cell problem (`bem.flow.cell_problem`):

    phi_x = K_xx/d^3,   s phi_s = hbar - M_xx,   phi_f = d <1/h>,   phi_fs = 3 d <h dchi_s/dx>,   phi_fp = M_xx/d.

All roughness is taken to be on wall 1. Roughness on both walls enters phi_s and phi_fs by the difference of the
variances, (s1^2 - s2^2)/s^2, as in the 1979 paper: exact to second order in s/d, an approximation in contact.

tau acts on the smooth wall, where by equilibrium it is also the friction force; on the rough wall the pressure on the
slopes carries the difference. <1/h> is singular beside contact; it and phi_fs leave out gaps below s/100 as Patir and
Cheng do, also between the centres of cells (`bem.flow.inverse_gap`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.contact import solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import InputError, Status
from bem.flow.cell_problem import CellFlow, cell_flow
from bem.flow.factor_curve import FactorCurve
from bem.flow.inverse_gap import InverseGap, inverse_gap_of_contact, inverse_gap_of_cut_heights
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes import Note
from bem.notes.lubrication import FLOW_FACTORS_LIMIT
from bem.representation import readable

LEAST_GAP = 1e-4
"""Gap over rms height below which a cell is closed: less than an atom on any engineering surface; its flow would be
1e-12 of the flow through a gap of the rms height."""
LEAST_SHEAR_GAP = 1e-2
"""Gap over rms height below which the fluid does not enter the mean shear stress."""


@readable
@dataclass(frozen=True, eq=False)
class FlowFactors:
    """Flow factors over separation; arrays have one value for each separation.

    Attributes
    ----------
    separations : [m], rising: distance of the mean planes of the undeformed surfaces less the approach. The mean
        deflection of a doubly periodic patch is zero by definition.
    pressure_x, pressure_y : phi_x and phi_y: Poiseuille flow over the flow between smooth walls at the separation;
        exactly 0 where the fluid does not percolate.
    pressure_xy : Poiseuille flow along x under a gradient along y (and the reverse), over the same flow; not zero for
        oblique lays.
    shear_x : phi_s of roughness on wall 1 alone; see the module for two rough walls.
    friction_sliding, friction_shear, friction_pressure : phi_f, phi_fs and phi_fp of the stress on the smooth wall.
    mean_gap : [m], of the deformed gap.
    contact_area_fraction : of the patch.
    mean_gap_scatter : [m], standard deviation of the mean gap by the unknown position, between the centres of cells, of
        the edges at which heights are cut off; 0 for bodies that deform.
    flows_through_x, flows_through_y : whether the fluid percolates along the axis.
    pressure_x_error, pressure_y_error, shear_x_error : difference to cells twice as large, over 3 (second order); NaN
        if not asked for.
    residual : the largest of the contact's and the flow's.
    iterations : of the flow's conjugate gradients.
    statuses : outcome at each separation.
    status : the worst of them.
    rms_height : s [m].
    notes : sentences on the limits of the results.
    wall_share : (s1^2 - s2^2)/s^2, for films that use the table: 1 is all roughness on wall 1, -1 on wall 2.
    coarser : all factors on cells twice as large, by name; None if not asked for, or if the grid has no such cells.
    """

    separations: FloatArray
    pressure_x: FloatArray
    pressure_y: FloatArray
    pressure_xy: FloatArray
    shear_x: FloatArray
    friction_sliding: FloatArray
    friction_shear: FloatArray
    friction_pressure: FloatArray
    mean_gap: FloatArray
    mean_gap_scatter: FloatArray
    contact_area_fraction: FloatArray
    flows_through_x: FloatArray
    flows_through_y: FloatArray
    pressure_x_error: FloatArray
    pressure_y_error: FloatArray
    shear_x_error: FloatArray
    residual: FloatArray
    iterations: FloatArray
    statuses: tuple[Status, ...]
    rms_height: float
    wall_share: float = 1.0
    notes: tuple[Note, ...] = ()
    coarser: Mapping[str, FloatArray] | None = None

    @property
    def status(self) -> Status:
        """The first outcome that is not converged, if any."""
        return next((status for status in self.statuses if status is not Status.CONVERGED), Status.CONVERGED)

    @cached_property
    def pressure_x_curve(self) -> FactorCurve:
        """phi_x between and beyond the separations: 1 plus a multiple of d^-2 far away."""
        return FactorCurve(self.separations, self.pressure_x, 1.0, 2.0)

    @cached_property
    def pressure_y_curve(self) -> FactorCurve:
        """phi_y likewise."""
        return FactorCurve(self.separations, self.pressure_y, 1.0, 2.0)

    @cached_property
    def shear_x_curve(self) -> FactorCurve:
        """phi_s likewise: a multiple of 1/d far away; of d near contact, where the rough wall carries all fluid."""
        return FactorCurve(self.separations, np.maximum(self.shear_x, 0.0), 0.0, 1.0, growth_exponent=1.0)


def flow_factors(
    heights: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body] | None,
    *,
    separations: Sequence[float] | FloatArray,
    hardness: float | None = None,
    wall_share: float = 1.0,
    tolerance: float = 1e-6,
    errors: bool = False,
    callback: Callable[[int], object] | None = None,
) -> FlowFactors:
    """Compute the flow factors of a patch of rough surface at given separations of the mean planes.

    At each separation d the bodies are pressed together until their mean planes are d apart, elastically or capped at
    the hardness; the flow's cell problem is solved in the gap that is left.

    Parameters
    ----------
    heights : (nx, ny) [m], positive out of the body: of one rough surface, or the sum of both surfaces' heights. The
        patch repeats along both axes, whatever the grid says; its mean is taken out.
    grid : of the patch, (nx, ny) cells.
    bodies : one Body (the other rigid), a pair, or None: heights above d are cut off and nothing is deformed, as in
        Patir and Cheng's simulations.
    separations : [m], positive, in any order; the table is in rising order.
    hardness : cap on the contact pressure [Pa]; None for purely elastic. With it the mean gap exceeds d by the mean
        plastic depth.
    wall_share : (s1^2 - s2^2)/s^2 of the two walls' rms heights, handed on to films; no factor depends on it.
    tolerance : bound on the residual of contact and flow; factors are good to a part of it. Below 1e-7 the potentials'
        last digit may be in the way where little flows.
    errors : whether to repeat all with cells twice as large, for the error of the cell; a quarter more work.
    callback : called with the number of separations done, after each.

    Raises
    ------
    InputError : heights, separations or hardness out of range, one message for each.
    """
    centred, rising = _check_arguments(heights, grid, separations, hardness, bodies)
    notes = []
    rms = float(np.sqrt(np.mean(centred**2)))
    patch = _Patch.of(centred, grid, bodies, hardness, tolerance, rms)
    rows = []
    for d in rising:
        rows.append(patch.solve(d))
        if callback is not None:
            callback(len(rows))
    columns = {name: np.array([row[0][name] for row in rows]) for name in rows[0][0]}
    coarse = patch.coarsened(bodies) if errors else None
    coarser: dict[str, FloatArray] | None = None
    for name in ("pressure_x", "pressure_y", "shear_x"):
        columns[f"{name}_error"] = np.full(len(rising), np.nan)
    if coarse is not None:
        coarse_rows = [coarse.solve(d)[0] for d in rising]
        coarser = {name: np.array([row[name] for row in coarse_rows]) for name in coarse_rows[0]}
        for name in ("pressure_x", "pressure_y", "shear_x"):
            columns[f"{name}_error"] = np.abs(columns[name] - coarser[name]) / 3
    closed = [f"{1e9 * d:.4g} nm" for d, row in zip(rising, rows, strict=True) if row[0]["pressure_x"] == 0]
    if closed:
        notes.append(FLOW_FACTORS_LIMIT(separations=closed, reason="table"))
    return FlowFactors(
        wall_share=float(wall_share),
        separations=rising,
        statuses=tuple(row[1] for row in rows),
        rms_height=rms,
        notes=tuple(notes),
        coarser=coarser,
        **columns,
    )


TABLE_RATIOS = (0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.5, 7.0)
"""Separations over rms height of the table for films; beyond the last one perturbation theory holds."""


def factors_for_films(
    lower: FloatArray,
    upper: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    hardness: float | None = None,
    tolerance: float = 1e-6,
) -> FlowFactors:
    """Return the table of a film between two rough surfaces (nx, ny) [m]; wall 1 is the lower one.

    Raises
    ------
    InputError : as `flow_factors`; two smooth surfaces.
    """
    one, two = float(np.var(lower)), float(np.var(upper))
    heights = lower + upper
    rms = float(np.std(heights))
    if rms == 0:
        raise InputError("flow_factors: both surfaces are smooth; allowed: roughness on one of them, or no factors")
    return flow_factors(
        heights,
        grid,
        bodies,
        separations=rms * np.array(TABLE_RATIOS),
        hardness=hardness,
        wall_share=(one - two) / (one + two),
        tolerance=tolerance,
    )


@dataclass(frozen=True, eq=False)
class _Patch:
    """A rough patch, periodic along both axes, and its operator of dry contact.

    Attributes
    ----------
    heights : (nx, ny) [m], zero mean.
    grid : periodic along both axes.
    operator : displacement operator; None for rigid bodies with heights cut off.
    hardness : cap on the contact pressure [Pa], or None.
    tolerance : of contact and flow.
    rms : rms height [m] of the patch on its original grid.
    """

    heights: FloatArray
    grid: Grid
    operator: DisplacementOperator | None
    hardness: float | None
    tolerance: float
    rms: float

    @classmethod
    def of(
        cls,
        heights: FloatArray,
        grid: Grid,
        bodies: Body | tuple[Body, Body] | None,
        hardness: float | None,
        tolerance: float,
        rms: float,
    ) -> _Patch:
        periodic = Grid(grid.shape, grid.spacing, periodic=(True, True))
        operator = None if bodies is None else displacement_operator(periodic, bodies)
        return cls(heights, periodic, operator, hardness, tolerance, rms)

    def coarsened(self, bodies: Body | tuple[Body, Body] | None) -> _Patch | None:
        """Return the patch on every second cell along each axis; None if the number of cells is odd or below 8."""
        steps = tuple(2 if n > 1 else 1 for n in self.grid.shape)
        if any(n % step or 1 < n < 8 for n, step in zip(self.grid.shape, steps, strict=True)):
            return None
        heights = np.ascontiguousarray(self.heights[:: steps[0], :: steps[1]])
        (dx, dy), (nx, ny) = self.grid.spacing, heights.shape
        grid = Grid((nx, ny), (steps[0] * dx, steps[1] * dy))
        # the mean is not removed again: the mean planes are those of the original surface
        return _Patch.of(heights, grid, bodies, self.hardness, self.tolerance, self.rms)

    def solve(self, separation: float) -> tuple[dict[str, float], Status]:
        """Return all factors at one separation [m], by name of the field of `FlowFactors`, and the worst status."""
        gap, area, residual, status = self.contact_gap(separation)
        # lengths over the separation: K, M and <1/h> then have no unit
        gap, least = gap / separation, LEAST_SHEAR_GAP * self.rms / separation
        inverse = self._inverse_gap(gap, separation, least)
        flow = cell_flow(gap, self.grid.spacing, tolerance=self.tolerance, inverse=inverse)
        named = self._factors(flow, separation, area, max(residual, flow.residual))
        named["friction_sliding"] = float(inverse.means.mean())
        named["mean_gap_scatter"] = 0.0 if self.operator is not None else self._mean_gap_scatter(separation)
        return named, status if status is not Status.CONVERGED else flow.status

    def _inverse_gap(self, gap: FloatArray, separation: float, least: float) -> InverseGap:
        """Return the inverse gap in units of the separation; gaps (nx, ny) below `least` do not count."""
        if self.rms == 0:
            return InverseGap(np.ones(gap.shape), np.full(gap.shape, np.nan))
        if self.operator is None:
            return inverse_gap_of_cut_heights(1 - self.heights / separation, least, self.grid.spacing)
        return inverse_gap_of_contact(gap, least, self.grid.spacing)

    def _mean_gap_scatter(self, separation: float) -> float:
        """Return the standard deviation [m] of the mean gap by the position of cuts within cells (rigid bodies).

        In a cell with a kink of slope a per cell, at distance u from the centre, the centre's value differs from the
        cell's mean by a (u^2/2 - 1/24); with u uniform from -1/2 to 1/2 its standard deviation is a/sqrt(720).
        """
        opening, squares = separation - self.heights, []
        for axis in (0, 1):
            beside = np.roll(opening, -1, axis)
            squares.append(float((np.square(beside - opening)[(beside > 0) != (opening > 0)]).sum()))
        return math.sqrt(max(squares) / 720) / opening.size

    def contact_gap(self, separation: float) -> tuple[FloatArray, float, float, Status]:
        """Return the gap (nx, ny) [m], zero in contact, the contact area fraction, the contact's residual and status.

        The gap of a contact is -heights + displacement - approach: at the approach -separation and without contact it
        is separation - heights.
        """
        if self.operator is None:
            gap = np.maximum(separation - self.heights, 0.0)
            area, residual, status = float((gap == 0).mean()), 0.0, Status.CONVERGED
        else:
            solution = solve_contact(
                -self.heights, self.operator, approach=-separation, hardness=self.hardness, tolerance=self.tolerance
            )
            gap = np.where(solution.pressure > 0, 0.0, np.maximum(solution.gap, 0.0))
            area, residual, status = solution.contact_area / self.grid.area, solution.residual, solution.status
        return np.where(gap < LEAST_GAP * self.rms, 0.0, gap), area, residual, status

    def _factors(self, flow: CellFlow, separation: float, area: float, residual: float) -> dict[str, float]:
        """Return the factors that follow from the mean flow (formulas of the module), by name."""
        couette_gap = flow.couette_gap[0, 0]
        return {
            "pressure_x": flow.pressure_flow[0, 0],
            "pressure_y": flow.pressure_flow[1, 1],
            "pressure_xy": flow.pressure_flow[0, 1],
            "shear_x": (flow.mean_gap - couette_gap) * separation / self.rms if self.rms > 0 else 0.0,
            "friction_shear": 3 * flow.sliding_shear,
            "friction_pressure": couette_gap,
            "mean_gap": flow.mean_gap * separation,
            "contact_area_fraction": area,
            "flows_through_x": flow.percolates_x,
            "flows_through_y": flow.percolates_y,
            "residual": residual,
            "iterations": flow.iterations,
        }


def _check_arguments(
    heights: FloatArray,
    grid: Grid,
    separations: Sequence[float] | FloatArray,
    hardness: float | None,
    bodies: Body | tuple[Body, Body] | None,
) -> tuple[FloatArray, FloatArray]:
    """Check the arguments; return the heights without their mean and the separations in rising order."""
    if not isinstance(grid, Grid):
        raise InputError(f"flow_factors: grid {grid!r} must be a Grid")
    messages: list[str] = []
    checked, apart = np.zeros(grid.shape), np.zeros(0)
    try:
        checked = grid.check_field(heights, "flow_factors: heights")
    except InputError as error:
        messages.extend(error.messages)
    try:
        apart = np.unique(np.asarray(separations, dtype=np.float64).reshape(-1))
    except (TypeError, ValueError):
        messages.append(f"flow_factors: separations {separations!r} must be lengths [m]")
    else:
        bad = [float(d) for d in apart if not (math.isfinite(d) and d > 0)]
        if bad or apart.size == 0:
            messages.append(
                f"flow_factors: separations {bad if bad else 'none'}: allowed are one or more positive, finite ones "
                "[m]; elastic bodies whose mean planes meet have no gap left"
            )
    if hardness is not None and bodies is None:
        messages.append(f"flow_factors: hardness {hardness!r} has no meaning without bodies")
    if messages:
        raise InputError(messages)
    return np.ascontiguousarray(checked - checked.mean()), apart
