"""The worked examples of the documentation: files, and the numbers and pictures of their stored runs.

`python -m reports.docs.tasks [NAME ...]` runs examples again (all where none is named) and stores what comes out.
"""

from __future__ import annotations

import contextlib
import io
import json
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Task:
    """An example that has a scene.

    Attributes
    ----------
    numbers : keys of the summary that the page shows.
    pictures : names of the figures that the page shows.
    """

    numbers: tuple[str, ...]
    pictures: tuple[str, ...]


TASKS: Mapping[str, Task] = {
    "bearing-film": Task(
        ("hertz_pressure_Pa", "central_thickness_nm", "minimum_thickness_nm", "lambda_ratio", "traction_coefficient"),
        ("interferogram",),
    ),
    "compare-oils": Task(
        (
            "oil.grade", "rolling.slide_roll_ratio", "central_thickness_nm", "minimum_thickness_nm",
            "traction_coefficient", "friction_power_W", "film_temperature_C",
        ),
        ("traction-curve",),
    ),
    "own-surfaces": Task(
        (
            "friction_initial", "friction_final", "lower_Sq_initial_nm", "lower_Sq_final_nm", "lower_worn_depth_nm",
            "lambda_ratio",
        ),
        ("friction-over-life", "wear-over-life"),
    ),
    "gear-losses": Task((), ("along-the-way",)),
    "coating-stresses": Task(
        ("max_pressure_Pa", "approach_m", "max_von_mises_Pa", "max_von_mises_depth_m"),
        ("von-mises-section",),
    ),
    "coating-stack": Task(
        ("max_pressure_Pa", "approach_m", "max_von_mises_Pa", "max_von_mises_depth_m"),
        ("layer-stresses",),
    ),
    "sliding-rubber": Task(
        (
            "contact.sliding_speed", "hysteresis_friction", "dissipated_power_W", "contact_area_m2", "max_pressure_Pa",
        ),
        ("friction-over-speed",),
    ),
    "stribeck-curve": Task(
        ("speed_m_s", "friction", "contact_load_N", "minimum_film_nm", "lambda_ratio"),
        ("stribeck-curve",),
    ),
    "input-uncertainty": Task(
        ("speed_m_s", "friction", "contact_load_N", "minimum_film_nm", "lambda_ratio"),
        ("stribeck-curve",),
    ),
    "wear-particles": Task(
        (
            "particle_equivalent_radius_nm", "particle_length_nm", "particle_width_nm", "particle_thickness_nm",
            "particles_per_cycle", "Sq_initial_nm", "Sq_final_nm", "contact_area_fraction",
        ),
        ("particle-radius-over-cycles",),
    ),
    "tribofilm-growth": Task(
        ("temperature_C", "film_thickness_nm", "film_wear_rate_nm_s", "wear_depth_nm", "total_wear_depth_nm"),
        ("film-thickness",),
    ),
}  # fmt: skip
"""Examples by the names of their folders."""

ELEMENTS: Mapping[str, str] = {"bearing-film": "bearing.toml", "gear-losses": "gears.toml"}
"""Examples with the file of a machine element."""


def stored(name: str) -> dict[str, Any]:
    """Return the stored numbers of an example: `numbers` and `errors`, by the names that the summary has."""
    found: dict[str, Any] = json.loads((HERE / name / "results.json").read_text("utf-8"))
    return found


def scene_of(name: str) -> str | dict[str, Any]:
    """Return the scene of an example: its file, or the path of contact of its gear pair."""
    from bem.elements.answer import balance_heat
    from bem.elements.element import load_element

    path = HERE / name / "scene.toml"
    return str(path) if path.exists() else balance_heat(load_element(HERE / name / ELEMENTS[name])).path_scene()


def of_element(name: str) -> dict[str, float]:
    """Return the numbers of a machine element that `bem element` shows."""
    from bem.elements.answer import balance_heat
    from bem.elements.element import load_element

    element = balance_heat(load_element(HERE / name / ELEMENTS[name]))
    columns = element.columns()
    return {
        "contacts": float(len(element.found.contacts)),
        "highest_load_N": max(columns["load [N]"]),
        "highest_hertz_pressure_Pa": max(columns["hertz_pressure [Pa]"]),
        "minimum_film_nm": 1e9 * min(columns["minimum_film [m]"]),
        "lambda_ratio": min(columns["film_over_roughness"]),
    }


def of_operation(name: str) -> dict[str, float]:
    """Return the numbers of a machine element with its thermal films, as `bem element --running` shows them."""
    from bem.elements.answer import balance_heat, friction_power
    from bem.elements.element import load_element
    from bem.elements.running import run_all

    element = balance_heat(load_element(HERE / name / ELEMENTS[name]))
    runs = run_all(element)
    return {
        "friction_power_W": friction_power(element, runs).film,
        "minimum_film_solved_nm": 1e9 * min(run.minimum_film for run in runs),
        "highest_surface_temperature_C": max(run.surface or 0.0 for run in runs) - 273.15,
    }


LAYERED: Mapping[str, str] = {"coating-stresses": "coating.py", "coating-stack": "stack.py"}
"""Examples whose page reads stresses from the arrays of the run, with the snippets that do."""


def of_layer(name: str, path: Path) -> dict[str, float]:
    """Return the stresses of a coating in a finished run, as the snippet of its page prints them."""
    code = (HERE.parent / "examples" / LAYERED[name]).read_text("utf-8")
    names: dict[str, Any] = {"folder": path}
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(code, LAYERED[name], "exec"), names)
    return dict(names["found"])


def of_stack(run: Any) -> dict[str, list[Any]]:
    """Return the stresses of a layered body, a row for each layer and the interface below it."""
    layers, summary = run.scene["lower"]["layers"], run.summary

    def megapascals(values: list[float]) -> list[float]:
        return [1e-6 * value for value in values]

    return {
        "layer": [layer["material"]["name"] for layer in layers],
        "residual stress [MPa]": megapascals([layer["residual_stress"] for layer in layers]),
        "yield stress [MPa]": megapascals([layer["material"]["yield_stress"] for layer in layers]),
        "highest von Mises stress [MPa]": megapascals(summary["layer_max_von_mises_Pa"]),
        "highest tension [MPa]": megapascals(summary["layer_max_tension_Pa"]),
        "interface below at [um]": [1e6 * value for value in summary["interface_depth_m"]],
        "shear across it [MPa]": megapascals(summary["interface_max_shear_Pa"]),
        "tension across it [MPa]": megapascals(summary["interface_max_tension_Pa"]),
    }


def of_summary(name: str, summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the page of an example shows of a summary."""
    keys = [key for key in TASKS[name].numbers if key in summary]
    errors = {key: summary[f"{key}_error"] for key in keys if summary.get(f"{key}_error") is not None}
    return {"numbers": {key: summary[key] for key in keys}, "errors": errors}


def rounded(value: Any) -> Any:
    """Return numbers to six digits: the last digits of a run follow the machine."""
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    if isinstance(value, list):
        return [rounded(one) for one in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def save_small(source: Path, target: Path) -> None:
    """Store a picture with 256 colours: a third of its size."""
    from PIL import Image

    with Image.open(source) as picture:
        picture.convert("RGB").quantize(256).save(target, optimize=True)


def renew(name: str) -> None:
    """Run an example and store its numbers and pictures."""
    from bem import open_run, run_scene

    folder, task = HERE / name, TASKS[name]
    with tempfile.TemporaryDirectory() as scratch:
        run = run_scene(scene_of(name), Path(scratch) / "run")
        made = of_summary(name, run.summary)
        for picture in task.pictures:
            save_small(run.path / "figures" / f"{picture}.png", folder / f"{picture}.png")
        if name in LAYERED:
            made["layer"] = of_layer(name, run.path)
        if name == "coating-stack":
            made["stack"] = of_stack(open_run(run.path))
    if name in ELEMENTS:
        made["element"] = of_element(name)
    if name == "gear-losses":
        made["operation"] = of_operation(name)
    (folder / "results.json").write_text(json.dumps(rounded(made), indent=1) + "\n", "utf-8")
