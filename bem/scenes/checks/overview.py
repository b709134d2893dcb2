"""A scene in words, for `bem plan`: bodies, surfaces and what was done to them, grid, Hertz contact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from bem.materials import Body, Material
from bem.notes.note import percent
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import si
from bem.scenes.checks.facts import Case, Facts
from bem.scenes.checks.hertz import SmoothContact, line_contact_on_layer
from bem.scenes.checks.words import times

if TYPE_CHECKING:
    from bem.lubrication import Lubricant

_MOST_CASES = 12
_CASE = "case"
_PERIODIC = {(True, True): "periodic", (False, False): "free", (True, False): "periodic along x, free along y"}

Rows = list[tuple[str, str]]


def bodies(facts: Facts) -> Rows:
    """Describe both bodies: materials, layers, and surfaces with their treatment."""
    rows: Rows = []
    if not facts.cases:
        return rows
    first = facts.cases[0]
    for name in ("lower", "upper"):
        body = first.bodies.get(name)
        rows.append((name, "rigid" if body is None else _body(body)))
        found = [rough for _, rough in facts.surfaces if rough.body == name]
        if found:
            rough = found[0]
            rows.append((f"{name} surface", rough.made[0]))
            rows += [("", text) for text in (*rough.made[1:], f"on the whole grid: {rough.describe()}")]
            others = found[1:]
            if others:
                steep, high = (
                    _range([getattr(r, key) for r in found], unit)
                    for key, unit in (("rms_slope", ""), ("rms_height", "m"))
                )
                rows.append(("", f"over the {len(found)} grids and variants: Sq {high}, rms slope {steep}"))
        elif name in first.surfaces:
            rows.append((f"{name} surface", "smooth"))
    if facts.surfaces and facts.of_kind("wear", "running-in"):
        worn = ("lower", "upper")[first.wearing_bodies[0]] if first.wearing_bodies else "worn"
        from bem.scenes.wearing import wears_on_a_track

        on_track = bool(first.wearing_bodies) and wears_on_a_track(facts.scene)
        if not on_track or (facts.of_kind("running-in") and first.shape == "ellipsoid"):  # others wear the whole grid
            region = "track, which is as wide as the contact" if on_track else "contact region"
            rows.append(("", f"results give Sq of the {worn} body's {region}; it differs from Sq of the whole grid"))
    rows.append(("upper shape", _shape(first)))
    return rows


def common(facts: Facts) -> Rows:
    """Describe the parts common to all contacts: grid, Hertz contact, depths."""
    columns = [_column(case) for case in facts.cases]
    return [
        (name, columns[0][name])
        for name in _names(columns)
        if name != _CASE and columns[0].get(name) and len({column.get(name, "") for column in columns}) == 1
    ]


def oil(lubricant: Lubricant) -> list[tuple[str, str, str]]:
    """Figures of an oil at its temperature, and where each is from."""
    made = lubricant.oil
    law = f"viscosity_law {lubricant.viscosity_law.name}"
    if made is None:
        return [
            ("viscosity", si(lubricant.viscosity, "Pa s"), "given"),
            ("pressure-viscosity", _per_gpa(lubricant.pressure_viscosity), f"given; {law}"),
        ]
    temperature = lubricant.temperature
    assert temperature is not None
    rows = [
        ("oil", made.name, made.viscosity_source),
        ("temperature", f"{temperature - ZERO_CELSIUS:.4g} degC", ""),
        ("viscosity", si(lubricant.viscosity, "Pa s"), made.viscosity.words),
        ("kinematic", f"{1e6 * made.viscosity.kinematic(temperature):.4g} mm^2/s", ""),
        ("softening", f"{100 * (lubricant.temperature_viscosity or 0.0):.2g} %/K", "-d ln(viscosity)/dT, of the same"),
    ]
    alpha = made.pressure_viscosity
    own = alpha is not None and lubricant.pressure_viscosity == made.pressure_coefficient(temperature)
    source = alpha.source if own and alpha is not None else "given"
    rows.append(("pressure-viscosity", _per_gpa(lubricant.pressure_viscosity), f"{source}; {law}"))
    for name, value, line, unit in (
        ("density", lubricant.density, made.density, "kg/m^3"),
        ("heat capacity", lubricant.heat_capacity, made.heat_capacity, "J/(kg K)"),
        ("conductivity", lubricant.thermal_conductivity, made.thermal_conductivity, "W/(m K)"),
    ):
        if value is not None:
            found = line.source if line is not None and value == line(temperature) else "given"
            rows.append((name, f"{value:.4g} {unit}", found))
    limits = [
        f"{name} {value - ZERO_CELSIUS:.4g} degC"
        for name, value in (
            ("solid below", made.freezing_point),
            ("flashes at", made.flash_point),
            ("boils at", made.boiling_point),
        )
        if value is not None
    ]
    return [*rows, *([("limits", ", ".join(limits), made.limits_source)] if limits else [])]


def _per_gpa(value: float) -> str:
    return f"{1e9 * value:.4g} 1/GPa"


def differing(facts: Facts) -> tuple[list[str], list[list[str]]]:
    """Names of what differs between the contacts, and a row for each contact, at most twelve; nothing for one
    contact."""
    columns = [_column(case) for case in facts.cases]
    if len(columns) == 2 and (facts.cases[0].grid is None) != (facts.cases[1].grid is None):
        for case, column in zip(facts.cases, columns, strict=True):  # a patch of the roughness beside the whole contact
            column[_CASE] = "whole contact" if case.grid is None else "rough patch"
    names = [name for name in _names(columns) if len({column.get(name, "") for column in columns}) > 1]
    rows = [[column.get(name, "") for name in names] for column in columns]
    if len(rows) > _MOST_CASES:
        rows = [*rows[: _MOST_CASES - 1], [f"and {len(rows) - _MOST_CASES + 1} more", *[""] * (len(names) - 1)]]
    return names, rows if names else []


def _names(columns: list[dict[str, str]]) -> list[str]:
    return list(dict.fromkeys(name for column in columns for name in column))


def _column(case: Case) -> dict[str, str]:
    found: dict[str, str] = {_CASE: case.label}
    grid, smooth = case.grid, case.smooth
    if grid is not None:
        found["cells"] = f"{grid.shape[0]} x {grid.shape[1]}"
        found["edges"] = _PERIODIC.get(grid.periodic, "free along x, periodic along y")
        found["spacing"] = times(grid.spacing, "m")
        found["lengths"] = times(grid.lengths, "m")
    if case.whole_load is not None:  # its cells are those of the patch
        found["load"] = si(case.whole_load, "N")
    elif case.load is not None:
        found["load on the grid"] = si(case.load, "N")
        found["load over grid area"] = "" if case.mean_pressure is None else si(case.mean_pressure, "Pa")
    found["pressure limit"] = "" if case.cap is None else f"{si(case.cap, 'Pa')} (hardness)"
    if smooth is not None:
        semi_axes = smooth.semi_axes
        on_layer = line_contact_on_layer(case.lower, case.upper, smooth)
        if on_layer is not None:
            semi_axes = (on_layer[0], math.inf)
            found["half-width on the layer"] = si(on_layer[0], "m")
            found["highest pressure on the layer"] = si(on_layer[1], "Pa")
        else:
            found |= _hertz(case, smooth)
        if grid is not None:
            across = [2 * a / d for a, d in zip(semi_axes, grid.spacing, strict=True) if math.isfinite(a)]
            found["cells across Hertz' contact" if on_layer is None else "cells across the contact"] = (
                f"{min(across):.3g}"
            )
            share = max(2 * a / n for a, n in zip(semi_axes, grid.lengths, strict=True) if math.isfinite(a))
            found["contact over the grid's length"] = percent(share) if share <= 1 else f"{share:.2g} times its length"
    if case.depths and (case.wear is None or case.wear.finds_particles.needs_strength):  # a wear law asks for no stress
        deepest = f"{len(case.depths)} down to {si(case.depths[-1], 'm')}"
        steps = [b - a for a, b in zip(case.depths, case.depths[1:], strict=False)]
        found["depths"] = deepest + (f", steps {_range(steps, 'm')}" if steps else "")
    return found


def _hertz(case: Case, smooth: SmoothContact) -> dict[str, str]:
    """Describe Hertz' contact of the substrates; its names say where it leaves out layers."""
    name = "half-width" if smooth.line else "semi-axes" if len(set(smooth.semi_axes)) > 1 else "radius"
    sizes = tuple(a for a in smooth.semi_axes if math.isfinite(a))
    layered = any(body is not None and body.layers for body in (case.lower, case.upper))
    without = " without layers" if layered else ""
    return {
        f"Hertz {name}{without}": " x ".join(si(a, "m") for a in dict.fromkeys(sizes)),
        f"Hertz pressure{without}": si(smooth.maximum_pressure, "Pa"),
        f"Hertz approach{without}": "" if smooth.approach is None else si(smooth.approach, "m"),
    }


def _body(body: Body) -> str:
    stack = [
        f"{si(layer.thickness, 'm')} of {_material(layer.material)}"
        + (f", residual stress {si(layer.residual_stress, 'Pa')}" if layer.residual_stress else "")
        for layer in body.layers
    ]
    return ", on ".join([*stack, _material(body.material)])


def _material(material: Material) -> str:
    words = [f"E {si(material.youngs_modulus, 'Pa')}, nu {material.poissons_ratio:g}"]
    if material.stiffness is not None:
        normal = " ".join(f"{value:.3g}" for value in material.stiffness.normal)
        modulus = si(material.stiffness.plane_strain_modulus, "Pa")
        words = [f"{material.stiffness.crystal} crystal, surface across [{normal}], indentation modulus {modulus}"]
    if material.surface_tension is not None:
        length = si(material.elastocapillary_length, "m")
        words.append(f"surface tension {si(material.surface_tension, 'N/m')}, elastocapillary length {length}")
    if material.hardness is not None:
        words.append(f"hardness {si(material.hardness, 'Pa')}")
    if material.yield_stress is not None:
        words.append(f"yield stress {si(material.yield_stress, 'Pa')}")
    return f"{material.name} ({', '.join(words)})"


def _shape(case: Case) -> str:
    if case.smooth is not None:
        radii = [si(r, "m") for r in dict.fromkeys(case.smooth.radii) if math.isfinite(r)]
        ball = case.shape == "ellipsoid" and all(map(math.isfinite, case.smooth.radii)) and len(radii) == 1
        return f"{'sphere' if ball else case.shape}, radius {' x '.join(radii)}"
    return case.shape if case.wavelength is None else f"{case.shape}, wavelength {si(case.wavelength, 'm')}"


def _range(values: list[float], unit: str) -> str:
    low, high = min(values), max(values)
    shown: list[Any] = [si(v, unit) if unit else f"{v:.2g}" for v in (low, high)]
    return shown[0] if shown[0] == shown[1] else f"{shown[0]} to {shown[1]}"
