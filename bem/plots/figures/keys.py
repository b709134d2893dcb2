"""Headline figures over the keys of `[over]`, the same as a sweep draws."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from bem.notes import of_summary
from bem.notes.contact import LINE_APPROACH
from bem.plots.cases import axes_of
from bem.plots.figures import FigureKind
from bem.plots.sweep import fill, varies
from bem.scenes.context import Variable
from bem.scenes.kind import get_kind
from bem.scenes.records import figures

APPROACH = "approach_m"
"""Figure of contacts without an absolute zero on lines."""


def _keys(run: Any) -> list[str]:
    return [axis for axis in axes_of(run.dataset) if axis in (run.scene.get("over") or {})]


def _variables(run: Any) -> dict[str, Variable]:
    """Axes of the cases and figures over them, by their names in the summary; without approaches that cannot be
    compared, those of line contacts in steady motion."""
    incomparable = any(note["code"] == LINE_APPROACH.code for note in of_summary(run.summary))
    kind, data = get_kind(run.summary["kind"]), run.dataset
    variables = {name: data[name] for name in axes_of(data)}
    for key, name in figures(kind.record).items():
        if incomparable and key == APPROACH:
            continue
        if name in data.variables and set(data[name].dims) <= set(axes_of(data)):
            variables[key] = data[name]
    return variables


def _figures(run: Any, figure: Figure) -> None:
    fill(figure, _variables(run), dict.fromkeys(_keys(run), "linear"), get_kind(run.summary["kind"]).headline)


def _applies(run: Any) -> bool:
    """Return True if any headline figure differs along the keys: flat curves say nothing."""
    keys = _keys(run)
    return bool(keys) and varies(_variables(run), keys, get_kind(run.summary["kind"]).headline)


FIGURES = (
    FigureKind(
        "figures-over-keys",
        "Headline figures over the keys that were varied.",
        (),
        _figures,
        (7.0, 5.6),
        _applies,
        all_cases=True,
    ),
)
