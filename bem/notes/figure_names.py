"""Names of figures in tables and notes, which agree so that a note can be found in its table."""

from __future__ import annotations

import re


def figure_name(key: str) -> str:
    """Return a figure of a record, without its unit, in words: `mean_contact_pressure` as `mean contact pressure`."""
    sizes = _MEAN_SIZE.fullmatch(key)
    if sizes is not None:
        weight = "number above a size" if sizes[1] == "number_above" else sizes[1]
        return f"particle {sizes[2].replace('_', ' ')}, mean by {weight}"
    return FIGURE_NAMES.get(key, " ".join(key.split("_")).replace("von mises", "von Mises"))


_MEAN_SIZE = re.compile(r"(number|area|volume|number_above)_mean_(equivalent_radius|length|width|thickness)")
"""Mean sizes of particles by their weight."""

FIGURE_NAMES: dict[str, str] = {
    "friction_first_turn": "friction coefficient, mean of the first repeat of the roughness patch",
    "friction_last_turn": "friction coefficient, mean of the last repeat of the roughness patch",
    "mean_contact_traction": "mean of pressure less attraction in contact",
    "concentration": "concentration of substrate at the surface of the film",
    "share_of_lower": "share of the heat that enters the lower body",
    "load_over_hertz": "load over that of an asperity alone",
    "load_over_hertz_finite_array": "load over that of an asperity alone, of a finite array",
    "lowest_load": "lowest load of the path",
    "jkr_lowest_load": "pull-off force by JKR (soft spheres)",
    "dmt_lowest_load": "pull-off force by DMT (stiff spheres)",
    "tabor_parameter": "Tabor's parameter",
    "friction_work": "friction work per distance rolled",
    "resolved_work": "share of the friction work in its map",
    "Sq": "Sq of both surfaces",
    "Sq_initial": "Sq of the worn body's contact region, initial",
    "Sq_final": "Sq of the worn body's contact region, final",
    "worn_depth": "worn depth of the contact region",
    "largest_worn_depth": "worn depth of the deepest place of the surface",
    "step_error": "largest error of the worn depth of a place, by the last wear step",
    "particles_per_cycle": "particles per cycle of one body",
    "particles_per_distance": "particles per sliding distance, of one body",
    "particles_per_volume": "particles per volume worn from their body",
    "number_mean_radius": "particle equivalent radius, mean by number",
    "area_mean_radius": "particle equivalent radius, mean by area",
    "volume_mean_radius": "particle equivalent radius, mean by volume",
    "number_std_radius": "standard deviation of the particle radius, by number",
    "area_std_radius": "standard deviation of the particle radius, by area",
    "volume_std_radius": "standard deviation of the particle radius, by volume",
    "scattering_mean_radius": "particle equivalent radius, by light scattering",
    "scattering_mean_equivalent_radius": "particle equivalent radius, by light scattering",
    "particles_first_cycle": "particles in the first cycle, of one body",
    "particles_all_cycles": "expected particles of all cycles, of one body",
    "particles_last_cycles": "particles in all of the last cycles, of one body",
    "criterion_wear_rate": "wear volume over load and sliding distance",
    "residual": "solver residual (relative)",
    "lower_Sq": "Sq of the lower surface",
    "upper_Sq": "Sq of the upper surface",
    "lower_Sq_initial": "Sq of the lower surface, initial",
    "lower_Sq_final": "Sq of the lower surface, final",
    "lower_worn_depth": "worn depth of the lower surface",
    "upper_Sq_initial": "Sq of the upper surface, initial",
    "upper_Sq_final": "Sq of the upper surface, final",
    "upper_worn_depth": "worn depth of the upper surface",
    "combined_Sq": "Sq of both surfaces",
    "friction": "friction coefficient",
    "contact_temperature": "surfaces in contact, mean temperature",
    "flash_temperature": "surfaces in contact, highest temperature",
    "traction_coefficient": "friction coefficient",
    "sliding_traction": "sliding friction coefficient",
    "contact_share": "asperity load share",
    "contact_load": "asperity load",
    "minimum_thickness": "minimum film thickness",
    "central_thickness": "central film thickness",
    "minimum_film": "minimum film thickness (under the film's load)",
    "minimum_film_whole": "minimum film thickness (if the film carried the whole load)",
    "lambda_ratio": "lambda ratio (if the film carried the whole load)",
    "lambda_ratio_initial": "lambda ratio (if the film carried the whole load), initial",
    "lambda_ratio_mixed": "lambda ratio (under the film's load)",
}
"""Names that say the region or the definition of a figure, by its key without the unit."""
