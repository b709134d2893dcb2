"""Scenes with rough surfaces of one contact of a machine element: mixed friction, running-in, surface temperature.

The roughness of an element is one number, the rms height of both surfaces together. Its scenes need surfaces: both
bodies get random ones of equal rms height, with the correlation lengths of a usual finish (`FINISHES`), which are
assumed, or with the element's own. These do not depend on the size of the contact; the grid resolves them. With the rms
height they decide how much the asperities carry. Measured surfaces may replace them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bem.elements.contact import ElementContact
from bem.elements.passes import NAMES, Passes, passes_of
from bem.elements.plain_bush import PlainBushModel
from bem.errors import InputError
from bem.grid import Grid
from bem.materials import Body, contact_modulus, softer_hardness
from bem.physical_constants import ROOM_TEMPERATURE
from bem.quantities import si
from bem.scenes.wearing import cycles_of_a_turn
from bem.surfaces.processes import PROCESSES, ProcessName
from bem.wear.criterion.local import cell_to_cell_compliance
from bem.wear.setup import UPPER, wearing_bodies

if TYPE_CHECKING:
    from bem.elements.model import ElementModel


_LINE_HALF_WIDTHS = 4.0
"""Length of the patch of a line contact along the motion, in half-widths of the Hertz contact."""
_POINT_HALF_AXES = 3.0
"""Sides of the patch of a point contact, in half-axes of the Hertz contact."""
_LINE_CELLS = (192, 64)
_POINT_CELLS, _MOST_ELONGATED = 96, 4.0
"""Fewest cells along the shorter side of a point contact, and of the longer one over them."""
"""Fewest cells along and across the motion of a line contact; half of the former lie in it."""
_SLICE_LENGTHS, _FEWEST_LENGTHS = 16.0, 8.0
"""Correlation lengths along a slice of a line contact, and the fewest along any side: a shorter side is no sample of
the roughness."""
FINISHES: dict[str, ProcessName] = {
    "rolling-bearing": "superfinished",
    "gear-pair": "ground",
    "cam-follower": "ground",
    "piston-ring": "honed",
}
"""Usual finish of the surfaces of an element: a process of the catalogue (`bem surfaces`), the lay across the motion.
Plain bushes have a ground shaft of their own (`ground_shaft`)."""

_CELLS_PER_CORRELATION_LENGTH, _LENGTHS_ACROSS, _RUBBED_CELLS, _MOST_CELLS = 3.25, 32, 128, 4096
"""Cells of a bush's slice to the correlation length of its shaft along the sliding; correlation lengths and cells
across it, four to each; most cells along the sliding."""
_CREEP = 1e-3
"""Speed of a bush at rest over the shaft's in scenes of surface temperature."""
_SHIFT, _TURN = 3, 64
"""Cells by which the moving roughness is displaced in a cycle of running-in, as without the key `wear.shift`, and most
cycles in which it is where it was."""
_STABLE_STEP = 0.25
"""Compliance by wear of a cycle of running-in over that from cell to cell, as in scenes of own surfaces."""
_SHORTEST_AVERAGE, _CELLS_PER_AVERAGE = 300e-9, 3
"""Averaging length of the particle criterion where cells are small enough [m], else cells to it."""
_MOST_UNLIKE_CELLS = 1.5
"""Longer over shorter side of a cell up to which particles are sought: they are as large as the longer side allows."""
ASSUMED_SLIDING, ASSUMED_WEAR_RATE, ASSUMED_CYCLES = 0.02, 2e-17, 1_000_000
"""Slide-to-roll ratio of running-in and lives in place of pure rolling (rolling bearings slip by 1 to 3 %). Wear rate
of both without one of the element [m^2/N], as in the template of running-in-life, and cycles of lives."""
_RATE_IN_WORDS = f"the wear rate {1e9 * ASSUMED_WEAR_RATE:g} mm^3/(N*m) is assumed"
_LEAST_SLIDING = 1e-4
_SCAR = 0.5
"""Width of the scar on a body that does not pass over that of the patch, at the end of a life under the whole load: a
flat of width w on a cylinder of radius R takes off w^3 / 12 R by length."""
_DEPTHS, _DEPTHS_PER_AVERAGE = 64, 6.0
"""Number of depths, and depths in an averaging length: half a cell where that is three, as in scenes of own surfaces.
The deepest lies below the largest particles: 3.3 averaging lengths cut 16 % of those of a ground flank, ten none."""


@dataclass(frozen=True)
class Patch:
    """Grid over a Hertz contact.

    Attributes
    ----------
    shape : cells along x and y.
    lengths : sides [m].
    periodic : whether the patch repeats along x and y.
    """

    shape: tuple[int, int]
    lengths: tuple[float, float]
    periodic: tuple[bool, bool]

    def table(self) -> dict[str, Any]:
        """Return the patch as the table [grid] of a scene."""
        return {"shape": list(self.shape), "lengths": list(self.lengths), "periodic": list(self.periodic)}

    @property
    def coarser_spacing(self) -> float:
        """Longer side of a cell [m]."""
        return max(length / cells for length, cells in zip(self.lengths, self.shape, strict=True))


def finish_lengths(model: ElementModel) -> tuple[float, float] | None:
    """Return the correlation lengths along x and y [m] of the surfaces of scenes; None without roughness."""
    if model.rms_roughness is None:
        return None
    if isinstance(model, PlainBushModel):
        return _bush_lengths(model)
    return _lengths_of(FINISHES[model.element], model.correlation_length)


def _lengths_of(name: ProcessName, own: float | None) -> tuple[float, float]:
    """Return the correlation lengths across and along the grooves of a process [m], with the former of one's own."""
    process = PROCESSES[name]
    assert process.across is not None
    assert process.along is not None
    across = own or process.across
    return across, across * process.along / process.across


def finish_words(model: ElementModel) -> str:
    """Return a sentence's part on the finish: process and correlation length across its grooves, if assumed."""
    name = FINISHES.get(model.element, "ground")
    lengths = finish_lengths(model)
    assert lengths is not None
    if model.correlation_length is not None:
        return f"generated roughness has the element's correlation length of {si(min(lengths), 'm')}"
    return (
        f"generated roughness is that of {name} surfaces (correlation length {si(min(lengths), 'm')}), which is "
        "assumed and decides how much the asperities carry: measured surfaces are better"
    )


def _finish(model: ElementModel, rms_height: float) -> dict[str, Any]:
    """Return the table [surface] of a body: random Gaussian heights of an rms value [m], with lengths."""
    name = FINISHES[model.element]
    process = PROCESSES[name]
    found: dict[str, Any] = {"process": name, "rms_height": rms_height}
    if process.directional:
        found["lay"] = "y"
    if (process.skewness, process.kurtosis) != (0.0, 3.0):
        found |= {"skewness": 0.0, "kurtosis": 3.0}
    if model.correlation_length is not None:
        found["correlation_length"] = math.sqrt(math.prod(_lengths_of(name, model.correlation_length)))
    return found


def patch_over(contact: ElementContact, modulus: float, roughness_lengths: tuple[float, float] | None = None) -> Patch:
    """Return the patch that holds the Hertz contact: a slice of a line contact, the whole of a point contact.

    Parameters
    ----------
    contact : of the element.
    modulus : contact modulus [Pa].
    roughness_lengths : correlation lengths along x and y [m], which the cells resolve; None of smooth bodies.
    """
    lengths_x, lengths_y = roughness_lengths or (0.0, 0.0)
    if contact.length is not None:
        side = max(_LINE_HALF_WIDTHS * contact.half_width(modulus), _FEWEST_LENGTHS * lengths_x)
        nx, ny = _LINE_CELLS
        across = side * ny / nx
        if lengths_y:
            across = max(min(_SLICE_LENGTHS * lengths_y, contact.length), _FEWEST_LENGTHS * lengths_y)
        return Patch((_cells(side, lengths_x, nx), _cells(across, lengths_y, ny)), (side, across), (False, True))
    semi_axes = contact.hertz(modulus).semi_axes  # type: ignore[union-attr]
    shortest = min(semi_axes)
    least = [16 * round(_POINT_CELLS / 16 * min(math.sqrt(a / shortest), _MOST_ELONGATED)) for a in semi_axes]
    sides, cells = [], []
    for axis, fewest, length in zip(semi_axes, least, (lengths_x, lengths_y), strict=True):
        own = _POINT_HALF_AXES * axis
        sides.append(max(own, _FEWEST_LENGTHS * length))
        cells.append(_cells(sides[-1], length, math.ceil(fewest * sides[-1] / own)))
    return Patch((cells[0], cells[1]), (sides[0], sides[1]), (False, False))


def _cells(side: float, roughness_length: float, fewest: int) -> int:
    """Return a multiple of 16 cells along a side [m] that resolve a correlation length [m]; 0 of smooth bodies."""
    wanted = 0.0 if roughness_length == 0 else _CELLS_PER_CORRELATION_LENGTH * side / roughness_length
    return min(16 * math.ceil(max(wanted, fewest) / 16 * (1 - 1e-9)), _MOST_CELLS)


def rough_bodies(model: ElementModel, bodies: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    """Return both bodies' tables with random surfaces of the element's rms height together; smooth without one.

    All the roughness of a bush is that of its ground shaft.
    """
    found = {name: dict(body) for name, body in bodies.items()}
    if model.rms_roughness is None:
        return found
    if isinstance(model, PlainBushModel):
        found["lower"]["surface"] = ground_shaft(model)
        return found
    surface = _finish(model, model.rms_roughness / math.sqrt(2))
    return {name: {**body, "surface": dict(surface)} for name, body in found.items()}


def mixed_scene(
    model: ElementModel,
    contact: ElementContact,
    bodies: Mapping[str, Mapping[str, Any]],
    oil: Mapping[str, Any],
    kind: str,
    modulus: float,
) -> tuple[dict[str, Any], list[str]]:
    """Keys of a scene of kind friction or running-in, and what is assumed in it, in words.

    Load, speed and supply are those of one place of the element. In pure rolling nothing wears, so that a
    slide-to-roll ratio is assumed for running-in.

    Parameters
    ----------
    model : the element.
    contact : its place.
    bodies : tables of `lower` and `upper` with their materials.
    oil : the element's table of the oil.
    kind : "friction", "running-in" or "running-in-life".
    modulus : contact modulus [Pa].

    Raises
    ------
    InputError : an element without roughness.
    """
    if model.rms_roughness is None:
        raise InputError(
            f"{model.name}: kind {kind} needs the roughness of the surfaces; allowed: rms_roughness of both together, "
            'such as "300 nm"'
        )
    patch, ratio, assumed = patch_over(contact, modulus, finish_lengths(model)), contact.slide_roll_ratio, []
    if kind != "friction" and abs(ratio) < _LEAST_SLIDING:
        ratio = ASSUMED_SLIDING
        assumed.append(f"slide-to-roll ratio {ratio:g} is assumed in place of pure rolling, in which nothing wears")
    shape: dict[str, Any] = {"radii": [contact.radius, contact.across]}
    if contact.length is not None:
        shape = {"radius": contact.radius, "width": contact.length}
    flat_speed = abs(contact.mean_speed) * (1 + 0.5 * ratio)
    made: dict[str, Any] = {
        "thermal": _thermal(model, contact),
        **rough_bodies(model, bodies),
        "contact": {**shape, "loads": [contact.load], "boundary_friction": model.boundary_friction},
        "oil": dict(oil),
        "speeds": {"values": [flat_speed], "slide_roll_ratio": ratio},
        **({"supply": {"distance": contact.inlet}} if math.isfinite(contact.inlet) else {}),
        "grid": patch.table(),
    }
    sharing: dict[str, Any] = {"oil_volume": "loaded"}
    if kind == "friction":
        if hardness_of(model) is None:
            sharing["models"] = ["elastic"]
        return made | {"sharing": sharing}, assumed
    made |= {"sharing": sharing}
    if kind == "running-in":
        if not model.specific_wear_rate:
            assumed.append(_RATE_IN_WORDS)
        return made | _running_in(model, patch, modulus, rolls=contact.speeds[1] != 0), assumed
    return made, assumed


def _running_in(model: ElementModel, patch: Patch, modulus: float, *, rolls: bool) -> dict[str, Any]:
    """Return the keys of running-in: Archard's wear, which smooths summits, with the particles of a criterion.

    The body that wears moves through the contact, so that its whole track wears, where both bodies do (`rolls`).

    Along grooves, where the cells are much longer than across them, no criterion could tell particles from cells.

    modulus : contact modulus of the scene's bodies [Pa].

    A cycle wears as much as keeps the step stable, half the compliance by which the bodies give way from cell to cell;
    the run has two turns of the moving roughness, and means over one.
    """
    rate = model.specific_wear_rate or ASSUMED_WEAR_RATE
    cell = (patch.lengths[0] / patch.shape[0], patch.lengths[1] / patch.shape[1])
    bodies = Body(model.first.build()), Body(model.second.build())
    compliance = cell_to_cell_compliance(Grid((32, 32), cell), bodies)
    compliance *= contact_modulus(model.first.build(), model.second.build()) / modulus
    distance = _STABLE_STEP * compliance / rate
    shift = max(_SHIFT, round(patch.shape[0] / _TURN))
    turn = cycles_of_a_turn(patch.shape, shift)
    particles: dict[str, Any] = {}
    alike_cells = max(cell) <= _MOST_UNLIKE_CELLS * min(cell)
    averaged = averaging_length(max(cell) if alike_cells else min(cell))
    if alike_cells:
        particles["particle_criterion"] = {"kind": "averaged_von_mises", "averaging_length": averaged}
    alike = bodies[0].surface_material.yield_stress == bodies[1].surface_material.yield_stress
    return {
        "wear": {
            **({"wears": "lower"} if alike else {}),
            **({"frame": "disk"} if rolls and wearing_bodies(bodies, "softer") == (UPPER,) else {}),
            "criterion": {
                "kind": "archard",
                "specific_wear_rate": f"{1e9 * rate:.6g} mm^3/(N*m)",
                "distance": float(f"{distance:.2g}"),
            },
            **particles,
            **({} if shift == _SHIFT else {"shift": shift}),
        },
        "depths": {"count": _DEPTHS, "spacing": averaged / _DEPTHS_PER_AVERAGE},
        "cycles": {"count": 2 * turn, "averaged": turn, "settled": turn},
    }


def averaging_length(cell: float) -> float:
    """Return the averaging length of the particle criterion on cells of a side [m]."""
    return max(_SHORTEST_AVERAGE, _CELLS_PER_AVERAGE * cell)


def life_scene(
    model: ElementModel,
    contact: ElementContact,
    bodies: Mapping[str, Mapping[str, Any]],
    oil: Mapping[str, Any],
    modulus: float,
    rates: tuple[float | None, float | None],
) -> tuple[dict[str, Any], list[str]]:
    """Return the keys of a scene of kind running-in-life, see `mixed_scene`, and what is assumed in it, in words.

    Wear is Archard's with the element's rate. A cycle is a pass of body 1; each body slides in it by its own speed and
    passes (`passes_of`). rates : passes of a place of either body per time [1/s]; None if not known.

    Raises
    ------
    InputError : as `mixed_scene`; a point contact.
    """
    if contact.length is None:
        raise InputError(
            f"{contact.name}: kind running-in-life has line contacts alone; allowed: kind running-in under a ball"
        )
    made, assumed = mixed_scene(model, contact, bodies, oil, "running-in-life", modulus)
    rate = model.specific_wear_rate
    if not rate:
        rate = ASSUMED_WEAR_RATE
        assumed.append(_RATE_IN_WORDS)
    passes = passes_in(made, model, rates)
    lower, upper = passes.slid
    law: dict[str, Any] = {"kind": "archard", "specific_wear_rate": f"{1e9 * rate:.6g} mm^3/(N*m)"}
    wear: dict[str, Any] = {"law": law | {"distance": lower}}
    if upper:
        wear["law"]["upper_over_lower"] = upper / lower
    else:
        wear["wears"] = "lower"
    count = ASSUMED_CYCLES
    if passes.moves != "both":
        wear["passes"] = passes.moves
        if upper:
            worn = rate * contact.load / contact.length * upper  # area of the scar's section in a cycle [m^2]
            most = (_SCAR * made["grid"]["lengths"][0]) ** 3 / (12 * contact.radius * worn)
            count = int(min(float(f"{most:.1g}"), count)) or 1
            if count < ASSUMED_CYCLES:
                body = NAMES[model.element][1]
                assumed.append(f"the cycles keep the scar of the {body} within half the patch")
    keys = {name: value for name, value in made.items() if name != "sharing"}
    return keys | {"wear": wear, "life": {"count": count}}, assumed


def passes_in(made: Mapping[str, Any], model: ElementModel, rates: tuple[float | None, float | None]) -> Passes:
    """Return the sliding and passes of both bodies over the patch of a scene of `mixed_scene`.

    Parameters
    ----------
    made : keys of the scene.
    model : the element.
    rates : passes of a place of either body per time [1/s]; None if not known.
    """
    (lower,), half = made["speeds"]["values"], 0.5 * made["speeds"]["slide_roll_ratio"]
    return passes_of(model, rates, (lower, lower * (1 - half) / (1 + half)), made["grid"]["lengths"][0])


def bush_scene(
    model: PlainBushModel, contact: ElementContact, oil: Mapping[str, Any], shaft: Any, bush: Any
) -> dict[str, Any]:
    """Return the keys of a scene of kind friction of a bush: a ground shaft, whose roughness repeats along the contact.

    Film and Hertz contact have the modulus with which a cylinder on a half-space is as wide as on the wall. Asperities
    are small against the wall and deform the bush's own material.

    Parameters
    ----------
    model : the bush.
    contact : its equivalent cylinder.
    oil : the element's table of the oil.
    shaft, bush : materials as the element has them.

    Raises
    ------
    InputError : an element without roughness.
    """
    if model.rms_roughness is None:
        raise InputError(
            f"{model.name}: kind friction needs the roughness of the surfaces; allowed: rms_roughness of both "
            'together, such as "300 nm"'
        )
    ratio = contact.slide_roll_ratio
    sharing: dict[str, Any] = {"oil_volume": "loaded"}
    if hardness_of(model) is None:
        sharing["models"] = ["elastic"]
    if model.wall is not None:
        sharing["film_modulus"] = model.film_modulus
    return {
        "thermal": _thermal(model, contact),
        "lower": {"material": shaft, "surface": ground_shaft(model)},
        "upper": {"material": bush},
        "contact": {
            "radius": contact.radius,
            "width": contact.length,
            "loads": [contact.load],
            "boundary_friction": model.boundary_friction,
        },
        "oil": dict(oil),
        "speeds": {"values": [abs(contact.mean_speed) * (1 + 0.5 * ratio)], "slide_roll_ratio": ratio},
        **({"supply": {"distance": contact.inlet}} if math.isfinite(contact.inlet) else {}),
        "sharing": sharing,
    }


def ground_shaft(model: PlainBushModel) -> dict[str, Any]:
    """Return the table [surface] of a ground shaft with the roughness of both bodies.

    Grooves of a shaft that is ground as it turns lie along the sliding, x.
    """
    across, along = ground_lengths(model)
    found: dict[str, Any] = {"process": "ground", "lay": "x" if model.lay == "around" else "y"}
    found["rms_height"] = model.rms_roughness
    if model.correlation_length is not None:
        found["correlation_length"] = math.sqrt(across * along)
    return found


def _bush_lengths(model: PlainBushModel) -> tuple[float, float]:
    """Return the correlation lengths of the shaft along and across the sliding [m]."""
    across, along = ground_lengths(model)
    return (along, across) if model.lay == "around" else (across, along)


def ground_lengths(model: PlainBushModel) -> tuple[float, float]:
    """Return the correlation lengths across and along the grooves [m]."""
    return _lengths_of("ground", model.correlation_length)


def bush_rubbing_scene(
    model: PlainBushModel,
    contact: ElementContact,
    bodies: Mapping[str, Mapping[str, Any]],
    *,
    modulus: float,
    friction: float,
    bulk: float,
) -> dict[str, Any]:
    """Return the keys of a scene of kind surface-temperature of a bush: a slice with the ground shaft.

    Under an endless line a body at rest has no steady temperature: the bush creeps at a thousandth of the shaft's
    speed. A hundred times faster or slower moves the rise of a steel shaft in PEEK by 2 %, as the shaft takes the heat.

    Parameters
    ----------
    model : the bush.
    contact : its equivalent cylinder.
    bodies : tables of `lower` and `upper` with their materials.
    modulus : contact modulus [Pa] of the contact's width.
    friction : coefficient.
    bulk : temperature of both bodies [K].
    """
    assert contact.length is not None
    side = _LINE_HALF_WIDTHS * contact.half_width(modulus)
    made = {name: dict(body) for name, body in bodies.items()}
    shape, width = (128, 32), side / 4
    if model.rms_roughness is not None:
        made["lower"]["surface"] = ground_shaft(model)
        along_x, along_y = _bush_lengths(model)
        cells = 16 * math.ceil(side / along_x * _CELLS_PER_CORRELATION_LENGTH / 16)
        shape, width = (min(max(cells, 128), _MOST_CELLS), _RUBBED_CELLS), _LENGTHS_ACROSS * along_y
    patch = Patch(shape, (side, width), (False, True))
    speed = contact.speeds[0]
    return {
        "grid": patch.table(),
        **made,
        "shape": {"kind": "cylinder", "radius": contact.radius},
        "contact": {
            "load": contact.load * width / contact.length,
            "behaviour": "elastic" if hardness_of(model) is None else "capped",
            "friction": friction,
        },
        "heat": {
            "lower_speed": speed,
            "upper_speed": _CREEP * speed,
            "lower_bulk": bulk,
            "upper_bulk": bulk,
        },
    }


def rubbing_scene(
    model: ElementModel, contact: ElementContact, bodies: Mapping[str, Mapping[str, Any]], modulus: float
) -> dict[str, Any]:
    """Return the keys of a scene of kind surface-temperature; see `mixed_scene`.

    A line contact is a slice that repeats along its length. Under a body at rest the heat of an endless line has no
    steady temperature, so that there the patch stands alone, as long as it is wide.
    """
    lengths = finish_lengths(model)
    patch = patch_over(contact, modulus, lengths)
    load = contact.load
    if contact.length is not None:
        if 0 in contact.speeds:
            side = patch.lengths[0]
            nx, ny = (_cells(side, length, 128) for length in lengths or (0.0, 0.0))
            patch = Patch((nx, ny), (side, side), (False, False))
        load *= patch.lengths[1] / contact.length
    curved: dict[str, Any] = {"kind": "ellipsoid", "radius": contact.radius, "radius_y": contact.across}
    if contact.length is not None:
        curved = {"kind": "cylinder", "radius": contact.radius}
    oil = model.film_oil
    bulk = model.bulk_temperature or (ROOM_TEMPERATURE if oil is None or oil.temperature is None else oil.temperature)
    return {
        "grid": patch.table(),
        **rough_bodies(model, bodies),
        "shape": curved,
        "contact": {
            "load": load,
            "behaviour": "elastic" if hardness_of(model) is None else "capped",
            "friction": model.boundary_friction,
        },
        "heat": {
            "lower_speed": contact.speeds[0],
            "upper_speed": contact.speeds[1],
            "lower_bulk": bulk,
            "upper_bulk": bulk,
        },
    }


def hardness_of(model: ElementModel) -> float | None:
    """Return the hardness of the softer material [Pa]; None where neither material has one."""
    return softer_hardness(Body(model.first.build()), Body(model.second.build()))


def _thermal(model: ElementModel, contact: ElementContact) -> str:
    """Return the heat of a film between rough surfaces; across the film it is known for line contacts alone."""
    if not conducts(model):
        return "off"
    return "lumped" if model.thermal == "full" and contact.length is None else model.thermal


def conducts(model: ElementModel) -> bool:
    """True if the lumped heat of the film is defined: both materials have a thermal diffusivity, the oil its
    constants."""
    from bem.friction.setup import HEAT_NEEDS

    assert model.film_oil is not None
    lubricant = model.film_oil.build()
    materials = (model.first.build(), model.second.build())
    return all(one.thermal_diffusivity for one in materials) and all(
        getattr(lubricant, key) is not None for key in HEAT_NEEDS
    )
