"""Our numbers and verdicts for the lines on paper E: the tribofilm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, cast

from bem.scenes.load import load_scene
from reports.validation_values import READING, Rule, Summary, at, echo, experiment, falling, listed, quoted

if TYPE_CHECKING:
    from bem.kinds.tribofilm.scene import TribofilmScene

STIFF = "tribofilm-modulus-130-gpa"
AS_STEEL = "tribofilm-modulus-210-gpa"
ROUGHER, ROUGHER_AS_STEEL = "tribofilm-rougher", "tribofilm-rougher-modulus-210-gpa"
HARD = "tribofilm-hardness-4-gpa"
HEATED = "tribofilm-heat-of-rubbing"
_BOLTZMANN_EV = 8.617e-5
_PREFACTOR, _WEAR_COEFFICIENT = 1e-2, 6.9e-4  # [m/s], [1/s], of the source's table 2


def _changes(summary: Summary, name: str) -> list[float]:
    """Relative change of the film thickness in an experiment, at each temperature."""
    pairs = zip(summary["film_thickness_nm"], experiment(name)["film_thickness_nm"], strict=True)
    return [other / own - 1 for own, other in pairs]


def _rougher(summary: Summary) -> str:
    """The same by a film as stiff as steel, on the rougher contact."""
    try:
        return f"{_percent(_changes(experiment(ROUGHER), ROUGHER_AS_STEEL))} %"
    except FileNotFoundError:
        return "not run"


def _constants(scene: str) -> str:
    """Activation energy [eV], activation volume [A^3] and wear coefficient of a built-in scene."""
    film = cast("TribofilmScene", load_scene(scene)).film
    return (
        f"{film.activation_energy / 1.602177e-19:.3g}, {1e30 * film.activation_volume:.3g}, {film.wear_coefficient:.2g}"
    )


def _films(summary: Summary) -> str:
    return f"film {listed([at(summary, 'film_thickness_nm', i) for i in range(3)])} nm"


def _overshoot(summary: Summary, place: int) -> float:
    """Largest mean film over the film at the end, of one case of the tip."""
    return float(summary["largest_mean_thickness_nm"][place] / summary["film_thickness_nm"][place])


def _pressures(summary: Summary) -> tuple[float, float, float, float] | None:
    """Mean pressure [GPa] of the first case at no film, at the first 10 nm and at the end, and the film there [nm]."""
    if "sample_pressure_Pa" not in summary:
        return None
    pressure, film = summary["sample_pressure_Pa"][0], summary["sample_film_nm"][0]
    end = next(
        (place for place in range(1, len(film)) if film[place] < film[place - 1]), len(film)
    )  # of the first case
    pressure, film = pressure[:end], film[:end]
    ten = next((place for place, thickness in enumerate(film) if thickness >= 10), len(film) - 1)
    if film[-1] <= 10:
        return None
    return 1e-9 * pressure[0], 1e-9 * pressure[ten], 1e-9 * pressure[-1], film[-1]


def _pressure_line(summary: Summary) -> str:
    found = _pressures(summary)
    return "not stored" if found is None else ", ".join(f"{value:.2f}" for value in found[:3])


def _pressure_drops_early(summary: Summary) -> bool | None:
    """Return True if the pressure falls, and faster over the first 10 nm of film than over the rest."""
    found = _pressures(summary)
    if found is None:
        return None
    first, ten, last, thickness = found
    return first > ten > last > 0 and (first - ten) / 10 > (ten - last) / (thickness - 10)


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
        echo,
    ),
    "film_thickness_rises_with_temperature_nm": Rule(
        lambda s: listed([at(s, "film_thickness_nm", i) for i in range(3)]),
        echo,
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
        echo,
    ),
    "modulus_of_the_film_counts_little_hardness_decides": Rule(
        lambda s: _percent(_changes(s, AS_STEEL)),
        lambda s: all(abs(change) < READING for change in _changes(s, AS_STEEL)),
        lambda s: f"{_rougher(s)}; {quoted(_films, {AS_STEEL: 'with a film as stiff as the steel'})(s)}",
    ),
    "hardness_of_the_film_decides": Rule(
        lambda s: f"{_percent(_changes(s, HARD))}; by the modulus {_percent(_changes(s, STIFF))}",
        lambda s: all(
            abs(hardness) > abs(modulus)
            for modulus, hardness in zip(_changes(s, STIFF), _changes(s, HARD), strict=True)
        ),
        quoted(
            _films,
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
        lambda s: f"{at(s, 'film_thickness_nm', 1)} and {at(s, 'film_thickness_nm', 2)}",
        lambda s: abs(s["film_thickness_nm"][2] / s["film_thickness_nm"][1] - 1) < READING,
    ),
    "afm_tip_overshoot_with_delay_only": Rule(
        lambda s: "; ".join(f"{_overshoot(s, i):.2f} and {_overshoot(s, i + 1):.2f}" for i in (1, 4)),
        lambda s: all(_overshoot(s, i) < 1 + READING < _overshoot(s, i + 1) for i in (1, 4)),
    ),
    "afm_tip_pressure_over_film": Rule(_pressure_line, _pressure_drops_early),
    "constants_of_growth": Rule(
        lambda s: "; ".join(_constants(scene) for scene in ("tribofilm-afm-tip", "tribofilm-macro")),
        echo,
    ),
    "concentration_falls_with_temperature": Rule(
        lambda s: listed([at(s, "concentration", i) for i in range(3)]),
        lambda s: falling([at(s, "concentration", i) for i in range(3)]),
    ),
    "afm_tip_stress_relaxation_alone_does_not": Rule(
        lambda s: f"{at(s, 'film_thickness_nm', 0)} nm without wear, {at(s, 'film_thickness_nm', 1)} nm with",
        lambda s: s["film_thickness_nm"][0] > s["film_thickness_nm"][1],
    ),
    "afm_tip_less_film_at_340_nn_than_at_600_nn_nm": Rule(
        lambda s: f"{at(s, 'film_thickness_nm', 4)} against {at(s, 'film_thickness_nm', 1)}",
        lambda s: s["film_thickness_nm"][4] < s["film_thickness_nm"][1],
    ),
}
