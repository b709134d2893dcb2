"""Checks of the contact as a whole: whether half-spaces, small strains and the grid's edges can be believed."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.notes import Note
from bem.notes.checks import (
    ABOVE_HARDNESS,
    CYLINDER_NARROW,
    HARDNESS_DECIDES,
    PATCH_SINKS,
    PERIODIC_GRID,
    SLOPES_LARGE,
    YIELDS,
)
from bem.notes.contact import CONTACT_AT_EDGE
from bem.notes.note import joined
from bem.quantities import si
from bem.scenes import build
from bem.scenes.checks.facts import Case, Facts, worst
from bem.scenes.checks.hertz import LARGEST_SLOPE, line_contact_on_layer
from bem.scenes.checks.registry import scene_check
from bem.scenes.cut_off import WANTED, key_of_lengths

_CAPPED_BY_ITS_FILM = "tribofilm"
"""The kind whose contact is capped by a hardness that its cases do not say, where that follows a law."""


@scene_check
def contact_large_for_its_radius(facts: Facts) -> Iterator[Note]:
    """Half-spaces and parabolas need a << R (Johnson 1985, section 4.1).

    At a/R the surface meets the contact's edge at that slope: a parabola misses a sphere by (a/R)^2 / 4 and cosines by
    (a/R)^2 / 2, 2 % at 0.2; Tabor's representative strain is 0.2 a/R, 4 %.
    """
    found = worst((case.smooth.ratio, case) for case in facts.cases if case.smooth is not None)
    if found is not None and found[0] > LARGEST_SLOPE:
        ratio, case = found
        yield SLOPES_LARGE(case.label, ratio=ratio, strain=0.2 * ratio, reason="hertz")


@scene_check
def hertz_pressure_above_hardness(facts: Facts) -> Iterator[Note]:
    """An elastic contact has no limit; a real one flows. Only where no cap is set."""
    values = (
        (pressure / case.softest, pressure, case)
        for case in _elastic(facts)
        if case.softest is not None and (pressure := _smooth_pressure(case)) is not None
    )
    found = max(values, key=lambda one: one[0], default=None)
    if found is not None and found[0] > 1:
        ratio, pressure, case = found
        capped = {"contact": 'behaviour = "capped"', "friction": 'sharing.models = ["capped"]'}.get(facts.scene.kind)
        how = "take a smaller load" if capped is None else f"take {capped} or a smaller load"
        reason = "layer" if _layered(case) else "hertz"
        yield ABOVE_HARDNESS(case.label, pressure=pressure, ratio=ratio, action=how, reason=reason)


def _layered(case: Case) -> bool:
    """Return True if one of the bodies has layers."""
    return any(body.layers for body in case.bodies.values())


def _smooth_pressure(case: Case) -> float | None:
    """Return the highest pressure of the smooth contact [Pa]: Hertz', or that of a line contact on a layer.

    None of other contacts with layers, whose pressure is not Hertz' and which the run itself compares.
    """
    if case.smooth is None or not _layered(case):
        return None if case.smooth is None else case.smooth.maximum_pressure
    on_layer = line_contact_on_layer(case.lower, case.upper, case.smooth)
    return None if on_layer is None else on_layer[1]


@scene_check
def yield_below_the_surface(facts: Facts) -> Iterator[Note]:
    """A sphere yields below its surface from p0 = 1.60 Y, a cylinder from 1.79 Y; von Mises, nu = 0.3.

    Only where the pressure stays below the hardness, so that one sentence says it.
    """
    found = worst(
        (case.smooth.maximum_pressure / onset, case)
        for case in _elastic(facts)
        if case.smooth is not None
        and (onset := case.smooth.yields_from(*case.bodies.values())) is not None
        and onset < case.smooth.maximum_pressure <= (case.softest or 0.0)
    )
    if found is not None:
        ratio, case = found
        assert case.smooth is not None
        pressure = case.smooth.maximum_pressure
        same = case.upper is not None and case.upper.material == case.lower.material
        reason = "hertz of one material" if same else "hertz"
        yield YIELDS(case.label, pressure=pressure, ratio=ratio, onset=pressure / ratio, reason=reason)


def _elastic(facts: Facts) -> Iterator[Case]:
    """Contacts as elastic as Hertz'."""
    return (case for case in facts.cases if case.cap is None and not facts.of_kind(_CAPPED_BY_ITS_FILM))


@scene_check
def mean_pressure_near_hardness(facts: Facts) -> Iterator[Note]:
    """With half the hardness over the whole grid, half of it touches at the cap; what flows has nowhere to go.

    An elastic contact has no cap; `elastic_pressure_above_hardness` compares its pressures with the hardness."""
    limits = ((case.mean_pressure or 0.0, case.cap, case) for case in facts.cases)
    found = worst((pressure / limit, case) for pressure, limit, case in limits if limit)
    if found is not None and found[0] > 0.5:
        ratio, case = found
        yield HARDNESS_DECIDES(case.label, ratio=ratio, reason="load")


@scene_check
def grid_smaller_than_hertz(facts: Facts) -> Iterator[Note]:
    """A free grid must hold the contact; a tenth beyond Hertz' edge is where the gap opens to see it end."""
    if facts.of_kind("asperities"):
        return
    found = worst((_lengths_across(case, axis), case) for case in facts.cases for axis in _free_axes(case))
    if found is not None and 2.2 * found[0] > 1:
        case = found[1]
        axis = max(_free_axes(case), key=lambda axis: _lengths_across(case, axis))
        assert case.smooth is not None
        assert case.grid is not None
        size = 2 * case.smooth.semi_axes[axis]
        yield CONTACT_AT_EDGE(
            case.note_place("grid"),
            length=case.grid.lengths[axis],
            axis="xy"[axis],
            size=size,
            wanted=WANTED * size,
            key=key_of_lengths(facts.scene),
            reason="grid",
        )


@scene_check
def adhesive_zone_of_few_cells(facts: Facts) -> Iterator[Note]:
    """Cells must resolve the zone in which attraction acts at the edge of a contact, which is known before a run."""
    law = getattr(getattr(facts.scene, "contact", None), "adhesion", None)
    if law is None:
        return
    from bem.adhesion.zone import zone_notes

    for case in facts.cases:
        if case.grid is not None:
            yield from zone_notes(law, build.modulus_of(facts.scene), case.grid, "foreseen")
            return


def _lengths_across(case: Case, axis: int) -> float:
    assert case.smooth is not None
    assert case.grid is not None
    return case.smooth.semi_axes[axis] / case.grid.lengths[axis]


def _free_axes(case: Case) -> list[int]:
    """Axes along which the grid ends and the smooth contact too."""
    if case.grid is None or case.smooth is None:
        return []
    return [axis for axis in (0, 1) if not case.grid.periodic[axis] and math.isfinite(case.smooth.semi_axes[axis])]


@scene_check
def flat_patch_with_free_edges(facts: Facts) -> Iterator[Note]:
    """A flat on a free grid is a punch as large as the grid: pressures rise without bound towards its edges.

    Johnson (1985), section 2.8.
    """
    for case in facts.cases:
        free = [name for name, wraps in zip("xy", case.grid.periodic, strict=True) if not wraps] if case.grid else []
        if case.shape == "flat" and free and case.load is not None:
            yield CONTACT_AT_EDGE(case.note_place("grid"), axes=" and ".join(free), reason="punch")
            return


@scene_check
def curved_body_repeats(facts: Facts) -> Iterator[Note]:
    """On a periodic axis a sphere is a row of spheres, each carried by what its neighbours push down.

    The neighbours' displacement relative to the contact's own is about a / L times four (the lattice sum of 1/r); 0.1
    of it from L = 40 a on is far too strict for pressures, which see its variation over the contact: (a/L)^3, 1 % at L
    = 5 a.
    """
    if facts.of_kind("asperities") or getattr(facts.scene, "at_film_separation", False):
        return
    for case in facts.cases:
        if case.grid is None or case.smooth is None:
            continue
        sizes, lengths = case.smooth.semi_axes, case.grid.lengths
        axes = [axis for axis in (0, 1) if case.grid.periodic[axis] and math.isfinite(sizes[axis])]
        if axes:
            ratio = min(lengths[axis] / sizes[axis] for axis in axes)
            yield PERIODIC_GRID(
                case.note_place("grid"),
                axis=joined(["xy"[axis] for axis in axes]),
                shape=case.shape,
                length=joined(list(dict.fromkeys(si(lengths[axis], "m") for axis in axes))),
                near=f", {ratio:.2g} contact radii apart" if ratio < 5 else "",
                single="[false, true]" if case.smooth.line else "false",
                reason="body",
            )


@scene_check
def patch_sinks_at_given_separation(facts: Facts) -> Iterator[Note]:
    """At a given separation of the undeformed planes the half-space sinks in by an amount that follows the patch."""
    if not getattr(facts.scene, "at_film_separation", False):
        return
    from bem.friction.given_separation import sinking_compliance

    scene = facts.scene
    for case in facts.cases:
        if case.grid is not None and case.load is not None:
            sunk = sinking_compliance(case.grid) * case.load / (case.grid.area * scene.modulus)
            yield PATCH_SINKS(case.note_place("sharing.separation"), sunk=sunk, length=case.grid.lengths[0])
            return


@scene_check
def wave_does_not_fit_the_period(facts: Facts) -> Iterator[Note]:
    """A sinusoid that does not close over a periodic grid has a step at the seam, with the highest pressures in it."""
    for case in facts.cases:
        if case.wavelength is None or case.grid is None or not case.grid.periodic[0]:
            continue
        waves = case.grid.lengths[0] / case.wavelength
        if abs(waves - round(waves)) > 1e-6 * waves or round(waves) == 0:
            yield PERIODIC_GRID(
                case.note_place("shape.wavelength"), waves=waves, length=case.grid.lengths[0], reason="wave"
            )


@scene_check
def cylinder_too_narrow_for_a_line(facts: Facts) -> Iterator[Note]:
    """Plane strain needs an axis much longer than the contact is wide; its ends take a share of about 2a / width."""
    found = worst(
        (2 * case.smooth.semi_axes[0] / case.width, case)
        for case in facts.cases
        if case.smooth is not None and case.width is not None and case.smooth.line
    )
    if found is not None and found[0] > 0.2:
        share, case = found
        yield CYLINDER_NARROW(case.label, ratio=1 / share)
