"""Checks of the mesh: cells over the contact and over waves, layers, depths, slides."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from bem.materials import Body
from bem.notes import Note
from bem.notes.checks import (
    DEPTHS_MISS_STRESS,
    LAYER_MESH,
    PARTICLES_OF_MESH,
    PATCH_SHORT,
    ROUGHNESS_UNRESOLVED,
    WEAR_SHIFT,
)
from bem.notes.contact import CONTACT_UNRESOLVED
from bem.notes.note import joined
from bem.quantities import si
from bem.scenes import build
from bem.scenes.checks.facts import Case, Facts, worst
from bem.scenes.checks.registry import scene_check
from bem.scenes.checks.surfaces_of import RoughSurface
from bem.scenes.common import GeneratedSurface

if TYPE_CHECKING:
    from bem.adhesion.laws import AdhesionLaw

_CELLS_ACROSS = 8
_CELLS_PER_WAVE = 3
_GOOD_CELLS_PER_WAVE = 8
_LENGTHS_PER_GRID = 6


@scene_check
def few_cells_across_the_contact(facts: Facts) -> Iterator[Note]:
    """With 8 cells across, the largest pressure is met within 1.5 % and the area within 13 %; with 4, within 4 % and 5
    % by luck of the sampling. Measured against Hertz' sphere, centred on a cell and on a corner.

    With adhesion the contact is larger: see `_semi_axes`.
    """
    values = (
        (max(d / (2 * a) for d, a in zip(case.grid.spacing, _semi_axes(facts, case), strict=True)), case)
        for case in facts.cases
        if case.grid is not None and _semi_axes(facts, case)
    )
    found = worst(values)
    if found is not None and 1 / found[0] < _CELLS_ACROSS:
        across, case = 1 / found[0], found[1]
        spacing = min(_semi_axes(facts, case)) / 10
        reason = "hertz" if _adhesion(facts) is None else "adhesive"
        yield CONTACT_UNRESOLVED(
            case.note_place("grid"), across=across, fewest=_CELLS_ACROSS, spacing=spacing, reason=reason
        )


def _adhesion(facts: Facts) -> AdhesionLaw | None:
    """Return the law of adhesion of a scene, None without."""
    return getattr(getattr(facts.scene, "contact", None), "adhesion", None)


def _semi_axes(facts: Facts, case: Case) -> tuple[float, ...]:
    """Return the semi-axes of the smooth contact whose cells count [m]; empty where they are unknown or do not matter.

    Of an adhesive sphere under a load P they are those of Hertz' contact under P + 2 pi w R (Derjaguin, Muller and
    Toporov 1975): the least contact, as one of a shorter range is larger. Where the cells do not resolve the zone in
    which adhesion acts, the note on that zone asks for smaller ones.
    """
    law, smooth = _adhesion(facts), case.smooth
    if smooth is None or law is None or case.grid is None:
        return () if smooth is None else smooth.semi_axes
    from bem.adhesion.zone import is_resolved
    from bem.reference_solutions.adhesive_sphere import dmt_pull_off_force

    resolved = is_resolved(law, build.modulus_of(facts.scene), case.grid)
    if not resolved or case.shape != "sphere":
        return ()
    if case.load is None:
        return smooth.semi_axes
    larger = math.cbrt(1 + dmt_pull_off_force(law.work, smooth.radii[0]) / case.load)
    return tuple(larger * axis for axis in smooth.semi_axes)


@scene_check
def few_cells_per_wave(facts: Facts) -> Iterator[Note]:
    """A crest sampled with n cells a wave is met within 1 - cos(pi / n): 50 % with 3 cells, 29 % with 4, 8 % with 8.

    Below 3 cells every contact spot is one cell; averages need 4. Contact areas settle from 8 on (Yastrebov, Anciaux &
    Molinari, Phys. Rev. E 86 (2012) 035601). A generated surface without cutoff has waves of two cells on any mesh.
    """
    for _, case, surface in facts.worst_surfaces(lambda s: max(s.grid.spacing) / (s.shortest_wave or 1.0)):
        spacing = max(surface.grid.spacing)
        if surface.self_affine and surface.shortest_wave is None:
            yield _cutoff_wanted(case.note_place(f"{surface.body}.surface"), surface, spacing)
        elif surface.shortest_wave is not None and surface.shortest_wave / spacing < _CELLS_PER_WAVE:
            wave = surface.shortest_wave
            yield ROUGHNESS_UNRESOLVED(
                case.note_place("grid"),
                cells=wave / spacing,
                body=surface.body,
                wave=wave,
                spacing=wave / _GOOD_CELLS_PER_WAVE,
                average=2 * wave / _GOOD_CELLS_PER_WAVE,
                reason="wave",
            )


def _cutoff_wanted(where: str, surface: RoughSurface, spacing: float) -> Note:
    """Return the note on a self-affine surface without cutoff: a cutoff of 8 cells, and smaller cells where that would
    leave less than an octave of waves below the roll-off.

    spacing : cell size [m].
    """
    cutoff, rolloff = _GOOD_CELLS_PER_WAVE * spacing, getattr(surface.table, "rolloff_wavelength", None)
    if rolloff is None or cutoff <= 0.5 * rolloff:
        return ROUGHNESS_UNRESOLVED(where, wave=2 * spacing, cutoff=cutoff, reason="cutoff")
    return ROUGHNESS_UNRESOLVED(
        where,
        wave=2 * spacing,
        rolloff=rolloff,
        cutoff=0.5 * rolloff,
        spacing=0.5 * rolloff / _GOOD_CELLS_PER_WAVE,
        reason="cutoff-finer",
    )


@scene_check
def few_cells_per_correlation_length(facts: Facts) -> Iterator[Note]:
    """Between samples further apart than a third of the correlation length a surface is noise: its slope on the grid is
    that of the grid, and asperities are single cells. A self-affine surface is looked at by its shortest wave alone
    (`few_cells_per_wave`): waves of 8 cells are resolved, whose correlation length, 0.28 of the wave, is 2.2 cells."""

    def of_lengths(surface: RoughSurface) -> list[float]:
        return [d / length for d, length in zip(surface.grid.spacing, surface.correlation_lengths, strict=True)]

    for inverse, case, surface in facts.worst_surfaces(lambda s: math.nan if s.self_affine else max(of_lengths(s))):
        cells, length = 1 / inverse, surface.correlation_lengths[of_lengths(surface).index(inverse)]
        wave = surface.shortest_wave
        if cells < _CELLS_PER_WAVE and (wave is None or wave >= _CELLS_PER_WAVE * max(surface.grid.spacing)):
            yield ROUGHNESS_UNRESOLVED(
                case.note_place("grid"),
                body=surface.body,
                length=length,
                cells=cells,
                spacing=length / 6,
                reason="correlation",
            )


@scene_check
def patch_of_few_correlation_lengths(facts: Facts) -> Iterator[Note]:
    """A patch of L x L holds (L / l)^2 independent pieces of roughness; its means scatter by l / L.

    An elongated surface has its own l along each axis.

    A single wave over the patch, which is form and not roughness, has L / l = 5.3. Repetitions with surfaces of their
    own average and show the scatter.
    """
    repeated = (facts.scene.repetitions or 1) > 1
    for case, surface in facts.surfaces:
        if repeated and isinstance(surface.table, GeneratedSurface):
            continue
        sides, lengths = surface.grid.lengths, surface.correlation_lengths
        counts = [side / length for side, length in zip(sides, lengths, strict=True)]
        unknown = any(map(math.isnan, counts)) and min(surface.grid.shape) > 8
        if unknown or min(counts) < _LENGTHS_PER_GRID:
            yield PATCH_SHORT(
                case.note_place("grid"),
                reason="unknown" if unknown else "few",
                body=surface.body,
                lengths=math.nan if unknown else min(counts),
                along=f" along {'xy'[counts.index(min(counts))]}" if not unknown and lengths[0] != lengths[1] else "",
            )
            return


@scene_check
def layer_against_the_mesh(facts: Facts) -> Iterator[Note]:
    """A layer thinner than half a cell deforms within the cell alone; one much thicker than the grid is a half-space.

    Of 2 um of TiN on steel under a contact of 140 um the largest tension in the layer errs by 5 to 7 % on cells of 12
    and 6 um, 0.9 % on 3.1 um and 0.04 % on 1.6 um, against cells of 0.8 um.
    """
    seen = set()
    for case in facts.cases:
        for name, body in case.bodies.items():
            if body.layer is None or case.grid is None:
                continue
            thickness, axes = body.layer.thickness, case.grid.varying_axes
            spacing, length = (max(sides[axis] for axis in axes) for sides in (case.grid.spacing, case.grid.lengths))
            if thickness < 0.5 * spacing and (name, "thin") not in seen:
                seen.add((name, "thin"))
                thin: dict[str, Any] = {"layer": body.layer.material.name, "thickness": thickness, "cell": spacing}
                yield LAYER_MESH(case.note_place(f"{name}.layer"), **thin, reason="thin")
            if thickness > 2 * length and not all(case.grid.periodic) and (name, "thick") not in seen:
                seen.add((name, "thick"))
                yield LAYER_MESH(case.note_place(f"{name}.layer"), thickness=thickness, length=length, reason="thick")


@scene_check
def depths_miss_the_largest_stress(facts: Facts) -> Iterator[Note]:
    """Von Mises stress is largest 0.48 a below a sphere, 0.70 a below a cylinder; 0.2 a off costs 4 to 7 % of it.

    From friction 0.3 on it is largest at the surface (Hamilton 1983; Smith & Liu 1953). One depth alone is meant.
    """
    for case in facts.cases:
        bare = all(body.homogeneous for body in case.bodies.values())
        if not (len(case.depths) > 1 and case.smooth is not None and bare and facts.of_kind("contact")):
            continue
        rough = any(surface.kind != "smooth" for surface in case.surfaces.values())
        at, size = case.smooth.depth_of_largest_stress, min(case.smooth.semi_axes)
        at = 0.0 if case.friction >= 0.3 else at
        nearest = min(case.depths, key=lambda depth: abs(depth - at))
        if abs(nearest - at) > 0.2 * size and not rough:
            yield DEPTHS_MISS_STRESS(case.label, at=at, nearest=nearest, step=0.1 * size, reason="hertz")


_FEWEST_DEPTHS = 3
"""Depths in a layer below which the course of a stress through it is unknown."""

_NEAR_INTERFACE = 0.25
"""Distance of a depth from an interface, over the thickness of the thinner layer beside it, that counts as close."""


@scene_check
def few_depths_in_a_layer(facts: Facts) -> Iterator[Note]:
    """Stresses along the surface jump at an interface, and a thin layer lies between two depths of a graded list: the
    largest stress of a coating was reported 50 % wrong from a single depth in its interlayer."""
    for case in facts.cases:
        outputs = getattr(facts.scene, "outputs", None)
        name = getattr(outputs, "body", "lower")
        body = case.bodies.get(name)
        if body is None or body.homogeneous or not case.depths or facts.of_kind("wear", "running-in"):
            continue
        ends = (0.0, *body.interfaces)
        found = []
        for number, (top, bottom) in enumerate(itertools.pairwise(ends), start=1):
            inside = sum(top <= depth <= bottom for depth in case.depths)
            if inside < _FEWEST_DEPTHS:
                only = {0: "no depth lies", 1: "only 1 depth lies"}.get(inside, f"only {inside} depths lie")
                found.append(f"{only} in layer {number} ({si(top, 'm')} to {si(bottom, 'm')})")
        missed = [
            si(interface, "m")
            for interface, thickness in zip(body.interfaces, _thinner_beside(body), strict=True)
            if not _bracketed(interface, _NEAR_INTERFACE * thickness, case.depths)
        ]
        if missed:
            found.append(f"no depths lie close on both sides of the interface at {joined(missed)}")
        if found:
            yield DEPTHS_MISS_STRESS(case.label, found=joined(found), body=name, fewest=_FEWEST_DEPTHS, reason="layers")
            return


def _thinner_beside(body: Body) -> list[float]:
    """Thickness [m] of the thinner layer beside each interface, from the surface down."""
    layers = [layer.thickness for layer in body.layers]
    return [min(layers[i : i + 2]) for i in range(len(layers))]


def _bracketed(interface: float, near: float, depths: Sequence[float]) -> bool:
    """Return True if depths [m] lie on both sides of an interface, no further from it than `near`; one at the interface
    counts as above it."""
    above = any(interface - near <= depth <= interface for depth in depths)
    return above and any(interface < depth <= interface + near for depth in depths)


def _depth_steps(facts: Facts) -> Iterator[tuple[float, Case]]:
    """Distance of the depths of each case whose particles are made of voxels."""
    if facts.of_kind("wear", "running-in"):
        yield from ((case.depths[1] - case.depths[0], case) for case in facts.cases if len(case.depths) > 1)


@scene_check
def depths_coarser_than_cells(facts: Facts) -> Iterator[Note]:
    """Pieces that leave are made of voxels: twice as deep as wide, their thickness is the mesh's."""
    found = worst((step / min(case.grid.spacing), case) for step, case in _depth_steps(facts) if case.grid is not None)
    if found is not None and found[0] > 2:
        ratio, case = found
        cell = min(case.grid.spacing if case.grid else (0.0,))
        yield PARTICLES_OF_MESH(case.label, ratio=ratio, cell=cell, reason="depths")


@scene_check
def few_cells_per_length_of_the_criterion(facts: Facts) -> Iterator[Note]:
    """Below three cells sizes follow the mesh under any criterion (the documentation on wear criteria)."""
    for case in facts.cases:
        if case.wear is None or case.grid is None:
            continue
        law = case.wear.finds_particles
        coarse = [law.length(material) for material in case.wearing if not law.resolved(material, case.grid)]
        if coarse:
            from bem.wear.criterion.base import FEWEST_CELLS, resolved_length

            dx, dy = case.grid.spacing
            most, wanted = min(coarse) / FEWEST_CELLS, resolved_length(max(dx, dy))
            long = [axis for axis, cell in zip("xy", (dx, dy), strict=True) if cell > most]
            yield PARTICLES_OF_MESH(
                case.label,
                key="criterion" if law is case.wear.criterion else "particle_criterion",
                law=law.name,
                length=min(coarse),
                cells=min(coarse) / max(dx, dy),
                fewest=FEWEST_CELLS,
                cell=most,
                along=f" along {long[0]}" if len(long) == 1 else "",
                longer=f', or {law.length_key} = "{si(wanted, "m")}"' if law.length_key else "",
                reason="criterion",
            )


@scene_check
def layer_of_one_depth(facts: Facts) -> Iterator[Note]:
    """A film that wears needs more than one voxel through its thickness."""
    for step, case in _depth_steps(facts):
        for name, body in case.bodies.items():
            if body.layer is not None and step > body.layer.thickness:
                yield PARTICLES_OF_MESH(
                    case.label, step=step, body=name, thickness=body.layer.thickness, reason="layer"
                )
                return


@scene_check
def nothing_slides(facts: Facts) -> Iterator[Note]:
    """Wear cycles between which the surfaces stay where they are meet the same asperities each time."""
    if not (facts.of_kind("wear", "running-in") and facts.cases and all(case.slide == 0 for case in facts.cases)):
        return
    if facts.scene.wear.criterion.needs_strength:  # local wear has a distance of its own
        yield WEAR_SHIFT(reason="zero")


@scene_check
def slides_differ(facts: Facts) -> Iterator[Note]:
    """Variants of the mesh are alike only if they slide as far in a cycle: shift x cell must stay the same."""
    by_load: dict[float | None, list[Case]] = {}
    for case in facts.cases:
        if facts.of_kind("wear") and case.slide is not None and case.smooth is not None:
            by_load.setdefault(case.smooth.maximum_pressure, []).append(case)
    for cases in by_load.values():
        # a scene that varies the shift itself, on one mesh, means it
        meshes = {case.grid.spacing for case in cases if case.grid is not None}
        shortest, longest = min(cases, key=_slide), max(cases, key=_slide)
        if len(meshes) > 1 and _slide(longest) > 1.02 * _slide(shortest):
            ends = [f"{si(_slide(one), 'm')}{one.at}" for one in (shortest, longest)]
            yield WEAR_SHIFT(shortest=ends[0], longest=ends[1], reason="differs")
            return


def _slide(case: Case) -> float:
    return abs(case.slide or 0.0)
