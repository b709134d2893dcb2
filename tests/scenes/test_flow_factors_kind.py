"""The kind `flow-factors`: a scene from tables to figures, and its mistakes in words."""

import dataclasses

import numpy as np
import pytest
from small_scenes import PATCH

from bem import InputError, flow_factors, load_scene
from bem.accuracy import flow_bars
from bem.errors import Status
from bem.runs import run_scene
from bem.scenes import build, get_kind
from bem.scenes.context import PlainContext


def scene(**changes):
    table = {
        "kind": "flow-factors",
        "grid": {"shape": [48, 40], "lengths": ["24 um", "20 um"]},
        "lower": {
            "material": "steel-52100",
            "surface": {"kind": "generated", "rms_height": "0.2 um", "correlation_length": "2 um", "elongation": 2.0},
        },
        "upper": {"surface": {"kind": "generated", "rms_height": "0.1 um", "correlation_length": "2 um"}},
        "flow": {"ratios": [3.0, 0.5]},
    }
    return {**table, **changes}


@pytest.mark.internal
def test_record_is_what_the_solver_gives(tmp_path):
    """Both surfaces' heights together, separations in rising order, errors beside the figures, files on disk."""
    run = run_scene(scene(), tmp_path / "run")
    loaded = load_scene(scene())
    grid, context = build.grid_of(loaded.grid), PlainContext(loaded.seed)
    lower, upper = build.both_heights(loaded, grid, context)
    rms = float((lower + upper).std())
    found = flow_factors(lower + upper, grid, loaded.lower.build(), separations=[0.5 * rms, 3 * rms], errors=True)
    summary = run.summary
    assert summary["separation_over_Sq"] == pytest.approx([0.5, 3.0])
    assert summary["pressure_x"] == pytest.approx(found.pressure_x, rel=1e-9)
    bars = flow_bars(found, lower + upper, grid).values
    assert summary["pressure_x_error"] == pytest.approx(bars["pressure_x"], rel=1e-6)
    assert (bars["pressure_x"] >= found.pressure_x_error).all()  # that of second order, without a factor for safety
    share = (lower.var() - upper.var()) / (lower.var() + upper.var())
    assert summary["shear_pair"] == pytest.approx(found.shear_x * share, rel=1e-9)
    assert np.mean(summary["pressure_x"]) > np.mean(summary["pressure_y"])  # lays along the flow
    assert (run.path / "figures" / "flow-factors.png").exists()


@pytest.mark.internal
def test_a_stribeck_curve_with_the_flow_factors_of_its_surfaces(tmp_path):
    """Off by default; on, the film between rough walls is another one, and the plan says what it costs."""
    from bem.flow.factors import TABLE_RATIOS
    from bem.runs import plan_scene

    table = {
        "kind": "friction",
        **PATCH,
        "grid": {"shape": [64, 16], "spacing": "1.6 um"},
        "speeds": {"values": ["0.03 m/s"]},
        "film": {"points": 300},
        "outputs": {"errors": False},
        "sharing": {"models": ["elastic"]},
    }
    rough = {**table, "sharing": {"models": ["elastic"], "flow_factors": "surfaces"}}
    (step,) = [step for step in plan_scene(rough)[1].steps if step.name == "flow factors"]
    assert not step.skipped
    assert f"{len(TABLE_RATIOS)} separations" in step.why
    runs = [run_scene(one, tmp_path / name, figures=False) for name, one in (("off", table), ("rough", rough))]
    assert [run.summary["status"] for run in runs] == ["converged", "converged"]
    off, on = (np.array(run.summary["film_load_N"]) for run in runs)
    assert (np.abs(on / off - 1) > 1e-3).all()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"grid": {"shape": 48, "lengths": "24 um", "periodic": False}}, "a patch that repeats"),
        ({"flow": {"ratios": [1.0], "separations": ["1 um"]}}, "exactly one of separations, ratios"),
        ({"flow": {"ratios": [0.0]}}, "flow.ratios"),
        ({"flow": {"ratios": [1.0], "hardness": "1 GPa"}}, "nothing is capped"),
        ({"lower": {"material": "steel-52100"}, "upper": {}}, "both surfaces are smooth"),
        (
            {
                "lower": {
                    "material": "steel-52100",
                    "surface": {"kind": "generated", "rms_height": "1 nm", "hurst": 0.8, "elongation": 2.0},
                }
            },
            "elongation without correlation_length",
        ),
    ],
)
def test_mistakes(changes, words):
    with pytest.raises(InputError, match=words):
        load_scene(scene(**changes))


@pytest.mark.internal
def test_the_record_has_the_status_of_the_factors(monkeypatch):
    """Factors that did not converge were said to be: the kind gave where, but no status."""
    import bem.flow

    solve = bem.flow.flow_factors

    def stalled(*given, **named):
        found = solve(*given, **named)
        return dataclasses.replace(found, statuses=(Status.STALLED,) * len(found.statuses))

    monkeypatch.setattr(bem.flow, "flow_factors", stalled)
    kind = get_kind("flow-factors")
    record = kind.run(kind.resolved(load_scene(scene())), PlainContext(0))
    assert record.status is Status.STALLED
    assert record.where.startswith("separation ")
