"""Three checks of friction beside the measurements: two kinds of scene for one hot contact, the scatter of the oil with
the film solved again, and the scatter of a ball's Stribeck curve.

    python -m reports.experiments.hot_contacts

Some five minutes. The result is stored in `reports/results/hot_contacts.json`, which `reports.friction` reads.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from bem.lubrication.lubricant import Lubricant
from bem.lubrication.oil_scatter import oil_scatter
from bem.lubrication.rheology import rheology_of
from bem.runs import run_scene
from reports.experiments import friction_measured as discs
from reports.experiments.kept import keep, result_of, rounded

RESULT = result_of("hot_contacts")
SLIPS = (0.02, 0.1, 0.5)
"""Slide-to-roll ratios of the smooth contact."""
MEAN_SPEED, PRESSURE, RADIUS, WIDTH = 5.0, "0.7 GPa", "10 mm", "8 mm"
POINTS = 200
AGAIN = (("N100", 8.0, 0.1), ("M100", 8.0, 0.1), ("PAO100", 8.0, 0.1), ("M100", 2.0, 0.02))
"""Oil, mean speed [m/s] and slide-to-roll ratio of the discs that are solved again with each constant."""


def scene_of_traction(slip: float) -> dict[str, Any]:
    """Two steel rollers, smooth, with the defaults of the kind traction."""
    return {
        "kind": "traction",
        "lower": {"material": "steel-52100"},
        "upper": {"material": "steel-52100"},
        "roller": {"radius": RADIUS, "width": WIDTH, "hertz_pressure": PRESSURE},
        "oil": {"grade": "ISO VG 68", "temperature": "60 degC"},
        "rolling": {"mean_speed": f"{MEAN_SPEED:g} m/s", "slide_roll_ratio": slip},
        "film": {"points": POINTS},
    }


def scene_of_friction(slip: float) -> dict[str, Any]:
    """The same contact with the defaults of the kind friction, summits of a nanometre on one roller."""
    lower, upper = MEAN_SPEED * (1 + 0.5 * slip), MEAN_SPEED * (1 - 0.5 * slip)
    surface = {"kind": "generated", "rms_height": "1 nm", "correlation_length": "12 um"}
    return {
        "kind": "friction",
        "lower": {"material": "steel-52100", "surface": surface},
        "upper": {"material": "steel-52100"},
        "contact": {"radius": RADIUS, "width": WIDTH, "hertz_pressures": [PRESSURE], "boundary_friction": 0.1},
        "oil": {"grade": "ISO VG 68", "temperature": "60 degC"},
        "speeds": {"values": [f"{lower:.12g} m/s"], "cylinder": upper / lower},
        "grid": {"shape": [64, 16], "spacing": "5 um", "periodic": [False, True]},
        "film": {"points": POINTS},
    }


def _summary(scene: dict[str, Any] | str) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        return run_scene(scene, Path(folder) / "run", figures=False).summary


def smooth(slip: float) -> dict[str, Any]:
    """Friction of one smooth hot contact by both kinds, with numerical errors and temperatures of the oil [degC]."""
    rolled, shared = _summary(scene_of_traction(slip)), _summary(scene_of_friction(slip))
    if {rolled["status"], shared["status"]} != {"converged"}:
        raise ArithmeticError(f"smooth contact, slide-to-roll ratio {slip:g}: not converged")
    row = {
        "slip": slip,
        "traction": rolled["traction_coefficient"],
        "traction_numerical": rolled["traction_coefficient_error"],
        "traction_temperature": rolled["film_temperature_C"],
        "friction": shared["friction"][0],
        "friction_numerical": shared["friction_error"][0],
        "friction_temperature": shared["oil_temperature_C"][0],
    }
    print("smooth", rounded(row), flush=True)
    return row


def again(name: str, speed: float, slip: float) -> dict[str, Any]:
    """Scatter of a disc's friction from the oil's constants: evaluated at the film's temperatures, and with film and
    heat solved again with each constant at either end of its range."""
    oil = discs.MANN[name]
    lubricant = oil.oil(name).at(discs.DISC_INLET + discs.CELSIUS, shear_law="base_oil")
    scatter = oil_scatter(discs.roller(lubricant, speed, slip), lubricant)
    changes = []
    for constant, known in rheology_of(oil.base).constants().items():
        ends = [
            _friction(replace(lubricant, shear_law=replace(lubricant.shear_law, **{constant: end})), speed, slip)
            for end in (known.low, known.high)
        ]
        changes.append([end - scatter.friction for end in ends])
    row = {
        "oil": name,
        "speed": speed,
        "slip": slip,
        "coefficient": scatter.friction,
        "down": scatter.down,
        "up": scatter.up,
        "solved_down": math.sqrt(sum(min(*pair, 0.0) ** 2 for pair in changes)),
        "solved_up": math.sqrt(sum(max(*pair, 0.0) ** 2 for pair in changes)),
    }
    print("again", rounded(row), flush=True)
    return row


def _friction(lubricant: Lubricant, speed: float, slip: float) -> float:
    return oil_scatter(discs.roller(lubricant, speed, slip), lubricant).friction


def ball() -> list[dict[str, Any]]:
    """The built-in Stribeck curve of a ball as it is, with its own draw of the surface: lambda ratio, asperity load
    share, friction with its numerical error, and scatter of the oil."""
    summary = _summary("stribeck-ball-on-disc")
    loads = zip(summary["contact_load_N"], summary["film_load_N"], strict=True)
    columns = {
        "speed": summary["speed_m_s"],
        "lambda": summary["lambda_ratio"],
        "touching": [contact / (contact + film) for contact, film in loads],
        "friction": summary["friction"],
        "numerical": summary["friction_error"],
        "oil": summary["friction_oil_scatter"],
    }
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    if summary["status"] != "converged":
        raise ArithmeticError("Stribeck curve of the ball: not converged")
    return rows


def main() -> None:
    """Solve, print, store."""
    found = {
        "smooth": [smooth(slip) for slip in SLIPS],
        "again": [again(*case) for case in AGAIN],
        "ball": ball(),
    }
    keep(RESULT, rounded(found))


if __name__ == "__main__":
    main()
