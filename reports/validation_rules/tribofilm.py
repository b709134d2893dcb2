"""Our numbers and verdicts for the lines on paper E: the tribofilm."""

from __future__ import annotations

from reports.validation_values import READING, Rule, at, echo, listed

RULES: dict[str, Rule] = {
    "wear_depth_45_to_120_min_at_60_and_100_c_nm": Rule(
        lambda s: f"{at(s, 'wear_depth_nm', 0)} and {at(s, 'wear_depth_nm', 2)}",
        echo,
    ),
    "film_thickness_rises_with_temperature_nm": Rule(
        lambda s: listed([at(s, "film_thickness_nm", i) for i in range(3)]),
        lambda s: s["film_thickness_nm"][0] < s["film_thickness_nm"][1] < s["film_thickness_nm"][2],
    ),
    "film_wear_rate_rises_with_temperature_nm_s": Rule(
        lambda s: listed([at(s, "film_wear_rate_nm_s", i) for i in range(3)]),
        lambda s: s["film_wear_rate_nm_s"][0] < s["film_wear_rate_nm_s"][1] < s["film_wear_rate_nm_s"][2],
    ),
    "substrate_wear_between_45_and_120_min_falls": Rule(
        lambda s: listed([at(s, "wear_depth_nm", i) for i in range(3)]),
        echo,
    ),
    "afm_tip_plateau_with_and_without_delay_is_the": Rule(
        lambda s: (
            f"{at(s, 'film_thickness_nm', 1)} and {at(s, 'film_thickness_nm', 2)}, largest mean with delay "
            f"{at(s, 'largest_mean_thickness_nm', 2)}"
        ),
        lambda s: (
            abs(s["film_thickness_nm"][2] / s["film_thickness_nm"][1] - 1) < READING
            and s["largest_mean_thickness_nm"][2] > (1 + READING) * s["film_thickness_nm"][2]
            and s["largest_mean_thickness_nm"][1] < (1 + READING) * s["film_thickness_nm"][1]
        ),
    ),
    "afm_tip_stress_relaxation_alone_does_not": Rule(
        lambda s: f"{at(s, 'film_thickness_nm', 0)} nm without wear, {at(s, 'film_thickness_nm', 1)} nm with",
        lambda s: s["film_thickness_nm"][0] > 2 * s["film_thickness_nm"][1],
    ),
    "afm_tip_less_film_at_340_nn_than_at_600_nn_nm": Rule(
        lambda s: f"{at(s, 'film_thickness_nm', 4)} against {at(s, 'film_thickness_nm', 1)}",
        lambda s: s["film_thickness_nm"][4] < s["film_thickness_nm"][1],
    ),
}
