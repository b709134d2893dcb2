"""Error bars of films in time: what covers, and what has none."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from error_bar_ratios import rows_of

from bem.accuracy import MarchCase, march_bars
from bem.errors import Status
from reports.experiments.march_error_bars import EXPERIMENT, done, draw


def test_a_bar_is_the_sum_of_its_parts():
    case = done(draw(np.random.default_rng(5)))
    bars = march_bars(case)
    assert set(bars.parts) == {"film points", "time steps", "residual"}
    for name, value in bars.values.items():
        assert value == sum(part[name] for part in bars.parts.values())
    # its bar covered 69 % of errors
    assert "thinnest_film_time" not in bars.values


def test_a_march_of_few_steps_has_no_bars():
    case = draw(np.random.default_rng(5))
    bars = march_bars(replace(case, times=case.times[:4]))
    assert set(bars.values.values()) == {None}
    assert bars.notes[0].values["reason"] == "short-march"


@pytest.mark.parametrize(("points", "other"), [(103, 205), (161, 101), (401, 201)])
def test_meshes_that_are_compared_lie_apart(monkeypatch, points, other):
    """101 points beside 103: by order two a difference of 1 % was one of 75 %, and one of 0.002 % a bar of 0.3 % where
    the error was 16 %."""
    case = draw(np.random.default_rng(5))
    film, asked = SimpleNamespace(minimum_thickness=1e-7, shear_force=1.0, status=Status.CONVERGED), []
    monkeypatch.setattr(
        MarchCase, "again", lambda self, points, every=1: asked.append((points, every)) or [film] * len(self.times)
    )
    march_bars(replace(case, points=points, films=[film] * len(case.times)))
    assert asked == [(other, 1), (min(other, points), 2)]


def test_bars_cover_errors_of_a_random_march():
    """`reports/experiments/march_error_bars.py` has more and the verdict for each figure."""
    rows = rows_of(EXPERIMENT, np.random.default_rng(3), cases=1)
    known = [r for r in rows if r["error"] > 1e-7 * abs(r["value"])]
    assert len(known) >= 2
    for row in known:
        assert row["bar"] >= row["error"], row["figure"]
