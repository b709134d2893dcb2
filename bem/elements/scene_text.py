"""Text of a scene that is made of a machine element: values with units, rounded to six digits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from bem.elements.passes import NAMES, time_words
from bem.elements.plain_bush import PlainBushModel
from bem.elements.rough_scenes import averaging_length, finish_lengths, passes_in
from bem.materials import Body
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import si
from bem.scenes.load import dumped
from bem.wear.setup import wearing_bodies

if TYPE_CHECKING:
    from bem.elements.element import Element

_DIGITS = 6
"""Digits of written values: the rounding of 1e-6 is far below every error of a model."""
_UNITS = {
    **dict.fromkeys(("lower_bulk", "upper_bulk", "temperature"), "K"),
    **dict.fromkeys(("load", "loads"), "N"),
    "viscosity": "Pa*s",
    **dict.fromkeys(("film_modulus", "youngs_modulus"), "Pa"),
    **dict.fromkeys(("values", "mean_speed", "lower_speed", "upper_speed"), "m/s"),
    **dict.fromkeys(("roughness", "rms_height", "correlation_length", "rolloff_wavelength", "cutoff_wavelength"), "m"),
    **dict.fromkeys(
        (
            "thickness",
            "averaging_length",
            "radius",
            "radius_y",
            "radii",
            "width",
            "distance",
            "lengths",
            "spacing",
            "position",
            "bore",
            "clearance",
            *"ABCDE",
        ),
        "m",
    ),
}
"""SI units of the keys that `Element.scene` and `Element.path_scene` fill with numbers."""


_PURE_ROLLING = "    # pure rolling: asperities carry load but do not rub; for a Stribeck curve 0.02 or the like"
"""Comment on a slide-to-roll ratio of zero in a scene of kind friction."""


_RANDOM = (
    "    # random, of the element's rms_roughness; its lengths are assumed (`bem surfaces`): put your measured map here"
)
"""Comment on a surface."""


_OF_LOWER = "    # of the lower surface; the entrainment speed is {mean}"
"""Comment on the speed of a scene with sliding."""


_MAGNITUDE = "    # friction in the results is positive where it resists the sliding; bem element gives that of body 1"
"""Comment on a negative slide-to-roll ratio in a scene of mixed friction, beside which `bem element` has a sign."""


_FLANKS = "    # of the flanks, estimated with this oil: another oil needs its own (bem element --cases)"
"""Comment on the oil's temperature where it is that of flanks by an estimate."""


_THIN_WALL = "    # youngs_modulus: of the half-space on which the contact is as wide as on the wall in its housing"
"""Comment on the material of a bush with a wall in a film between smooth surfaces."""


_GROOVES = (
    "    # random, of the element's rms_roughness; correlation_length: geometric mean of {across} across the grooves "
    "(the element's) and {along} along them"
)
"""Comment on grooved surfaces of an element with a correlation length of its own."""


_OWN_LENGTH = "    # random, of the element's rms_roughness and correlation_length: put your measured map here"
"""Comment on surfaces without grooves of an element with a correlation length of its own."""


_WORN = '    # of equal materials the body whose whole track wears evenly; "both" cuts a groove into the other besides'
"""Comment on the body that wears in running-in between equal materials."""


_SLID = (
    "    # distance: slid by a place of the {first} in a cycle; upper_over_lower: slid by a place of the {second} in a "
    "cycle, over that"
)
"""Comment on the wear law of a life in which both bodies wear."""


_NO_PARTICLES = (
    "    # particles need cells as short along y as along x (a longer run): grid.shape = {shape} and "
    'particle_criterion = {{ kind = "averaged_von_mises", averaging_length = "{length}" }}'
)
"""Comment on the wear law of running-in on cells that are too long for particles."""


def element_scene_text(element: Element, table: Mapping[str, Any]) -> str:
    """Return a scene of an element, a table of `Element.scene` or `Element.path_scene`, as TOML text with comments."""
    comments = {}
    bush = element.model
    thin = isinstance(bush, PlainBushModel) and bush.wall is not None and table["kind"] == "traction"
    if thin and isinstance(table["upper"]["material"], Mapping):
        comments["upper.material"] = _THIN_WALL
    if element.model.correlation_length is not None and element.model.rms_roughness is not None:
        shorter, longer = (si(one, "m", 4) for one in sorted(finish_lengths(element.model) or ()))
        words = _OWN_LENGTH if shorter == longer else _GROOVES.format(across=shorter, along=longer)
        comments |= dict.fromkeys(("lower.surface", "upper.surface"), words)
    if table["kind"] == "running-in":
        comments |= _wear_comments(table) | _cycle_comments(element, table)
    if table["kind"] == "running-in-life" and "upper_over_lower" in table["wear"]["law"]:
        first, second = NAMES.get(element.model.element, ("body 1", "body 2"))
        comments["wear.law"] = _SLID.format(first=first, second=second)
    return scene_text(table, bulk_estimated=element.bulk_estimated, comments=comments)


def _wear_comments(table: Mapping[str, Any]) -> dict[str, str]:
    """Return comments on the wear of a scene of running-in: which body wears, and what particles would need."""
    found = {"wear.wears": _WORN}
    if "particle_criterion" not in table["wear"]:
        shape, lengths = table["grid"]["shape"], table["grid"]["lengths"]
        cell = min(length / cells for length, cells in zip(lengths, shape, strict=True))
        fine = [16 * math.ceil(length / cell / 16 * (1 - 1e-9)) for length in lengths]
        found["wear.criterion"] = _NO_PARTICLES.format(shape=fine, length=si(averaging_length(cell), "m", 4))
    return found


def _cycle_comments(element: Element, table: Mapping[str, Any]) -> dict[str, str]:
    """Return a comment on the number of cycles of running-in: how many passes a cycle stands for."""
    criterion, passes = table["wear"]["criterion"], passes_in(table, element.model, element.found.passes)
    bodies = Body(element.bodies[0]), Body(element.bodies[1])
    (worn,) = wearing_bodies(bodies, table["wear"].get("wears", "softer"))
    slid = passes.slid[worn]
    if not slid:
        return {}
    number = criterion["distance"] / slid
    lasting = "" if passes.rate is None else f", {time_words(number / passes.rate)}"
    return {"cycles.count": f"    # each stands for {float(f'{number:.3g}'):g} {passes.unit}{lasting}"}


def scene_text(
    table: Mapping[str, Any], *, bulk_estimated: bool = False, comments: Mapping[str, str] = MappingProxyType({})
) -> str:
    """Return the table of an element's scene as TOML text for a reader: tables under headings, values with units.

    bulk_estimated : True if the oil's temperature is an estimate of the bodies' with this oil, which a comment says.
    comments : on keys such as "upper.material", in place of the usual ones.
    """
    tables = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    rolls = table.get("kind") == "friction" and table["speeds"]["slide_roll_ratio"] == 0
    speeds = table.get("speeds", {})
    lines = [f"{key} = {_value(key, value)}" for key, value in table.items() if key not in tables]
    for key, inner in tables.items():
        lines += ["", f"[{key}]", *(_line(name, value, comments.get(f"{key}.{name}")) for name, value in inner.items())]
        if bulk_estimated and key == "oil" and "temperature" in inner:
            lines[-len(inner) + list(inner).index("temperature")] += _FLANKS
        if rolls and key == "speeds":
            lines[-1] += _PURE_ROLLING
        if (
            key == "speeds"
            and table.get("kind") in ("friction", "running-in")
            and speeds.get("slide_roll_ratio", 0) < 0
        ):
            lines[-len(inner) + list(inner).index("slide_roll_ratio")] += _MAGNITUDE
        if key == "speeds" and speeds.get("slide_roll_ratio") and len(speeds.get("values", [])) == 1:
            mean = speeds["values"][0] / (1 + 0.5 * speeds["slide_roll_ratio"])
            lines[-len(inner)] += _OF_LOWER.format(mean=si(mean, "m/s", 4))
    return "\n".join(lines) + "\n"


def _line(name: str, value: Any, comment: str | None) -> str:
    usual = _RANDOM if name == "surface" and isinstance(value, Mapping) else ""
    return f"{name} = {_value(name, value)}{usual if comment is None else comment}"


def _value(key: str, value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{name} = {_value(name, inner)}" for name, inner in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(key, one) for one in value) + "]"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return dumped(value)
    if key not in _UNITS or not math.isfinite(value):
        return dumped(value if isinstance(value, int) else float(f"{value:.{_DIGITS}g}"))
    if _UNITS[key] == "K":
        return dumped(f"{value - ZERO_CELSIUS:.{_DIGITS}g} degC")
    return dumped(si(value, _UNITS[key], _DIGITS))
