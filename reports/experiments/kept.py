"""Files of the results of experiments: written with the commit, read by the pages."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from reports import reproduced
from reports.validation_origin import commit

RESULTS = Path(__file__).resolve().parents[1] / "results"
SCRIPTS = (
    "independent_figures",
    "film_regimes",
    "load_share_curves",
    "patch_length",
    "piece_shapes",
    "separation_datum",
    "stribeck_effects",
)
"""Experiments that the validation page reads; module and result have the same name."""


def result_of(name: str) -> Path:
    """Return the file of an experiment's result."""
    return RESULTS / f"{name}.json"


def keep(path: Path, found: Any) -> None:
    """Store the result of an experiment with the commit of the code."""
    path.write_text(json.dumps({"origin": {"commit": commit()}, "found": found}, indent=1) + "\n", encoding="utf-8")
    reproduced.forget(path.stem)


def rounded(value: Any) -> Any:
    """Round floats in nested dictionaries and lists to four significant digits."""
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    if isinstance(value, list):
        return [rounded(one) for one in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


def found(name: str) -> Any:
    """Return the stored result of an experiment.

    Raises
    ------
    FileNotFoundError : the experiment was not run.
    """
    return json.loads(result_of(name).read_text("utf-8"))["found"]


def stored_at(name: str) -> str:
    """Return the commit that a result was stored with; empty where there is none."""
    path = result_of(name)
    document = json.loads(path.read_text("utf-8")) if path.exists() else {}
    return str(document.get("origin", {}).get("commit", "")) if isinstance(document, dict) else ""


def age(name: str) -> str:
    """Return an HTML paragraph that says when a result was last reproduced."""
    return reproduced.paragraph(name)
