"""Checks of the results: what only the solution tells."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.grid import Grid
from bem.notes import Level, Note
from bem.notes.checks import (
    ABOVE_HARDNESS,
    DEPTHS_MISS_STRESS,
    HARDNESS_DECIDES,
    NOTHING_CAME_OFF,
    PARTICLES_CUT,
    PARTICLES_OF_MESH,
    PRESSURE_AT_SEAM,
    STRAIN_LARGE,
    YIELDS,
)
from bem.notes.contact import CONTACT_AT_EDGE, FEW_SPOTS, ROLLING_UNRESOLVED
from bem.notes.note import joined
from bem.quantities import si
from bem.scenes.build import AnySurface
from bem.scenes.checks.contact import hertz_pressure_above_hardness, yield_below_the_surface
from bem.scenes.checks.facts import Case, Facts
from bem.scenes.checks.operation import pure_rolling
from bem.scenes.checks.registry import outcome_check
from bem.scenes.checks.roughened import roughened
from bem.scenes.checks.words import numbers, times
from bem.scenes.common import MeasuredSurface
from bem.scenes.context import Outcome
from bem.scenes.cut_off import LARGER_GRID, edge_share, is_cut_off, larger_grid
from bem.scenes.maps import map_on, map_size

_AT_EDGE = 1e-4
_AT_CAP = 0.1
_CONTACT = 0.5
_WIDE = 0.5
_MOST = 0.5
"""Fraction of the load beyond which a contact is not the bodies' own."""
_DRY = ("contact", "partial-slip", "rolling", "surface-temperature")
"""Kinds of dry contacts, elastic where no cap is set."""


def _pressures(outcome: Outcome) -> list[NDArray[np.float64]]:
    """The maps of contact pressure that a run kept."""
    found = []
    for name in ("pressure", "film_pressure"):
        variable = outcome.variables.get(name)
        if variable is not None and variable.dimensions[-2:] == ("x", "y"):
            found.append(np.asarray(variable.values, dtype=np.float64).reshape(-1, *variable.values.shape[-2:]))
    return found


def _capped(facts: Facts, outcome: Outcome) -> Case | None:
    """The contact whose pressures are shown, where it has a cap and one only."""
    caps = {case.cap for case in facts.cases}
    return facts.cases[0] if len(caps) == 1 and None not in caps else None


@outcome_check
def contact_at_free_edges(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A contact that reaches a free edge of its grid ends there because the grid does.

    Of a body that is curved along that axis the edge cuts off a part of the contact: the result is outside the model.

    Of kind `contact` the solver says so itself; here it is read off the maps that the other kinds keep.
    """
    if facts.of_kind("contact"):
        return
    grids = {case.grid.periodic for case in facts.cases if case.grid is not None}
    if len(grids) != 1:
        return
    free = [axis for axis, wraps in enumerate(grids.pop()) if not wraps]
    curved = [
        axis for axis in free if any(one.smooth and math.isfinite(one.smooth.semi_axes[axis]) for one in facts.cases)
    ]
    for maps in _pressures(outcome):
        for plane in maps:
            shares = {axis: edge_share(plane, axis) for axis in free if plane.shape[axis] > 2}
            touched = [axis for axis, share in shares.items() if share > _AT_EDGE]
            if touched:
                beyond = is_cut_off(plane, [axis for axis in curved if axis in touched])
                axes, share = joined(["xy"[axis] for axis in touched]), max(shares.values())
                if beyond:
                    yield CONTACT_AT_EDGE(axes=axes, share=share, action=_remedy(facts, touched), reason="cut-off")
                else:
                    yield CONTACT_AT_EDGE(axes=axes, share=share, reason="share")
                return


def _remedy(facts: Facts, axes: Sequence[int]) -> str:
    """Return what to do about a contact that the edge cuts off along axes: of its largest case."""
    found = [
        larger_grid(facts.scene, case.grid, case.smooth.semi_axes, axes)
        for case in sorted(facts.cases, key=lambda case: case.load or 0.0)
        if case.grid is not None and case.smooth is not None
    ]
    return found[-1] if found else LARGER_GRID


@outcome_check
def highest_pressure_at_a_seam(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A mirrored map is symmetric about its seams: a slope there becomes a ridge that no instrument has seen.

    The load beside a seam is compared with its area. Under a hardness many cells have the highest pressure, whose place
    says nothing.
    """
    for case in facts.cases[:1]:
        mirrors = {getattr(table, "mirror", "none") for table in case.surfaces.values()}
        axes = [axis for axis, name in enumerate("xy") if mirrors & {name, "both"}]
        for maps in _pressures(outcome) if axes else ():
            plane = maps[-1]
            if not plane.max() > 0:
                continue
            loaded = [(*found, axis) for axis in axes if (found := _load_at_a_seam(plane, axis)) is not None]
            if loaded:
                load, area, cells, axis = max(loaded)
                width = cells * case.grid.spacing[axis] if case.grid is not None else 0.0
                yield PRESSURE_AT_SEAM(
                    axes="xy"[axis],
                    load=load,
                    area=area,
                    width=width,
                    action=_instead_of_mirrors(case),
                    reason="load",
                )
                continue
            place = np.unravel_index(int(plane.argmax()), plane.shape)
            beside = ["xy"[axis] for axis in axes if _from_seam(int(place[axis]), plane.shape[axis]) == 0]
            if beside and case.cap is None:
                yield PRESSURE_AT_SEAM(axes=joined(beside), action=_instead_of_mirrors(case), reason="highest")


_SEAM_WIDTH = 1 / 40
"""Half-width of the strip beside a seam over the length of the map that is mirrored."""
_SEAM_LOAD, _SEAM_EXCESS = 3.0, 0.05
"""Load share of a strip over its area share, and excess of the load share, from which a seam is a ridge: of some ten
contact spots one more or less at a seam is chance."""


def _load_at_a_seam(plane: NDArray[np.float64], axis: int) -> tuple[float, float, int] | None:
    """Return load share, area share and half-width in cells of the strip about the seam of an axis that carries more
    than its part of the load; None where neither does. The seams are in the middle and where the axis wraps."""
    load = plane.sum(axis=1 - axis) / plane.sum()
    n = len(load)
    half = max(1, round(_SEAM_WIDTH * n / 2))
    strips = [float(np.roll(load, half - seam)[: 2 * half].sum()) for seam in (0, n // 2)]
    share, area = max(strips), 2 * half / n
    return (share, area, half) if share > max(_SEAM_LOAD * area, area + _SEAM_EXCESS) else None


def _instead_of_mirrors(case: Case) -> str:
    """Return what to do about ridges of mirrored maps: no mirror where maps cover the grid and close well."""
    if case.grid is not None and all(_closes_well(table, case.grid) for table in case.surfaces.values()):
        return "Leave mirror out; the seams are then closed without ridges."
    return "Crop the upturned edge, remove long waves with high_pass in the mirrored surfaces, or measure larger maps."


def _closes_well(table: AnySurface, grid: Grid) -> bool:
    """Return True if a surface covers the grid without mirrors and closing its seams alters it little."""
    if not isinstance(table, MeasuredSurface) or table.mirror == "none":
        return True
    plain = table.model_copy(update={"mirror": "none"})
    shape, spacing = map_size(plain)
    if any(n * d < side * (1 - 1e-9) for n, d, side in zip(shape, spacing, grid.lengths, strict=True)):
        return False
    return not map_on(plain, grid).seams_alter_it


def _from_seam(index: int, cells: int) -> int:
    """Cells between a cell and the nearest seam of an axis that is mirrored at its middle and wraps."""
    half = cells // 2
    return min(index % half, half - 1 - index % half) if half else 0


FEWEST_SPOTS = 30
"""Number of contact spots below which figures of another place of the surface differ by more than a tenth."""
_SCATTER = 0.5
"""Scatter of the contact area from place to place, times sqrt(spots): 0.31 to 0.52 of 32 Gaussian maps each with 4 to
30 spots, capped at the hardness of a hard steel."""


def scatter_of_places(spots: float) -> float:
    """Return the relative scatter of the contact area from place to place of a surface with so many contact spots."""
    return _SCATTER / math.sqrt(spots)


@outcome_check
def few_contact_spots(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Error bars are those of the cells. Another place of the same surface has other summits, and few of them touch."""
    spots = outcome.summary.get("contact_spots_of_map", outcome.summary.get("contact_spots"))
    known = [value for value in numbers(spots) if value > 0]
    if not facts.of_kind("contact") or not known or not facts.surfaces or facts.scene.shape.kind != "flat":
        return
    fewest = min(known)
    if fewest < FEWEST_SPOTS:
        yield FEW_SPOTS(spots=int(fewest), scatter=scatter_of_places(fewest))


@outcome_check
def elastic_pressure_above_hardness(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Elastic summits carry any pressure; real ones flow at the hardness of the softer body. Where that is most of the
    load, the contact is not one that these bodies have."""
    case, maps = facts.cases[0], _pressures(outcome)
    if not facts.of_kind(*_DRY) or not maps or case.cap is not None or case.softest is None:
        return
    plane, hardness = maps[-1][-1], case.softest
    highest, share = float(plane.max()), _share_above(plane, hardness)
    beyond = share > _MOST
    if highest > hardness and (beyond or not list(hertz_pressure_above_hardness(facts))):
        level = Level.OUTSIDE_MODEL if beyond else None
        how = 'take behaviour = "capped"' if facts.of_kind("contact") else "take a smaller load"
        highest = _highest_of_table(outcome, highest)
        yield ABOVE_HARDNESS(
            level=level, pressure=highest, ratio=highest / hardness, share=share, action=how, reason="solved"
        )


@outcome_check
def pressure_beyond_linear_elasticity(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Strain under a contact is about p (1 - nu^2) / E of each body: 0.2 of the contact modulus is no small strain.

    Attraction of the bodies acts at the same place as their pressure and strains them against it.
    """
    case, maps = facts.cases[0], _pressures(outcome)
    if not facts.of_kind(*_DRY) or not maps:
        return
    from bem.materials import contact_modulus

    modulus = contact_modulus(case.lower.material, None if case.upper is None else case.upper.material)
    attraction, limit = outcome.variables.get("attraction"), 0.2 * modulus
    plane = maps[-1][-1]
    if attraction is not None:
        plane = np.abs(plane - np.asarray(attraction.values).reshape(-1, *plane.shape)[-1])
    highest, share = float(plane.max()), _share_above(plane, limit)
    if highest > limit and (share > _MOST or not (case.smooth is not None and case.smooth.ratio > 0.2)):
        level = Level.OUTSIDE_MODEL if share > _MOST else None
        reason = "pressure" if attraction is None else "adhesive"
        highest = _highest_of_table(outcome, highest) if attraction is None else highest
        yield STRAIN_LARGE(level=level, pressure=highest, ratio=highest / modulus, share=share, reason=reason)


def _highest_of_table(outcome: Outcome, on_cells: float) -> float:
    """Return the highest pressure of a run [Pa] as its table gives it, between cells; without one that of the cells."""
    found = numbers(outcome.summary.get("max_pressure_Pa"))
    return max(found[0], on_cells) if len(found) == 1 else on_cells


def _share_above(pressure: NDArray[np.float64], limit: float) -> float:
    """Return the share of the load on cells above a pressure."""
    total = float(pressure.sum())
    return float(pressure[pressure > limit].sum()) / total if total > 0 else 0.0


@outcome_check
def contact_at_the_cap(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Note that the pressure is the cap, an input and not a result, on at least a tenth of the contact."""
    found = at_the_cap(facts, outcome)
    if found is not None and not roughened(facts, outcome).grown:  # which says it too
        area = _area_at_the_cap(outcome, found)
        load = found.load_share if area is None else area[1]
        reason = "area-is-load" if load > _PLASTIC else "reached"
        if area is None:
            yield HARDNESS_DECIDES(cells=found.cell_share, load=load, cap=found.cap, reason=reason)
        else:
            yield HARDNESS_DECIDES(
                area=area[0],
                load=load,
                cells=found.cell_share,
                cells_load=found.load_share,
                cap=found.cap,
                reason=f"{reason}-of-area",
            )


def _area_at_the_cap(outcome: Outcome, found: CappedCells) -> tuple[float, float] | None:
    """Return the shares of contact area and load at the hardness by the areas of the table, whose edges lie between
    cells; None where the table has none."""
    plastic, area = (numbers(outcome.summary.get(name)) for name in ("plastic_area_fraction", "contact_area_fraction"))
    if not plastic or len(plastic) != len(area) or not area[-1] > 0 or not found.mean_pressure > 0:
        return None
    return min(plastic[-1] / area[-1], 1.0), min(plastic[-1] * found.cap / found.mean_pressure, 1.0)


_PLASTIC = 0.8
"""Share of the load on cells at the hardness from which the contact area is that of load over hardness, within 25 %."""


@dataclass(frozen=True)
class CappedCells:
    """Cells of a contact whose pressure is the hardness.

    Attributes
    ----------
    cell_share : their number over that of the cells in contact.
    load_share : share of the load that they carry.
    cap : the hardness [Pa].
    mean_pressure : load over the area of the grid [Pa].
    """

    cell_share: float
    load_share: float
    cap: float
    mean_pressure: float


def at_the_cap(facts: Facts, outcome: Outcome) -> CappedCells | None:
    """Return the cells at the hardness; None where they are fewer than a tenth of the cells in contact.

    Both shares are of the same cells. The figures of areas are not: their edges lie between cells, which are touched in
    part and carry less than the hardness.
    """
    case = _capped(facts, outcome)
    if case is None or case.cap is None or not facts.of_kind("contact", "wear", "running-in"):
        return None
    for maps in _pressures(outcome)[:1]:
        plane = maps[-1]
        touching, capped = np.count_nonzero(plane > 0), plane >= case.cap * (1 - 1e-9)
        if touching and np.count_nonzero(capped) > _AT_CAP * touching:
            share = np.count_nonzero(capped) / touching
            return CappedCells(share, float(plane[capped].sum() / plane.sum()), case.cap, float(plane.mean()))
    return None


@outcome_check
def cap_within_the_error_of_the_pressure(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Two grids on which nothing reaches the hardness give its area no error, which finer cells may have."""
    case, told = _capped(facts, outcome), outcome.summary
    plastic = numbers(told.get("plastic_area_fraction"))
    highest, errors = (numbers(told.get(f"max_pressure_Pa{end}")) for end in ("", "_error"))
    if case is None or case.cap is None or not len(plastic) == len(highest) == len(errors):
        return
    if any(p == 0 and h < case.cap < h + e for p, h, e in zip(plastic, highest, errors, strict=True)):
        yield HARDNESS_DECIDES(cap=case.cap, reason="within-error")


@outcome_check
def capped_contact_nearly_full(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Flow at a constant pressure needs room beside the spots; real roughness persists beyond half contact (Johnson
    13.4)."""
    fraction = outcome.summary.get("contact_area_fraction")
    if not facts.of_kind("contact", "wear", "running-in", "friction") or fraction is None:
        return
    largest = max(numbers(fraction), default=0.0)
    if largest > _CONTACT and all(case.cap for case in facts.cases) and _anything_at_the_cap(facts, outcome):
        yield HARDNESS_DECIDES(share=largest, reason="area")


def _anything_at_the_cap(facts: Facts, outcome: Outcome) -> bool:
    """Return True if any pressure is at the hardness, as far as the results tell; without figure, area and map it may
    be."""
    found = outcome.summary.get("plastic_area_fraction")
    if facts.of_kind("contact") or found is not None:
        return max(numbers(found), default=0.0) > 0
    area, maps = outcome.variables.get("plastic_area"), _pressures(outcome)[:1]
    if area is not None:
        return bool((area.values > 0).any())
    caps = [case.cap for case in facts.cases if case.cap is not None]
    return not maps or bool((maps[0] >= min(caps) * (1 - 1e-9)).any())


@outcome_check
def largest_stress_at_the_deepest_depth(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A largest stress in the last row of depths is not the largest."""
    depth = outcome.variables.get("depth")
    found = outcome.summary.get("max_von_mises_depth_m")
    if depth is not None and found is not None and len(depth.values) > 1 and found >= float(depth.values[-1]):
        yield DEPTHS_MISS_STRESS(depth=found, reason="deepest")


@outcome_check
def elastic_stress_above_yield(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Without a cap stresses are elastic throughout; where they exceed the yield stress they are too high."""
    volume, highest = outcome.summary.get("yielded_volume_m3"), outcome.summary.get("max_von_mises_Pa")
    if not volume or highest is None or facts.cases[0].cap is not None:
        return
    names, ratios = outcome.summary.get("layer_material"), outcome.summary.get("layer_yield_ratio")
    if names and ratios:
        beneath = (_below_the_coating(facts), outcome.summary.get("substrate_yield_ratio"))
        found = [(n, r) for n, r in (*zip(names, ratios, strict=True), beneath) if r is not None and math.isfinite(r)]
        first, ratio = max(found, key=lambda one: one[1], default=("", 0.0))
        if ratio > 1:
            listed = ", ".join(f"{value:.2g} in {name}" for name, value in found)
            yield YIELDS(first=first, ratios=listed, reason="layers")
        return
    if not (list(yield_below_the_surface(facts)) or list(hertz_pressure_above_hardness(facts))):
        yield YIELDS(stress=highest, volume=volume * 1e18, reason="solved")


@outcome_check
def rolling_of_large_errors(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """Figures of rolling whose error bars are half of them and more are not resolved."""
    if not facts.of_kind("rolling"):
        return
    large, stick = {}, numbers(outcome.summary.get("stick_fraction"))
    for name in ("traction_coefficient", "friction_work_N"):
        values, errors = (numbers(outcome.summary.get(key)) for key in (name, f"{name}_error"))
        ratios = [e / abs(v) for v, e in zip(values, errors, strict=False) if v != 0 and math.isfinite(e)]
        if ratios and max(ratios) > _LARGE_ERROR:
            large[name] = max(ratios)
    if large:
        name = max(large, key=lambda key: large[key])
        words = {"traction_coefficient": "the force", "friction_work_N": "the friction work"}[name]
        slips = name == "traction_coefficient" and bool(stick) and max(stick) < _LITTLE_STICKS
        reason, share = ("slips", max(stick)) if slips else ("sticks", None)
        yield ROLLING_UNRESOLVED(figure=words, error=100 * large[name], stick=share, reason=reason)


_LITTLE_STICKS = 0.1
"""Share of a rolling contact that sticks, below which a force that is small is a difference of opposite tractions."""
_LARGE_ERROR = 0.5
"""Relative error bar from which a figure is an order of magnitude only."""


def _below_the_coating(facts: Facts) -> str:
    """Return the material below the layers of the stressed body in words."""
    return f"{facts.scene.stressed()[0].material.name} below the coating"


@outcome_check
def particles_of_one_cell(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A particle cannot be smaller than a cell: where most are one, their mean size is the mesh's."""
    if "particle_length" in outcome.variables:
        yield from _counted(facts, outcome)
        return
    radius = outcome.summary.get("number_mean_radius_nm")
    if radius is None or not facts.of_kind("running-in") or facts.cases[0].grid is None:
        return
    cell = 1e9 * max(facts.cases[0].grid.spacing)
    # two cells as deep as wide have an equivalent radius of 0.78 of a cell
    small = [value for value in numbers(radius) if 0 < value < 0.78 * cell]
    if small:
        yield PARTICLES_OF_MESH(
            cell=1e-9 * cell,
            few=len(small),
            all=len(numbers(radius)),
            least="smallest " if min(small) < max(small) else "",
            radius=1e-9 * min(small),
            reason="mean",
        )


def _counted(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    length, width, volume = (outcome.variables[f"particle_{name}"].values for name in ("length", "width", "volume"))
    grids = _grids_of_particles(facts, outcome)
    if not grids:
        return
    spacings = np.array([grid.spacing for grid in grids])
    one = (length < 1.5 * spacings.max(axis=1)) & (width < 1.5 * spacings.min(axis=1))
    if one.mean() > 0.5:
        cell = min((grid.spacing for grid in grids), key=math.prod)
        share = float(volume[one].sum() / volume.sum())
        yield PARTICLES_OF_MESH(share=float(one.mean()), volume=share, cell=times(cell, "m"), reason="one-cell")


def _grids_of_particles(facts: Facts, outcome: Outcome) -> list[Grid]:
    """The grid of each particle's case, known by the size of its cells; empty where none or no cells are known."""
    length, cell = (outcome.variables.get(name) for name in ("particle_length", "cell"))
    grids = [case.grid for case in facts.cases if case.grid is not None]
    if length is None or cell is None or not length.values.size or not grids:
        return []
    sizes = np.sqrt([grid.cell_area for grid in grids])
    nearest = np.abs(np.asarray(cell.values, dtype=np.float64).reshape(-1, 1) / sizes - 1).argmin(axis=1)
    of = outcome.variables.get("particle_case")
    cases = np.zeros(length.values.size, dtype=int) if of is None else np.asarray(of.values, dtype=int)
    return [grids[nearest[case]] for case in cases]


@outcome_check
def particles_as_large_as_the_grid(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A piece that fills the slice says nothing of its size."""
    grids = _grids_of_particles(facts, outcome)
    if not grids:
        return
    lengths = outcome.variables["particle_length"].values
    largest, side = max(
        zip(lengths, (min(grid.lengths) for grid in grids), strict=True), key=lambda pair: pair[0] / pair[1]
    )
    if largest > _WIDE * side:
        yield PARTICLES_CUT(largest=float(largest), side=side, reason="grid")


@outcome_check
def nothing_comes_off(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """No particles in the settled cycles of a case: what they would have to be."""
    if not facts.of_kind("wear", "running-in"):
        return
    counts = [math.nan if one is None else one for one in _listed(outcome.summary.get("particles_per_cycle"))]
    solved = [cut is not None for cut in _listed(outcome.summary.get("truncated_particles"))]
    if len(solved) == len(counts) and facts.scene.wear.particle_criterion is not None:
        # something is worn and no particle is found: their number is not known
        counts = [0.0 if of and math.isnan(one) else one for one, of in zip(counts, solved, strict=True)]
    if len(counts) != len(facts.cases):  # cases that are alike to the checks
        counts = [max((one for one in counts if math.isfinite(one)), default=0.0)] * len(facts.cases)
    turned = outcome.summary.get("friction_first_turn") is not None  # whole turns of the roughness
    stresses = np.ravel(np.array(outcome.summary.get("largest_stress_Pa"), dtype=np.float64))
    stresses = stresses if len(stresses) == len(counts) else np.full(len(counts), np.nan)
    for number, case, stress in zip(counts, facts.cases, stresses, strict=True):
        if number == 0 and case.wear is not None and case.wear.finds_particles.needs_strength:
            takes = _what_it_takes(case) or _how_far(case, float(stress))
            beside = _beside_strength(case, float(stress))
            law = case.wear.finds_particles.name
            note = partial(NOTHING_CAME_OFF, case.label, law=law, takes=takes, beside=beside)
            ratio = pure_rolling(facts)
            if case.wear.finds_particles is not case.wear.criterion:
                yield note(wears=case.wear.criterion.name, reason="particles")
            elif _cycles_differ(case):
                yield note(reason="weak")
            elif ratio is not None:
                yield note(ratio=ratio, reason="rolls")
            else:
                yield note(reason="repeats" if turned else "weak")


def _cycles_differ(case: Case) -> bool:
    """Return True if cycles without particles differ: the criterion adds up damage, or surfaces wear by a rate."""
    from bem.wear.criterion import LowCycleFatigue

    law = None if case.wear is None else case.wear.criterion
    return law is not None and (law.wears_by_pressure or isinstance(law, LowCycleFatigue))


def _beside_strength(case: Case, stress: float) -> str:
    """Return the largest stress beside the strength in a few words; none where either is not known or reached."""
    strengths = [material.yield_stress for material in case.wearing if material.yield_stress is not None]
    if not strengths or not np.isfinite(stress):
        return ""
    if stress > min(strengths):
        return f": the {si(min(strengths), 'Pa')} that it takes are exceeded below the surface only"
    return f": {si(stress, 'Pa')} of the {si(min(strengths), 'Pa')} that it takes"


def _how_far(case: Case, stress: float) -> str:
    """The largest stress beside the strength, and of tension what makes it."""
    strengths = [material.yield_stress for material in case.wearing if material.yield_stress is not None]
    if not strengths or not np.isfinite(stress):
        return ""
    strength = min(strengths)
    if stress > strength:
        return "In the last cycle nothing that exceeds the yield stress reaches the surface."
    down = f" down to {si(case.depths[-1], 'm')}" if case.depths else ""
    said = (
        f"The largest stress of a cell{down} in the last cycle is {si(stress, 'Pa')}, and {si(strength, 'Pa')} is "
        "what takes it off."
    )
    if case.wear is None or case.wear.finds_particles.name != "maximum_tension":
        return said
    return said + (
        " Under pressure alone a line contact has no tension and a round one (1 - 2 nu)/3 of its highest pressure at "
        "the edge, friction f adds 2 f of it behind a line contact and pi (4 + nu)/8 f behind a round one, and a thin "
        "layer has both in the ratio of its modulus to the substrate's; these are peaks as steep as a root, of which "
        "cells see 0.75 where the contact is 20 to 30 of them wide and 0.9 on 100."
    )


def _what_it_takes(case: Case) -> str:
    if case.wear is None:
        return ""
    from bem.wear.criterion import Junction, LowCycleFatigue

    law = case.wear.criterion
    if isinstance(law, Junction):
        size = min(law.critical_size(material) for material in case.wearing)
        return f"A junction must be {si(size, 'm')} wide, d* of its surface_energy and strength_ratio."
    if isinstance(law, LowCycleFatigue):
        return "Voxels still have life left: take more cycles.count or passes."
    return ""


def _listed(value: Any) -> list[Any]:
    """Return a figure of the summary as a list over cases; None stays at its place."""
    return value if isinstance(value, list) else [] if value is None else [value]


@outcome_check
def particles_cut_by_the_depths(facts: Facts, outcome: Outcome) -> Iterator[Note]:
    """A piece that reaches the last depth goes on below it."""
    cut, number = outcome.summary.get("truncated_particles"), outcome.summary.get("particles_per_cycle")
    if cut is None or number is None or not facts.of_kind("wear", "running-in"):
        return
    if facts.scene.wear.particle_criterion is not None:  # told by the loop: numbers are those of the wear law
        return
    settled = facts.scene.cycles.settled
    shares = [c / (n * settled) for c, n in zip(_listed(cut), _listed(number), strict=False) if n]
    if shares and max(shares) > 0.02:
        coated = any("layer" in key for key in facts.materials)
        held = any(case.wear is not None and case.wear.within_layer for case in facts.cases)
        ends = "unless they end at the interface, where wear.within_layer ends them"
        yield PARTICLES_CUT(share=max(shares), unless=f", {ends}" if coated and held else "", reason="depths")
