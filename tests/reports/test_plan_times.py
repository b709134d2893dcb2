"""Planned beside measured times: what is stored, what is measured again, what counts as off."""

import pytest

from reports import plan_times
from reports.plan_times import LEAST, PlanTime, main


@pytest.fixture
def runs(monkeypatch, tmp_path):
    """Times of runs that are given instead of run; each is a list of processor and wall time [s]."""
    times, done = [], []

    def run_time(scene, out):
        done.append(scene)
        return times.pop(0)

    class Run:
        summary = {"seconds_by_stage": {"contact": 1.0}}  # noqa: RUF012

    monkeypatch.setattr(plan_times, "run_time", run_time)
    monkeypatch.setattr(plan_times, "open_run", lambda folder: Run())
    monkeypatch.setattr(plan_times, "machine_rate", lambda: 1e10)
    monkeypatch.setattr(plan_times, "transform_rate", lambda: 5e9)  # a processor half as fast as the plan assumes
    return times, done, ["hertz-sphere", "--reduced", "--out", str(tmp_path / "times.json")]


def test_times_are_stored_and_a_scene_is_not_run_again_unless_asked(runs, tmp_path):
    times, done, command = runs
    times += [(40.0, 50.0), (8.0, 9.0), (30.0, 31.0)]
    assert main(command) == 1
    assert main(command) == 1
    assert len(done) == 1
    main([*command, "--again"])
    main([*command, "--again"])
    (one,) = plan_times.load(tmp_path / "times.json").values()
    assert (one.processor, one.slowdown) == (4.0, 2.0)  # the shortest, at the rate that the plan assumes
    assert one.stages == {"contact": 1.0}
    assert 0 < sum(one.steps.values()) < one.planned


def test_another_scene_of_the_same_name_is_measured_anew(runs, tmp_path):
    times, done, command = runs
    times += [(8.0, 9.0), (30.0, 31.0)]
    main(command)
    other = plan_times.load(tmp_path / "times.json")["hertz-sphere reduced"].digest
    main([*command, "--set", "seed=5"])
    assert len(done) == 2
    assert plan_times.load(tmp_path / "times.json")["hertz-sphere reduced seed=5"].digest != other


def test_what_takes_too_long_is_left_out(runs, capsys):
    _, done, command = runs
    assert main([*command, "--most", "0.1"]) == 0
    assert done == []
    assert "left out" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("planned", "processor", "holds"),
    [(10.0, 19.0, True), (10.0, 21.0, False), (10.0, 5.1, True), (10.0, 4.9, False), (0.1 * LEAST, 0.9 * LEAST, True)],
)
def test_a_plan_holds_within_a_factor_of_two(planned, processor, holds):
    assert PlanTime(planned, processor, processor, "").holds == holds
