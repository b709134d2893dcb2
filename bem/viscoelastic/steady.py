"""Steady sliding or rolling of viscoelastic half-spaces, and the hysteresis friction.

In the frame of the contact the material of a body passes at a speed V along x. Its delayed pressures are
q(x) = integral of exp(-s / l) / l p(x - s) ds over s > 0 with l = V theta: a filter along x, of which K q is the
displacement. The displacement operator is K (1 + sum c_k M_k), which is not symmetric; it has the form that friction in
the gap gives an operator, and `bem.contact` solves it as such.

1. Doubly periodic grids: the filter multiplies the spectrum by 1 / (1 + i kx l), which is exact for the grid's waves.
2. Other grids: the pressure is linear between cells, so that the filter is a recursion over whole cells, applied to the
   influence coefficients. Beyond the grid these are those of a point (free) or of a line load and its waves along y (y
   periodic) and are integrated along the rest of the memory, however long.
3. Where the retarded part is much larger than the elastic one, the sets of cells in contact swing and the solver may
   stall. Then the proximal point method (Rockafellar 1976) follows: contacts of the operator with a symmetric part
   added that bounds the skew one, the addition being taken off by the pressure before. It converges for any operator
   whose symmetric part is positive, as that of a passive solid is.

Friction: the horizontal component of the pressures on the slope of the gap. The power that the dashpots dissipate is
friction times speed in the limit of small cells. It is computed by the waves of the pressure (`dissipation`), without
that slope and without this kernel, so that their difference is a certificate of both. The cells need not resolve the
memory: of a cylinder on 64 cells of 0.08 half-widths the power was within 0.6 % of the closed form at memories of 0.001
to 100 half-widths, on 512 within 0.01 %. Friction itself is of second order.

Cost: a contact takes 15 to 150 convolutions; where step 3 follows, thousands.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.arguments import is_finite
from bem.contact import ContactSolution, solve_contact
from bem.convolution import (
    EVEN,
    ODD_IN_X,
    DisplacementOperator,
    KernelSpectra,
    cached_spectra,
    elastic_constants,
)
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import Load, surface_coefficients
from bem.kernels.spectral import surface_response
from bem.materials import Body
from bem.representation import readable
from bem.transforms import kernel_spectrum, padded_shape
from bem.viscoelastic.compliance import DelayedTerm, pair_compliance, step_weights
from bem.viscoelastic.dissipation import dissipated_power

_NODES = 128
"""Gauss points over the memory beyond the coefficients."""
_FADED, _WAVES = 36.0, 32
"""Waves along the period beyond the coefficients: up to exp(-_FADED), and at most _WAVES for each cell."""
_PROXIMAL_STEPS = 400
_CLOSE = 1e-3
"""Relative change of the pressure in a proximal step below which the whole operator is tried again."""


@readable
@dataclass(frozen=True)
class SteadySolution:
    """Contact in steady sliding or rolling; SI units.

    Attributes
    ----------
    contact : pressure, gap and approach; its displacement includes the memory.
    friction_force : force along x that hysteresis takes [N], positive against the motion of the contact over the body.
    friction : friction_force over the load; zero without load.
    dissipated_power : of the dashpots [W].
    imbalance : friction force times speed less the dissipated power, over the larger one; zero without either. It is
        not-a-number where both bodies pass at different speeds.
    convolutions : applications of the operator.
    status : of the contact.
    """

    contact: ContactSolution
    friction_force: float
    friction: float
    dissipated_power: float
    imbalance: float
    convolutions: float
    status: Status


@dataclass(frozen=True)
class DelayedKernel:
    """Spectra of `own` K + sum of weights M_l K, M_l being the memory of a length.

    bodies : of K. own : factor of the elastic response. weights, lengths : of the terms; lengths [m] have the sign of
    the speed at which the body passes.
    """

    bodies: tuple[Body, ...]
    own: float
    weights: tuple[float, ...]
    lengths: tuple[float, ...]

    def __call__(self, grid: Grid) -> KernelSpectra:
        """Return the spectra on a grid, from the cache or computed."""
        key = (
            "delayed",
            grid,
            *(elastic_constants(body) for body in self.bodies),
            self.own,
            self.weights,
            self.lengths,
        )
        return cached_spectra(key, lambda: self._compute(grid))

    def _compute(self, grid: Grid) -> KernelSpectra:
        compliance = sum(1 / body.material.plane_strain_modulus for body in self.bodies)
        first = self.bodies[0]
        padded = padded_shape(grid.shape, grid.periodic)
        if all(grid.periodic):
            response = np.ascontiguousarray(surface_response(grid, first, Load.NORMAL)[: padded[0] // 2 + 1].T)
            k = 2 * np.pi * np.fft.rfftfreq(padded[0], grid.spacing[0])
            even, odd = np.full(k.size, self.own), np.zeros(k.size)
            for weight, length in zip(self.weights, self.lengths, strict=True):
                passed = k * length
                even += weight / (1 + passed**2)
                odd -= weight * passed / (1 + passed**2)
            if padded[0] % 2 == 0:
                odd[-1] = 0.0
            symmetric, skew = response * even, response * odd
        else:
            table = delayed_coefficients(grid, first, self.own, self.weights, self.lengths)
            symmetric = kernel_spectrum(table[0], padded, EVEN)
            skew = kernel_spectrum(table[1], padded, ODD_IN_X)
        factor = compliance * first.material.plane_strain_modulus
        largest = float(np.abs(symmetric).max()) * factor
        unit = 2.0 ** round(math.log2(largest)) if largest > 0 else 1.0
        return KernelSpectra(symmetric * (factor / unit), skew * (factor / unit), unit)


@dataclass(frozen=True)
class _Bounded:
    """Spectra of an operator whose symmetric part is raised to the size of the skew one, or the difference of both."""

    kernel: DelayedKernel
    added: bool

    def __call__(self, grid: Grid) -> KernelSpectra:
        spectra = self.kernel(grid)
        assert spectra.odd is not None
        raised = np.maximum(spectra.even, np.abs(spectra.odd))
        if self.added:
            return KernelSpectra(raised - spectra.even, None, spectra.unit)
        return KernelSpectra(raised, spectra.odd, spectra.unit)


def delayed_coefficients(
    grid: Grid, body: Body, own: float, weights: Sequence[float], lengths: Sequence[float]
) -> FloatArray:
    """Return even and odd part along x of the influence coefficients with memory, (2, nx, ny) [m/Pa].

    grid : not doubly periodic. The others as in `DelayedKernel`.
    """
    nx = grid.shape[0]
    sizes = np.abs(np.array(lengths, dtype=np.float64))[:, None]
    moving = sizes[:, 0] > 0
    amounts, signs = np.array(weights)[moving], np.sign(lengths)[moving]
    sizes, still = sizes[moving], float(np.array(weights)[~moving].sum())
    kept, before, after = step_weights(grid.spacing[0] / sizes[:, 0])
    if grid.periodic[0]:
        table = surface_coefficients(grid, body, Load.NORMAL)
        k = 2 * np.pi * np.arange(nx // 2 + 1) / nx
        turn = np.exp(1j * k)
        symbols = (after[:, None] + before[:, None] * turn) / (1 - kept[:, None] * turn)
        ahead = np.fft.irfft(np.fft.rfft(table, axis=0) * symbols[:, :, None], nx, axis=1)
        behind = np.roll(ahead[:, ::-1], 1, axis=1)
    else:
        table = surface_coefficients(grid, body, Load.NORMAL)
        # from the farthest offset ahead to the farthest behind, memory of what comes from ahead
        ahead, behind = (np.empty((len(sizes), nx, grid.shape[1])) for _ in range(2))
        memory, last = _memory_beyond(grid, table[-1], body, sizes), table[-1]
        for offset in range(nx - 1, -nx, -1):
            here = table[abs(offset)]
            if offset < nx - 1:
                memory = kept[:, None] * memory + after[:, None] * here + before[:, None] * last
            last = here
            if offset >= 0:
                ahead[:, offset] = memory
            if offset <= 0:
                behind[:, -offset] = memory
    even = 0.5 * np.tensordot(amounts, ahead + behind, axes=1) + (own + still) * table
    odd = -0.5 * np.tensordot(amounts * signs, ahead - behind, axes=1)
    return np.stack([even, odd])


def _memory_beyond(grid: Grid, far: FloatArray, body: Body, sizes: FloatArray) -> FloatArray:
    """Return the memory of what lies beyond the last coefficients ahead of a cell, (terms, ny) [m/Pa].

    Beyond, a cell acts as a point on a free grid. On one with a period along y it acts as a line load and its waves
    along y: the mean along y falls by the logarithm, wave n as K0(2 pi n x / period), the modified Bessel function.
    One cell along the period and many give the same mean.

    grid : free along x. far : (ny,), coefficients at the largest offset along x [m/Pa]. sizes : (terms, 1), lengths of
    memory [m].
    """
    (nx, ny), (dx, dy) = grid.shape, grid.spacing
    distance = (nx - 1) * dx
    if not grid.periodic[1]:
        s, measure = _nodes_beyond(distance, sizes)
        y = np.arange(ny) * dy
        fallen = np.hypot(distance, y) / np.hypot(distance + s[:, :, None], y)
        return np.asarray(far * np.einsum("tn,tny->ty", measure, fallen))
    from scipy.special import exp1, k0e

    ratio = distance / sizes
    short = ratio > 50
    kept = np.where(short, 1.0, ratio)
    fallen = np.where(short, 1 / ratio - 1 / ratio**2 + 2 / ratio**3, np.exp(kept) * exp1(kept))
    # displacement of a line load per length along y of one: the force of a cell over the period, under unit pressure
    amount = 2 * dx / ny / (np.pi * body.material.plane_strain_modulus)
    memory = far.mean() - amount * fallen + np.zeros(ny)
    highest = min(math.ceil(_FADED * grid.lengths[1] / (2 * np.pi * distance)), _WAVES * ny)
    for n in range(1, highest + 1):
        if n % ny:  # the others have no mean over a cell
            k = 2 * np.pi * n / grid.lengths[1]
            s, measure = _nodes_beyond(distance, sizes, k)
            wave = 2 * amount * np.sinc(n / ny) * np.cos(2 * np.pi * n * np.arange(ny) / ny)
            memory += np.sum(measure * k0e(k * (distance + s)) * np.exp(-k * (distance + s)), axis=1)[:, None] * wave
    return np.asarray(memory)


def _nodes_beyond(distance: float, sizes: FloatArray, decay: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """Return Gauss nodes s and weights of integrals of exp(-s / l) / l over s > 0, (terms, nodes).

    The integrand varies on the scale of `distance` + s [m] and falls at least as fast as exp(-`decay` s).
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    top = np.log1p(40 / (1 / sizes + decay) / distance)  # of the logarithm of 1 + s / distance
    s = distance * np.expm1(0.5 * top * (nodes + 1))
    return s, 0.5 * top * weights * (distance + s) * np.exp(-s / sizes) / sizes


def solve_steady_motion(
    gap: FloatArray,
    operator: DisplacementOperator,
    speeds: tuple[float, float],
    *,
    load: float | None = None,
    approach: float | None = None,
    tolerance: float = 1e-8,
    callback: Callable[[int, float], object] | None = None,
) -> SteadySolution:
    """Solve a contact through which the material of one or both bodies passes at constant speed along x.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap [m], which does not change in time: a body that passes is smooth along x.
    operator : from `displacement_operator`, of homogeneous bodies, at least one with a relaxation; no friction.
    speeds : (lower, upper), at which the material passes the contact, along +x [m/s]. An upper body that slides along
        +x over a resting lower one has (-speed, 0); one that rolls along +x has (-speed, -speed).
    load, approach : exactly one of the load [N] and the approach [m].
    tolerance : of the contact.
    callback : called with the number and the relative change of each proximal step, where there are any.

    Raises
    ------
    InputError : arguments out of range, one message for each; bodies that flow, which have no steady contact.
    """
    name = "solve_steady_motion"
    compliance = pair_compliance(operator, name)
    messages = []
    if len(speeds) != 2 or not all(is_finite(speed) for speed in speeds) or not any(speeds):
        messages.append(f"{name}: speeds {speeds!r} must be two finite numbers [m/s], not both zero")
    if compliance.flow > 0:
        messages.append(f"{name}: a body flows; only solids, with shares whose sum is below one, have a steady contact")
    if operator.grid.shape[0] < 2:
        messages.append(f"{name}: the grid has one cell along x, the direction of motion")
    if (load is None) == (approach is None):
        messages.append(f"{name}: give exactly one of load and approach")
    if messages:
        raise InputError(messages)
    before = operator.count.weighted
    kernel = _kernel(operator, compliance.terms, speeds)
    given: dict[str, Any] = {"load": load, "approach": approach}
    whole = _with(operator, kernel)
    contact = solve_contact(gap, whole, **given, tolerance=tolerance)
    if contact.status in {Status.STALLED, Status.MAX_ITERATIONS}:
        contact = _proximal(gap, operator, kernel, given, contact, tolerance, callback)
    force = float(np.sum(contact.pressure * _slope(gap, operator.grid))) * operator.grid.cell_area
    main = next(speed for speed in speeds if speed)
    force = -math.copysign(1.0, main) * force
    power = dissipated_power(contact.pressure, operator, compliance.terms, speeds)
    passing = [speed for speed in speeds if speed]
    imbalance = math.nan
    if len(set(passing)) == 1:
        scale = max(abs(force * main), abs(power))
        imbalance = abs(force * abs(main) - power) / scale if scale > 0 else 0.0
    return SteadySolution(
        contact=contact,
        friction_force=force,
        friction=force / contact.load if contact.load > 0 else 0.0,
        dissipated_power=power,
        imbalance=imbalance,
        convolutions=operator.count.weighted - before,
        status=contact.status,
    )


def _kernel(operator: DisplacementOperator, terms: Sequence[DelayedTerm], speeds: tuple[float, float]) -> DelayedKernel:
    """Return the kernel of the bodies in motion."""
    return DelayedKernel(
        operator.bodies,
        1.0,
        tuple(term.amount for term in terms),
        tuple(term.time * speeds[term.body] for term in terms),
    )


def _with(
    operator: DisplacementOperator, kernel: Callable[[Grid], KernelSpectra], grid: Grid | None = None
) -> DisplacementOperator:
    """Return an operator of the same bodies with other spectra, on its grid or another one; it shares the count."""
    return DisplacementOperator(
        grid or operator.grid, operator.bodies, count=operator.count, weight=operator.weight, spectra_on=kernel
    )


def _proximal(
    gap: FloatArray,
    operator: DisplacementOperator,
    kernel: DelayedKernel,
    given: dict[str, Any],
    found: ContactSolution,
    tolerance: float,
    callback: Callable[[int, float], object] | None,
) -> ContactSolution:
    """Return the contact by proximal steps; the whole operator is tried whenever they have come much closer."""
    bounded, added = (_with(operator, _Bounded(kernel, added)) for added in (False, True))
    whole = _with(operator, kernel)
    pressure, tried = found.pressure, math.inf
    for number in range(_PROXIMAL_STEPS):
        inner = solve_contact(
            gap - added(pressure),
            bounded,
            **given,
            tolerance=min(0.1 * tolerance, 1e-9) if tried < math.inf else 1e-6,
            initial_pressure=pressure,
        )
        size = float(inner.pressure.max())
        change = float(np.max(np.abs(inner.pressure - pressure))) / size if size > 0 else 0.0
        pressure = inner.pressure
        if callback is not None:
            callback(number + 1, change)
        if change <= min(_CLOSE, 0.1 * tried):
            tried = max(change, 1e-12)
            last = solve_contact(gap, whole, **given, tolerance=tolerance, initial_pressure=pressure)
            if last.status is Status.CONVERGED:
                return last
            if last.residual < found.residual:
                found = last
    return found


def _slope(gap: FloatArray, grid: Grid) -> FloatArray:
    """Return the slope of a gap along x by central differences, across the period on a periodic axis."""
    step = grid.spacing[0]
    if grid.periodic[0]:
        return np.asarray((np.roll(gap, -1, axis=0) - np.roll(gap, 1, axis=0)) / (2 * step))
    return np.asarray(np.gradient(gap, step, axis=0))
