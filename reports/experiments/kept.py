"""Where the results of experiments lie and what they came from: written with a result, and held against the code now.

`python -m reports validation --renew` runs the scripts named here when their result is stale.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from reports.builder import text
from reports.validation_origin import bare_digest, commit, modules

RESULTS = Path(__file__).resolve().parents[1] / "results"
SCRIPTS = (
    "independent_figures",
    "film_regimes",
    "load_share_curves",
    "patch_length",
    "separation_datum",
    "stribeck_effects",
)
"""Experiments whose results the validation page reads; of each, module and result have that name."""


def result_of(name: str) -> Path:
    """Where an experiment's result lies."""
    return RESULTS / f"{name}.json"


@cache
def code_hash(name: str) -> str:
    """Of an experiment and of all that computes a contact or a film, without comments, docstrings and layout."""
    here = Path(__file__).parent
    return bare_digest([here / f"{name}.py", *modules("friction")])


def keep(path: Path, found: Any) -> None:
    """Store what an experiment found, with the commit and the hash of the code that it came from."""
    origin = {"commit": commit(), "code_hash": code_hash(path.stem)}
    path.write_text(json.dumps({"origin": origin, "found": found}, indent=1) + "\n", encoding="utf-8")


def rounded(value: Any) -> Any:
    """Of dictionaries and lists of figures: floats to four digits."""
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    if isinstance(value, list):
        return [rounded(one) for one in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


def found(name: str) -> Any:
    """What an experiment found.

    Raises
    ------
    FileNotFoundError : it was not run.
    """
    return json.loads(result_of(name).read_text("utf-8"))["found"]


def stale(name: str) -> str:
    """Why an experiment's result no longer stands; empty where it does."""
    path = result_of(name)
    if not path.exists():
        return "not run"
    document = json.loads(path.read_text("utf-8"))
    origin = document.get("origin") if isinstance(document, dict) else None
    if origin is None:
        return "stale: kept without its code's hash"
    return "" if origin["code_hash"] == code_hash(name) else "stale: code changed since"


def age(name: str) -> str:
    """A paragraph, as HTML, below an experiment's result that no longer stands; empty where it does."""
    state = stale(name)
    return text(f"Result of {name}: {state}.") if state else ""
