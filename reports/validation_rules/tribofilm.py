"""Our numbers and verdicts for the lines on paper E: the tribofilm."""

from __future__ import annotations

import math

from reports.validation_values import READING, Rule, Summary, at, experiment, falling, listed, quoted

FITTED = 0.15
"""Accepted relative difference of the two wear depths that the hardness curve was fitted to."""
NEGLIGIBLE = 1 / 3
"""The modulus counts little if it changes the film by less than this fraction of what hardness changes."""
WEAR_DEPTHS = (86.3, 45.8)
"""Calculated wear depths of the source's table 3 at 60 and 100 degrees Celsius [nm]."""
STIFF = "tribofilm-modulus-130-gpa"
HARD = "tribofilm-hardness-4-gpa"
HEATED = "tribofilm-heat-of-rubbing"
_BOLTZMANN_EV = 8.617e-5
_PREFACTOR, _WEAR_COEFFICIENT = 1e-2, 6.9e-4  # [m/s], [1/s], of the source's table 2


def _changes(summary: Summary, name: str) -> list[float]:
    """Relative change of the film thickness in an experiment, at each temperature."""
    return [
        other / own - 1
        for own, other in zip(summary["film_thickness_nm"], experiment(name)["film_thickness_nm"], strict=True)
    ]


def _percent(values: list[float]) -> str:
    return ", ".join(f"{100 * value:+.0f}" for value in values)


def _heat(summary: Summary) -> float:
    """Highest temperature of the rubbing spots above that of the bodies at 60 degrees Celsius [K]."""
    return at(experiment(HEATED), "flash_temperature_C", 0).mean - at(summary, "temperature_C", 0).mean


def arrhenius_rise(thickness: float, low: float, high: float) -> float:
    """Factor of the growth rate between two temperatures [Celsius] at a constant barrier.

    The barrier is the one under load at the lower temperature, where a steady film of this thickness [nm] grows as fast
    as it wears: G0 exp(-barrier / (k T)) = alpha h.
    """
    cold, hot = low + 273.15, high + 273.15
    over_kt = math.log(_PREFACTOR / (_WEAR_COEFFICIENT * 1e-9 * thickness))
    return math.exp(over_kt * (1 - cold / hot))


def _arrhenius(summary: Summary) -> float:
    """The same from the coldest to the hottest film of the scene."""
    temperatures = summary["temperature_C"]
    return arrhenius_rise(summary["film_thickness_nm"][0], temperatures[0], temperatures[-1])


def _rise(summary: Summary) -> float:
    """Ours: thickness of the hottest film over that of the coldest."""
    return float(summary["film_thickness_nm"][-1] / summary["film_thickness_nm"][0])


RULES: dict[str, Rule] = {
    "wear_depth_45_to_120_min_at_60_and_100_c_nm": Rule(
        lambda s: f"{at(s, 'wear_depth_nm', 0)} and {at(s, 'wear_depth_nm', 2)}",
        lambda s: all(
            abs(at(s, "wear_depth_nm", place).mean / depth - 1) < FITTED
            for place, depth in zip((0, 2), WEAR_DEPTHS, strict=True)
        ),
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
        lambda s: falling([at(s, "wear_depth_nm", i) for i in range(3)]),
    ),
    "film_rises_less_than_by_arrhenius_alone": Rule(
        lambda s: f"film times {_rise(s):.1f}, growth by Arrhenius' law alone times {_arrhenius(s):.1f}",
        lambda s: 1 < _rise(s) < _arrhenius(s) / 2,
    ),
    "modulus_of_the_film_counts_little_hardness_decides": Rule(
        lambda s: f"{_percent(_changes(s, STIFF))} by the modulus, {_percent(_changes(s, HARD))} by the hardness",
        lambda s: all(
            abs(modulus) < NEGLIGIBLE * abs(hardness)
            for modulus, hardness in zip(_changes(s, STIFF), _changes(s, HARD), strict=True)
        ),
        quoted(
            lambda s: f"film {listed([at(s, 'film_thickness_nm', i) for i in range(3)])} nm",
            {STIFF: "with 130 GPa", HARD: "with a film of 4 GPa"},
        ),
    ),
    "rubbing_heats_by_less_than_1_c": Rule(
        lambda s: f"{_heat(s):.2f}",
        lambda s: 0 < _heat(s) < 1,
        quoted(
            lambda s: f"{at(s, 'flash_temperature_C', 0).mean:.2f} C at the hottest spot",
            {HEATED: "at 0.1025 and 0.0975 m/s, on cells of 0.88 um"},
        ),
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
