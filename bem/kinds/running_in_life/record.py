"""Record of a case of kind `running-in-life`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

from bem.grid import FloatArray
from bem.kinds.running_in_life.scene import RunningInLifeScene
from bem.scenes.axes import Axis
from bem.scenes.records import LAMBDA_WHOLE, MINIMUM_FILM, OIL, OIL_SCATTER, Figure, GridRecord, Series, grid_map
from bem.scenes.tables.sharing import heated

_over, _shown = partial(Series, ("cycle",)), partial(grid_map, of="first")
_step = partial(Series, ("step",), rows=True)
_PITS = "it follows the stresses of single cells, the positions that sample a pass, and the surfaces drawn"
_COUNTS = "pieces follow the mesh under most criteria; see kind wear"


@dataclass(frozen=True, eq=False)
class RunningInLifeRecord(GridRecord):
    """A life: friction, roughness, film and wear from its first cycle to its last, and the jumps that led there."""

    friction_initial: Annotated[float, Figure("", "friction coefficient of the unworn surfaces", headline=True)]
    friction_final: Annotated[float, Figure("", "friction coefficient at the end", headline=True)]
    oil_scatter: Annotated[
        float | None, Figure("", OIL_SCATTER, name=f"friction_final{OIL}", optional=True, unjudged=True)
    ]
    lower_Sq_initial: Annotated[float, Figure("nm", "Sq of the whole lower surface, unworn", headline=True)]
    lower_Sq_final: Annotated[
        float, Figure("nm", "Sq of the whole lower surface at the end, its film on it", headline=True)
    ]
    lower_worn_depth: Annotated[float, Figure("nm", "mean depth worn of the whole lower surface", headline=True)]
    Sq_initial: Annotated[float, Figure("nm", "second name of lower_Sq_initial")]
    Sq_final: Annotated[float, Figure("nm", "second name of lower_Sq_final")]
    worn_depth: Annotated[float, Figure("nm", "second name of lower_worn_depth")]
    upper_Sq_initial: Annotated[float, Figure("nm", "Sq of the whole upper surface, unworn", headline=True)]
    upper_Sq_final: Annotated[float, Figure("nm", "Sq of the whole upper surface at the end", headline=True)]
    upper_worn_depth: Annotated[float, Figure("nm", "mean depth worn of the whole upper surface")]
    lambda_ratio_initial: Annotated[float, Figure("", f"{LAMBDA_WHOLE}, unworn")]
    lambda_ratio: Annotated[float, Figure("", f"{LAMBDA_WHOLE}, at the end", headline=True)]
    contact_share_initial: Annotated[float, Figure("", "asperity load share, unworn")]
    contact_share_final: Annotated[float, Figure("", "asperity load share at the end")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over the patch, at the end")]
    minimum_film: Annotated[float, Figure("nm", f"{MINIMUM_FILM}, at the end")]
    wear_volume: Annotated[float, Figure("um3", "volume worn of both surfaces of the patch", headline=True)]
    contact_temperature: Annotated[float | None, heated("surfaces in contact, mean by pressure, at the end")]
    flash_temperature: Annotated[float | None, heated("surfaces in contact, highest, at the end")]
    tribofilm_thickness: Annotated[float | None, Figure("nm", "mean thickness of the tribofilm", optional=True)]
    particles: Annotated[
        float | None, Figure("", "pieces that carry away what wore of the lower body", optional=True, no_bar=_COUNTS)
    ]
    particle_equivalent_radius: Annotated[
        float | None,
        Figure("nm", "equivalent radius of the mean volume of pieces, over the life", optional=True, no_bar=_COUNTS),
    ]
    micropitted_share: Annotated[
        float | None,
        Figure("", "share of the surface with a voxel without life left", optional=True, no_bar=_PITS, headline=True),
    ]
    micropitted_at_most: Annotated[
        float | None,
        Figure("", "the same with the larger damage of either end of each jump", optional=True, unjudged=True),
    ]
    micropitted_at_least: Annotated[
        float | None,
        Figure("", "the same with the smaller, position by position instead of one path", optional=True, unjudged=True),
    ]
    largest_damage: Annotated[
        float | None, Figure("", "largest share of a voxel's life that is used up", optional=True, no_bar=_PITS)
    ]
    jump_error: Annotated[float, Figure("nm", "what the jumps leave open of the mean depths worn", unjudged=True)]
    jumps: Annotated[int, Figure("", "jumps taken", unjudged=True)]
    jumps_rejected: Annotated[int, Figure("", "jumps made shorter", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions of all contacts", unjudged=True)]
    cycle: Annotated[FloatArray, _over("1", "cycle")]
    friction_over_cycles: Annotated[FloatArray, _over("1", "friction coefficient")]
    boundary_friction_over_cycles: Annotated[FloatArray, _over("1", "boundary part of the friction coefficient")]
    contact_share: Annotated[FloatArray, _over("1", "asperity load share")]
    minimum_film_over_cycles: Annotated[FloatArray, _over("m", MINIMUM_FILM)]
    lambda_over_cycles: Annotated[FloatArray, _over("1", LAMBDA_WHOLE)]
    lower_rms_over_cycles: Annotated[FloatArray, _over("m", "Sq of the lower surface, its film on it")]
    upper_rms_over_cycles: Annotated[FloatArray, _over("m", "Sq of the upper surface")]
    lower_depth_over_cycles: Annotated[FloatArray, _over("m", "mean depth worn of the lower surface")]
    upper_depth_over_cycles: Annotated[FloatArray, _over("m", "mean depth worn of the upper surface")]
    depth_error_over_cycles: Annotated[FloatArray, _over("m", "what the jumps leave open of the mean depths worn")]
    flash_temperature_over_cycles: Annotated[FloatArray | None, _over("K", "highest temperature of the contact")]
    tribofilm_over_cycles: Annotated[FloatArray | None, _over("m", "mean thickness of the tribofilm")]
    particles_over_cycles: Annotated[
        FloatArray | None, _over("1", "pieces so far, of steps in which the criterion finds any")
    ]
    micropitted_over_cycles: Annotated[FloatArray | None, _over("1", "micropitted share of the surface")]
    step_cycle: Annotated[FloatArray, _step("1", "cycles after a jump")]
    step_length: Annotated[FloatArray, _step("1", "cycles of a jump")]
    step_error: Annotated[FloatArray, _step("1", "error of a jump over what wore in it")]
    height_before: Annotated[FloatArray, _shown("m", "height of the lower surface, unworn")]
    height_after: Annotated[FloatArray, _shown("m", "height of the lower surface at the end, its film left out")]
    pressure: Annotated[FloatArray, _shown("Pa", "contact pressure in one of the last positions")]
    film_map: Annotated[FloatArray | None, _shown("m", "local thickness of the tribofilm at the end")]
    damage_map: Annotated[FloatArray | None, _shown("1", "largest damage below each place at the end")]


def summarise(scene: RunningInLifeScene, axes: Sequence[Axis], records: Sequence[Any]) -> dict[str, Any]:
    """Summarise what is the same for all cases."""
    return {"cycles": scene.life.count, "load_N": scene.load}
