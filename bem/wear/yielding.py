"""Yielded pieces: equivalent stress from the surface down to a depth without yield, and the pieces above it.

"At the surface" means at the first computed depth, whose stress counts for all material above it (`depths_for`): the
skin depth of the criterion (100 nm by default), half of a layer thinner than two skins, or the first depth of the setup
where that is deeper. No piece is thinner than the first computed depth.

1. A bound on von Mises stress without a transform may prove that nothing yields at the first depth (`cannot_yield`).
2. Compute the equivalent stress depth by depth. `yielded_stress` computes whole planes, down to one below the first
   depth whose plane has no yield. `piece_stress`, for von Mises stress of one load of
   friction x pressure without residual stress, follows pieces from the first depth by rows
   (`bem.stress.connected_regions`), down to two depths below the deepest row that they reach (one below with linear
   refinement); yield that is not connected to the surface is left out.
3. Segment it (`bem.wear.segmentation`).

Cost: along x five transforms per depth for von Mises stress, along y as many for the rows that are computed; six for
other stresses.

Knows stresses and pieces; no contact, no cycle. Verified in tests/wear/test_cycle.py: skipped depths have no pieces.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from bem.errors import InputError
from bem.grid import FloatArray
from bem.materials import Body
from bem.stress import clear_other_rows, connected_stress, subsurface_stress, von_mises_planes, von_mises_upper_bound
from bem.wear.loads import BodyWear, SurfaceLoad
from bem.wear.removal import RemovalLaw
from bem.wear.segmentation import Segmentation, refine_depths, segment
from bem.wear.setup import WearChoices, WearSetup


@runtime_checkable
class EquivalentStressLaw(Protocol):
    """A criterion that compares one equivalent stress with the yield stress (`bem.wear.criterion.StressCriterion`)."""

    @property
    def skin_depth(self) -> float:
        """Depth above which the stress counts as that at this depth [m]."""

    @property
    def is_von_mises(self) -> bool:
        """True if the equivalent stress is that of von Mises."""

    @property
    def von_mises_factor(self) -> float | None:
        """Largest ratio to von Mises' stress; None where there is none."""

    def equivalent_stress(self, stress: FloatArray) -> FloatArray:
        """Return the equivalent stress (...) of stresses (6, ...) [Pa]."""


def equivalent_stress_planes(
    loads: Sequence[SurfaceLoad],
    setup: WearSetup,
    body: int,
    depths: FloatArray,
    criterion: EquivalentStressLaw,
    out: FloatArray,
) -> Iterator[FloatArray]:
    """Yield the equivalent stress of all loads together in one body, depth by depth.

    Each plane of `out` (nz, nx, ny) [Pa] is computed when the iteration reaches it.
    """
    grid, solid = setup.grid, setup.bodies[body]
    if criterion.is_von_mises and len(loads) == 1:
        (load,) = loads
        yield from von_mises_planes(load.pressure, grid, solid, depths, **load.shear(body), out=out)
        return
    solids = _residual_once(solid, loads)
    for index, depth in enumerate(depths):
        stress = sum(
            subsurface_stress(load.pressure, grid, one, depth[None], **load.shear(body))[:, 0]
            for load, one in zip(loads, solids, strict=True)
        )
        out[index] = criterion.equivalent_stress(np.asarray(stress))
        yield out[index]


def largest_stress(load: SurfaceLoad, setup: WearSetup, model: WearChoices, body: int) -> float:
    """Return the largest equivalent stress of one body at any of the depths [Pa].

    A loop without particles reports it beside the strength. Orders of magnitude: under a line contact the surface is in
    tension by friction alone, 2 f p0 at the trailing edge (McEwen 1949); under a round one by (1 - 2 nu) p0 / 3 on its
    edge (Johnson 1985, section 3.4) and by pi (4 + nu) f p0 / 8 at the trailing edge (Hamilton and Goodman 1966). A
    thin layer stretches with its substrate, so these scale with the ratio of the plane moduli E / (1 - nu^2).
    """
    law = model.criterion_law
    assert isinstance(law, EquivalentStressLaw)
    depths, plane = depths_for(setup, model, body), np.empty((1, *setup.grid.shape))
    return max(
        float(each.max())
        for depth in depths
        for each in equivalent_stress_planes((load,), setup, body, depth[None], law, plane)
    )


def cannot_yield(
    loads: Sequence[SurfaceLoad], setup: WearSetup, body: int, depth: float, criterion: EquivalentStressLaw
) -> bool:
    """Return True if a bound without a transform proves that nothing yields at a depth [m].

    Von Mises stress is a norm of the deviator, so that of several loads together is at most the sum of theirs. There is
    no bound for tractions other than friction x pressure.
    """
    factor = criterion.von_mises_factor
    if factor is None or any(load.traction is not None for load in loads):
        return False
    grid, solids = setup.grid, _residual_once(setup.bodies[body], loads)
    limit = sum(
        von_mises_upper_bound(load.pressure, grid, one, [depth], **load.shear(body))[0]
        for load, one in zip(loads, solids, strict=True)
    )
    return bool(factor * limit <= setup.yield_stress(body))


def _residual_once(solid: Body, loads: Sequence[SurfaceLoad]) -> list[Body]:
    """Return the body of each of several loads whose stresses are added: residual stresses count once."""
    return [solid, *[solid.without_residual_stress()] * (len(loads) - 1)]


def depths_for(setup: WearSetup, model: WearChoices, body: int) -> FloatArray:
    """Return the depths at which stress is computed (nz,) [m].

    These are the setup's depths from the criterion's skin depth down to the outermost interface, refined where the
    refinement is exact. Segmentation counts the stress above the first depth as that at the first depth. In a layer
    that is thinner than two skins, the skin is half of the layer.
    """
    depths = _usable_depths(setup, model, body)
    if model.refinement == "exact":
        depths = refine_depths(depths, model.refine)
    return depths


def check_usable_depths(setup: WearSetup, model: WearChoices, body: int) -> None:
    """Raise InputError unless skin and layer leave at least two depths at which stress is computed in a body."""
    depths = _usable_depths(setup, model, body)
    if depths.size >= 2:
        return
    interface = _layer_thickness(setup, model, body)
    if interface is not None:
        raise InputError(
            f"depths: the layer of {interface:g} m leaves one depth, its interface, and pieces need two; give a first "
            f"depth of at most {0.5 * interface:g} m, or turn off within_layer"
        )
    skin = _skin_depth(model)
    raise InputError(
        f"depths: skin_depth {skin:g} m leaves one depth, the skin itself, and pieces need two; give a depth below "
        f"{skin + _smallest_interval(setup):g} m or a thinner skin"
    )


def _usable_depths(setup: WearSetup, model: WearChoices, body: int) -> FloatArray:
    """Return the depths (nz,) [m] that skin and outermost interface leave, with both."""
    interface, skin, smallest = _layer_thickness(setup, model, body), _skin_depth(model), _smallest_interval(setup)
    if interface is None:
        return _below_skin(setup.depths, skin, smallest)
    smallest = min(smallest, 0.1 * interface)
    depths = _below_skin(setup.depths, min(skin, 0.5 * interface), smallest)
    return np.append(depths[depths < interface - smallest], interface)


def _layer_thickness(setup: WearSetup, model: WearChoices, body: int) -> float | None:
    """Return the depth of the interface at which pieces of a body end [m]; None where no interface ends them."""
    interfaces = setup.bodies[body].interfaces
    return float(interfaces[0]) if interfaces and model.within_layer else None


def _skin_depth(model: WearChoices) -> float:
    return float(model.criterion_law.skin_depth) if isinstance(model.criterion_law, EquivalentStressLaw) else 0.0


def _smallest_interval(setup: WearSetup) -> float:
    """Return a tenth of the smallest interval [m]; depths closer than that to the skin or to the interface are
    dropped. In a layer the limit is at most a tenth of the layer, so that coarse depths leave skin and interface."""
    return 0.1 * float(np.diff(setup.depths).min())


def _below_skin(depths: FloatArray, skin: float, sliver: float) -> FloatArray:
    """Return the depths from the skin downwards; the skin depth comes first unless the first depth lies below it."""
    if depths[0] >= skin:
        return depths
    return np.append(skin, depths[depths > skin + sliver])


@dataclass(frozen=True, eq=False)
class YieldedStress:
    """Equivalent stress from the surface down, as far as pieces can reach.

    planes : (nz, nx, ny) [Pa]. depths : (nz,) [m]; empty where nothing yields at the first computed depth.
    computed : number of depths computed. seconds : spent.
    yielding : (nx, ny) True where the column yields at any depth that was computed there; None where unknown.
    rows : (nz, nx) True for rows of the planes that were written; None for all.
    """

    planes: FloatArray
    depths: FloatArray
    computed: int
    seconds: float
    yielding: NDArray[np.bool_] | None = None
    rows: NDArray[np.bool_] | None = None

    @cached_property
    def stress(self) -> FloatArray:
        """Planes, with zeros in rows that no piece reaches."""
        return self.planes if self.rows is None else clear_other_rows(self.planes, self.rows)


def yielded_stress(
    load: FloatArray | Sequence[SurfaceLoad], setup: WearSetup, model: WearChoices, body: int
) -> YieldedStress:
    """Compute the equivalent stress of one body under a pressure with the setup's friction, or under loads.

    Depths are computed from the skin depth down, no further than one below the first depth at which nothing yields: a
    piece reaches the surface, so it would have to pass that depth, and refinement never exceeds the values that it lies
    between. The one below gives the slope of the monotone cubic; other refinements do not need it.
    """
    start = time.perf_counter()
    loads = (SurfaceLoad(load, setup.friction),) if isinstance(load, np.ndarray) else load
    law = model.criterion_law
    assert isinstance(law, EquivalentStressLaw)
    strength = setup.yield_stress(body)
    depths = depths_for(setup, model, body)
    below = 1 if model.refinement == "monotone_cubic" else 0
    computed = 0
    blocked: int | None = None
    if cannot_yield(loads, setup, body, float(depths[0]), law):
        blocked = 0
        stack = np.empty((0, *setup.grid.shape))
    else:
        # pages of planes that are never written are never touched
        stack = np.empty((depths.size, *setup.grid.shape))
        for plane in equivalent_stress_planes(loads, setup, body, depths, law, stack):
            computed += 1
            if blocked is None and plane.max() <= strength:
                blocked = computed - 1
            if blocked is not None and (blocked == 0 or computed == blocked + 1 + below):
                break
    used = 0 if blocked == 0 else computed
    return YieldedStress(stack[:used], depths[:used], computed, time.perf_counter() - start)


def piece_stress(
    load: FloatArray | Sequence[SurfaceLoad], setup: WearSetup, model: WearChoices, body: int
) -> YieldedStress:
    """Compute the stress in the rows that a piece reaches; where that is not possible, as `yielded_stress`.

    It is possible for von Mises stress of one load of friction x pressure, if pieces leave from the surface down (with
    a residual stress whole planes are computed all the same): a piece is followed from depth
    to depth and row to row, also upwards (`bem.stress.connected_regions`), since yield between depths needs a depth
    beside it that yields. The monotone cubic in an interval needs values two depths from the end that yields. The
    search ends where no further row is reached, without a test of whole planes: there may be yield below.
    """
    loads = (SurfaceLoad(load, setup.friction),) if isinstance(load, np.ndarray) else load
    law, removal, (first, *others) = model.criterion_law, model.removal, loads
    assert isinstance(removal, RemovalLaw)
    assert isinstance(law, EquivalentStressLaw)
    if not law.is_von_mises or others or first.traction is not None or not removal.follows_pieces:
        return yielded_stress(loads, setup, model, body)
    start = time.perf_counter()
    depths, strength = depths_for(setup, model, body), setup.yield_stress(body)
    none, grid = np.empty((0, *setup.grid.shape)), setup.grid
    if cannot_yield(loads, setup, body, float(depths[0]), law):
        return YieldedStress(none, depths[:0], 0, time.perf_counter() - start)
    reach = 2 if model.refinement == "monotone_cubic" else 1
    solid, shear = setup.bodies[body], first.shear(body)
    reached = connected_stress(first.pressure, grid, solid, depths, strength, depths_beside=reach, **shear)
    found, rows = reached.planes, reached.computed
    used = len(found) if len(found) > 1 else 0  # nothing yields at the first depth where it is the only one
    seconds = time.perf_counter() - start
    return YieldedStress(found[:used], depths[:used], len(found), seconds, reached.exceeding, rows[:used])


def yielded_pieces(
    load: FloatArray | Sequence[SurfaceLoad], setup: WearSetup, model: WearChoices, body: int
) -> BodyWear:
    """Return the pieces that come off one body where its stress exceeds yield; arguments as in `yielded_stress`."""
    found = piece_stress(load, setup, model, body)
    start = time.perf_counter()
    strength, where = setup.yield_stress(body), (found.yielding, found.rows)
    pieces = pieces_above(found.planes, found.depths, strength, setup, model, *where)
    return BodyWear(body, pieces, found.computed, found.seconds, time.perf_counter() - start)


def pieces_above(
    stack: FloatArray,
    depths: FloatArray,
    limit: float,
    setup: WearSetup,
    model: WearChoices,
    exceeding: NDArray[np.bool_] | None = None,
    rows: NDArray[np.bool_] | None = None,
) -> Segmentation:
    """Return the pieces in which a stack (nz, nx, ny), refined as the model says, exceeds a limit.

    exceeding : (nx, ny) True where the column exceeds the limit anywhere; None searches the stack. rows : (nz, nx) True
    for rows that count, only with `exceeding`; the other rows count as zero.
    """
    if len(depths) == 0:
        return no_pieces(setup.grid.shape)
    exact = model.refinement == "exact"
    columns = None if exceeding is None else np.flatnonzero(exceeding)
    return segment(
        stack,
        depths,
        yield_stress=limit,
        periodic=setup.grid.periodic,
        refine=1 if exact else model.refine,
        refinement="linear" if exact else model.refinement,
        connectivity=model.connectivity,
        removal=model.removal,
        columns=columns,
        rows=rows,
    )


def no_pieces(shape: tuple[int, int]) -> Segmentation:
    """Return a segmentation without pieces."""
    return Segmentation(np.zeros(shape, np.int32), np.zeros(shape), 0, np.zeros(1, dtype=np.bool_))
