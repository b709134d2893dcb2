"""Record of a case of kind `contact`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray
from bem.materials import Body
from bem.scenes.records import Figure, GridRecord, Series, grid_map
from bem.scenes.wheel_rail import WheelRailRecord

if TYPE_CHECKING:
    from bem.kinds.contact.scene import ContactScene

_coating = partial(Figure, optional=True, headline=True)
_interfaces = partial(_coating, dimensions=("interface",))
_sphere = partial(Figure, optional=True, headline=True, unjudged=True)
_layers = partial(_coating, dimensions=("layer",))
_place = partial(Figure, "m", optional=True, unjudged=True)
_at_interface = partial(_place, dimensions=("interface",))
_in_layer = partial(_place, dimensions=("layer",))


def layer_names(body: Body) -> tuple[str, ...]:
    """Names of the layers' materials, outermost first; a material without a name is called by its layer's number."""
    return tuple(layer.material.name or f"layer {number}" for number, layer in enumerate(body.layers, 1))


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactRecord(GridRecord, WheelRailRecord):
    """A solved contact, and the stresses below it where they are asked for."""

    lowest_load: Annotated[
        float | None,
        Figure(
            "N", "lowest load on the path; minus the pull-off force if the bodies part", optional=True, headline=True
        ),
    ] = None
    jkr_lowest_load: Annotated[
        float | None, _sphere("N", "minus the pull-off force of a sphere by Johnson, Kendall and Roberts (soft)")
    ] = None
    dmt_lowest_load: Annotated[
        float | None, _sphere("N", "minus the pull-off force of a sphere by Derjaguin, Muller and Toporov (stiff)")
    ] = None
    tabor_parameter: Annotated[
        float | None, _sphere("", "Tabor's parameter of a sphere: JKR holds far above one, DMT far below")
    ] = None
    load: Annotated[float, Figure("N", "load", headline=True)]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid", headline=True)]
    plastic_area_fraction: Annotated[
        float,
        Figure("", "area at the hardness over that of the grid", headline=True, part_of=("contact_area_fraction",)),
    ]
    contact_area: Annotated[float, Figure("m2", "real contact area")]
    counted_contact_area_fraction: Annotated[float, Figure("", "cells in contact over all", unjudged=True)]
    counted_plastic_area_fraction: Annotated[float, Figure("", "cells at the hardness over all", unjudged=True)]
    contact_spots: Annotated[int, Figure("", "separate spots of contact", unjudged=True)]
    contact_perimeter: Annotated[float, Figure("m", "length of the edges of contact")]
    mean_contact_pressure: Annotated[
        float,
        Figure("Pa", "mean pressure over the real contact area; with adhesion without the attraction", headline=True),
    ]
    max_pressure: Annotated[
        float, Figure("Pa", "maximum pressure; with adhesion without the attraction", headline=True)
    ]
    max_pressure_of_cells: Annotated[float, Figure("Pa", "maximum pressure of a cell", unjudged=True)]
    approach: Annotated[float, Figure("m", "approach from first touch", headline=True)]
    mean_gap: Annotated[float, Figure("m", "mean of the open gap")]
    residual: Annotated[float, Figure("", "relative residual", headline=True, unjudged=True)]
    iterations: Annotated[int, Figure("", "iterations", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions", unjudged=True)]
    lower_Sq: Annotated[float | None, Figure("m", "Sq of the lower surface", optional=True, unjudged=True)] = None
    upper_Sq: Annotated[float | None, Figure("m", "Sq of the upper surface", optional=True, unjudged=True)] = None
    combined_Sdq: Annotated[
        float | None, Figure("", "rms slope of both surfaces together", optional=True, unjudged=True)
    ] = None
    contact_spots_of_map: Annotated[
        int | None,
        Figure("", "separate spots of contact on one of the mirrored copies of a map", optional=True, unjudged=True),
    ] = None
    reduced_pressure: Annotated[
        float | None,
        Figure("", "nominal pressure over contact modulus and rms slope", optional=True, unjudged=True),
    ] = None
    plasticity_index: Annotated[
        float | None,
        Figure("", "plasticity index of Greenwood and Williamson", optional=True, headline=True, unjudged=True),
    ] = None
    slope_plasticity_index: Annotated[
        float | None, Figure("", "plasticity index of Mikic, by the rms slope", optional=True, unjudged=True)
    ] = None
    max_von_mises: Annotated[float | None, Figure("Pa", "maximum von Mises stress", optional=True, headline=True)] = (
        None
    )
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of the maximum stress", optional=True)] = None
    max_von_mises_of_points: Annotated[
        float | None, Figure("Pa", "maximum von Mises stress of a point", optional=True, unjudged=True)
    ] = None
    yielded_volume: Annotated[float | None, Figure("m3", "volume beyond the yield stress", optional=True)] = None
    counted_yielded_volume: Annotated[
        float | None, Figure("m3", "that of whole cells", optional=True, unjudged=True)
    ] = None
    interface_depth: Annotated[
        FloatArray | None,
        Figure("m", "depth of each interface", ("interface",), optional=True, headline=True, unjudged=True),
    ] = None
    interface_max_shear: Annotated[FloatArray | None, _interfaces("Pa", "maximum shear stress across interfaces")] = (
        None
    )
    interface_max_tension: Annotated[
        FloatArray | None, _interfaces("Pa", "maximum tension across interfaces", part_of=("max_pressure",))
    ] = None
    layer_max_von_mises: Annotated[FloatArray | None, _layers("Pa", "maximum von Mises stress in each layer")] = None
    layer_max_tension: Annotated[FloatArray | None, _layers("Pa", "maximum principal stress in each layer")] = None
    layer_yield_ratio: Annotated[
        FloatArray | None,
        _layers("", "maximum von Mises stress in each layer over its yield stress", unjudged=True),
    ] = None
    substrate_max_von_mises: Annotated[float | None, _coating("Pa", "maximum von Mises stress below the layers")] = None
    substrate_yield_ratio: Annotated[
        float | None, _coating("", "that over the yield stress of the material there", unjudged=True)
    ] = None
    interface_max_shear_x: Annotated[
        FloatArray | None, _at_interface("x of the highest shear stress across each interface")
    ] = None
    interface_max_shear_y: Annotated[
        FloatArray | None, _at_interface("y of the highest shear stress across each interface")
    ] = None
    interface_max_tension_x: Annotated[
        FloatArray | None, _at_interface("x of the highest tension across each interface")
    ] = None
    interface_max_tension_y: Annotated[
        FloatArray | None, _at_interface("y of the highest tension across each interface")
    ] = None
    layer_max_von_mises_x: Annotated[
        FloatArray | None, _in_layer("x of the maximum von Mises stress in each layer")
    ] = None
    layer_max_von_mises_y: Annotated[
        FloatArray | None, _in_layer("y of the maximum von Mises stress in each layer")
    ] = None
    layer_max_von_mises_depth: Annotated[
        FloatArray | None, _in_layer("depth of the maximum von Mises stress in each layer")
    ] = None
    layer_max_tension_x: Annotated[FloatArray | None, _in_layer("x of the maximum principal stress in each layer")] = (
        None
    )
    layer_max_tension_y: Annotated[FloatArray | None, _in_layer("y of the maximum principal stress in each layer")] = (
        None
    )
    layer_max_tension_depth: Annotated[
        FloatArray | None, _in_layer("depth of the maximum principal stress in each layer")
    ] = None
    substrate_max_von_mises_x: Annotated[float | None, _place("x of the maximum von Mises stress below the layers")] = (
        None
    )
    substrate_max_von_mises_y: Annotated[float | None, _place("y of the maximum von Mises stress below the layers")] = (
        None
    )
    substrate_max_von_mises_depth: Annotated[
        float | None, _place("depth of the maximum von Mises stress below the layers")
    ] = None
    mean_contact_traction: Annotated[
        float | None,
        Figure(
            "Pa",
            "mean of pressure less attraction over the real contact area of an adhesive contact",
            optional=True,
            headline=True,
        ),
    ] = None
    lateral_force: Annotated[
        float | None,
        Figure("N", "resultant of the pressures on the rail across the load, to the right", optional=True),
    ] = None
    adhesive_energy: Annotated[float | None, Figure("J", "elastic and adhesive energy", optional=True)] = None
    hysteresis_friction: Annotated[
        float | None, Figure("", "friction coefficient of hysteresis", optional=True, headline=True)
    ] = None
    hysteresis_force: Annotated[float | None, Figure("N", "friction force of hysteresis", optional=True)] = None
    dissipated_power: Annotated[
        float | None, Figure("W", "power that the memory of the bodies dissipates", optional=True)
    ] = None
    dissipated_energy: Annotated[
        float | None, Figure("J", "energy dissipated in the bodies on the path", optional=True)
    ] = None
    energy_imbalance: Annotated[
        float | None, Figure("", "work that is neither stored nor dissipated", optional=True, unjudged=True)
    ] = None
    contact_speed: Annotated[
        float | None, Figure("m_s", "speed of steady sliding or rolling", optional=True, unjudged=True)
    ] = None
    layer_residual_stress: Annotated[
        FloatArray | None,
        _layers("Pa", "residual stress of each layer, which the other stresses include", unjudged=True),
    ] = None
    pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure")]
    displacement: Annotated[FloatArray, grid_map("m", "normal displacement of both bodies together")]
    gap: Annotated[FloatArray, grid_map("m", "gap between the deformed surfaces")]
    contact_state: Annotated[NDArray[np.int8], grid_map("1", "0 open, 1 elastic, 2 capped")]
    undeformed_gap: Annotated[FloatArray, grid_map("m", "gap before deformation, zero at first touch")]
    plastic_depth: Annotated[FloatArray | None, grid_map("m", "overlap of the surfaces where capped")] = None
    lower_height: Annotated[FloatArray | None, grid_map("m", "height of the lower surface")] = None
    upper_height: Annotated[FloatArray | None, grid_map("m", "height of the upper surface")] = None
    iteration: Annotated[NDArray[np.int64] | None, Series(("iteration",), "1", "iteration")] = None
    residual_history: Annotated[
        FloatArray | None, Series(("iteration",), "1", "relative residual of the contact solver")
    ] = None
    depth: Annotated[FloatArray | None, Series(("depth",), "m", "depth below the surface")] = None
    von_mises: Annotated[FloatArray | None, Series(("depth", "x", "y"), "Pa", "von Mises stress")] = None
    component: Annotated[list[str] | None, Series(("component",), "1", "component of the stress")] = None
    stress: Annotated[
        FloatArray | None, Series(("component", "depth", "x", "y"), "Pa", "stress, positive in tension")
    ] = None
    attraction: Annotated[FloatArray | None, grid_map("Pa", "attraction by adhesion")] = None
    lowest_load_pressure: Annotated[
        FloatArray | None, grid_map("Pa", "contact pressure at the lowest load of a path that ends apart")
    ] = None
    path_time: Annotated[FloatArray | None, Series(("step",), "s", "time on the path")] = None
    path_load: Annotated[
        FloatArray | None,
        Series(("step",), "N", "load on the path, with steps added about an adhesive path's lowest load"),
    ] = None
    path_approach: Annotated[FloatArray | None, Series(("step",), "m", "approach on the path")] = None
    path_contact_area: Annotated[FloatArray | None, Series(("step",), "m^2", "contact area on the path")] = None
    path_jump: Annotated[NDArray[np.int8] | None, Series(("step",), "1", "1 for a step in which the contact jumps")] = (
        None
    )


def summarise(scene: ContactScene, axes: Any, records: Sequence[ContactRecord | None]) -> dict[str, Any]:
    """Return the names of the layers, outermost first, where a case has stresses by layer, and what the lowest load of
    an adhesive path is: "pull-off", "in contact" where the bodies did not part, "borne" before a load that pulls them
    apart, or "mixed" over the cases."""
    found: dict[str, Any] = {}
    if any(record is not None and record.layer_max_von_mises is not None for record in records):
        found["layer_material"] = list(layer_names(scene.stressed()[0]))
    ends = {_end_of_path(one) for one in records if one is not None and one.lowest_load is not None}
    if ends:
        found["lowest_load_is"] = "mixed" if len(ends) > 1 else ends.pop()
    return found


def _end_of_path(record: ContactRecord) -> str:
    """Return what the lowest load of an adhesive path is, see `summarise`."""
    from bem.adhesion.figures import passes_pull_off

    load, approach, area = record.path_load, record.path_approach, record.path_contact_area
    assert load is not None
    assert approach is not None
    assert area is not None
    if record.status is Status.INFEASIBLE:
        return "borne"
    return "pull-off" if passes_pull_off(load, approach, area) else "in contact"
