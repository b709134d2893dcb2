"""A stored result is stale when its scene has changed; renewal runs what is named, needed, or of another commit."""

import argparse
import json
from types import SimpleNamespace

import numpy as np
import pytest
import xarray

from reports import __main__ as command
from reports import reproduced, validation_origin, validation_renewal
from reports.validation_origin import origin, scene_hash, stale
from reports.validation_renewal import Job, is_needed, is_of_this_commit, jobs, renew
from reports.validation_values import EXPERIMENTS, STORED

SMALL = ("synthetic.shape=[256, 256]",)


@pytest.fixture
def small(tmp_path):
    return Job("map", "particles-afm-map", SMALL, tmp_path / "kept" / "map.json")


@pytest.fixture(autouse=True)
def record(tmp_path, monkeypatch):
    monkeypatch.setattr(reproduced, "RECORD", tmp_path / "reproduced.json")


def test_a_result_without_origin_is_stale():
    assert stale("uniform-asperities", {"kind": "asperities"}).startswith("stale: stored without")


def test_a_result_is_stale_when_the_text_of_its_scene_has_changed():
    summary = {"kind": "friction", "origin": origin("stribeck-mineral-oil")}
    assert stale("stribeck-mineral-oil", summary) == ""
    other = {**summary, "origin": {**summary["origin"], "scene_hash": "0"}}
    assert stale("stribeck-mineral-oil", other) == "stale: scene changed since"
    older = {**summary, "origin": {**summary["origin"], "code_hash": "0", "commit": "0"}}
    assert stale("stribeck-mineral-oil", older) == ""  # what its code gives now, `reports.reproduce` says
    set_otherwise = {**summary, "origin": origin("stribeck-mineral-oil", ["repetitions=1"])}
    assert stale("stribeck-mineral-oil", set_otherwise) == ""  # it holds for what was set, which the page shows
    set_otherwise["origin"]["settings"] = []
    assert stale("stribeck-mineral-oil", set_otherwise) == "stale: scene changed since"


def test_where_measured_surfaces_lie_is_no_part_of_the_scene():
    at = [scene_hash("stribeck-measured", [f"lower.surface.path={folder}/disk.al3d"]) for folder in ("/a", "/b/c")]
    assert at[0] == at[1] != scene_hash("stribeck-measured", ["lower.surface.path=/a/other.al3d"])


def test_renewal_stores_a_result_with_its_origin_and_knows_what_is_needed(small, tmp_path):
    assert is_needed(small)
    assert renew([small], folder=tmp_path / "runs") == []
    stored = json.loads(small.target.read_text())
    assert stale(small.scene, stored) == ""
    assert stored["origin"] == origin(small.scene, SMALL)
    assert stored["status"] == "converged"
    assert not is_needed(small)
    reproduced.add("validation", {"map": "count 3, stored 5, bar 1"}, 1)
    assert is_needed(small)
    assert is_needed(Job(small.name, small.scene, (), small.target))  # other settings
    assert renew([small], folder=tmp_path / "runs") == []
    assert reproduced.outside("validation") == {}  # stored anew


def test_all_is_renewed_once_a_commit(small, tmp_path, monkeypatch):
    for module in (validation_origin, validation_renewal):
        monkeypatch.setattr(module, "commit", lambda: "before")
    renew([small], folder=tmp_path / "runs")
    assert is_of_this_commit(small)
    first = (tmp_path / "runs" / "map" / "summary.json").stat().st_mtime_ns
    renew([small], folder=tmp_path / "runs")  # finished on this commit
    assert (tmp_path / "runs" / "map" / "summary.json").stat().st_mtime_ns == first
    for module in (validation_origin, validation_renewal):
        monkeypatch.setattr(module, "commit", lambda: "now")
    assert not is_of_this_commit(small)
    renew([small], folder=tmp_path / "runs")
    assert (tmp_path / "runs" / "map" / "summary.json").stat().st_mtime_ns > first
    assert json.loads(small.target.read_text())["origin"]["commit"] == "now"


def test_names_decide_what_is_renewed(monkeypatch):
    """None: what is not of this commit; `needed`: what is needed; a name: that."""
    parser, renewed = argparse.ArgumentParser(), []
    for one in (validation_renewal.renew, validation_renewal.rerun):
        monkeypatch.setattr(validation_renewal, one.__name__, lambda chosen, say: renewed.extend(chosen) or [])
    monkeypatch.setattr(validation_renewal, "is_of_this_commit", lambda job: job.name != "wear-steel-steel")
    monkeypatch.setattr(validation_renewal, "is_needed", lambda job: job.name == "film_regimes")
    for asked, names in (
        ([], ["wear-steel-steel"]),
        (["needed"], ["film_regimes"]),
        (["uniform-asperities"], ["uniform-asperities"]),
        (["needed", "uniform-asperities"], ["film_regimes", "uniform-asperities"]),
    ):
        renewed.clear()
        assert command.renewed(parser, asked, []) == []
        assert [job.name for job in renewed] == names
    with pytest.raises(SystemExit):
        command.renewed(parser, ["no-such-result"], [])


def test_a_scene_that_cannot_run_does_not_stop_the_others(small, tmp_path):
    bad = Job("bad", "particles-afm-map", ("synthetic.shape=0",), tmp_path / "kept" / "bad.json")
    failed = renew([bad, small], folder=tmp_path / "runs")
    assert len(failed) == 1
    assert failed[0].startswith("bad: ")
    assert small.target.exists()
    assert not bad.target.exists()


def test_every_kept_result_can_be_renewed():
    targets = {job.target for job in jobs().values()}
    assert {*STORED.glob("*.json"), *EXPERIMENTS.glob("*.json")} <= targets
    for name, job in jobs().items():
        assert scene_hash(job.scene, job.settings), name


def test_cycles_of_a_wear_run_are_kept_case_by_case_mean_over_repetitions():
    radius = np.full((2, 1, 2, 3), np.nan)
    radius[0, 0] = [[1e-9, 2e-9, np.nan], [3e-9, 2e-9, np.nan]]
    array = xarray.DataArray(radius, dims=("load", "variant", "repetition", "cycle"))
    run = SimpleNamespace(summary={"kind": "wear"}, dataset={"radius": array, "particles": np.isfinite(array)})
    assert validation_renewal._history(run) == {
        "cycle_radius_nm": [[2.0, 2.0, None], [None, None, None]],
        "cycle_particles": [[1.0, 1.0, 0.0], [0.0, 0.0, 0.0]],
    }


def test_pressures_and_volumes_of_wear_and_radii_of_running_in_are_kept_cycle_by_cycle():
    def over_cycles(*values):
        return xarray.DataArray([values], dims=("load", "cycle"))

    data = {
        "radius": over_cycles(1e-9, 2e-9),
        "particles": over_cycles(5, 0),
        "volume": over_cycles(3e-18, 0.0),
        "contact_load": over_cycles(2.0, 2.0),
        "contact_area": over_cycles(1e-9, 2e-9),
    }
    kept = validation_renewal._history(SimpleNamespace(summary={"kind": "wear"}, dataset=data))
    assert kept["cycle_particles"] == [[5.0, 0.0]]
    assert kept["cycle_volume_um3"] == [[3.0, 0.0]]
    assert kept["cycle_pressure_Pa"] == [[2e9, 1e9]]
    sphere = 4 / 3 * np.pi * 100e-9**3
    data = {
        "volume_over_cycles": over_cycles(5 * sphere, 0.0),
        "particles_over_cycles": over_cycles(5.0, 0.0),
        "contact_share": over_cycles(0.9, 0.8),
        "friction_over_cycles": over_cycles(0.11, 0.1),
    }
    kept = validation_renewal._history(SimpleNamespace(summary={"kind": "running-in"}, dataset=data))
    assert kept == {
        "cycle_radius_nm": [[100.0, None]],
        "cycle_contact_share": [[0.9, 0.8]],
        "cycle_friction": [[0.11, 0.1]],
    }


def test_whatever_goes_wrong_with_one_leaves_the_others(small, tmp_path, monkeypatch):
    keep = validation_renewal.keep

    def broken(job, run):
        if job.name == "broken":
            raise ValueError("no such dimension")
        return keep(job, run)

    monkeypatch.setattr(validation_renewal, "keep", broken)
    other = Job("broken", small.scene, small.settings, tmp_path / "kept" / "broken.json")
    assert renew([other, small], folder=tmp_path / "runs") == ["broken: ValueError: no such dimension"]
    assert small.target.exists()


def test_measured_surfaces_without_their_files_are_left_alone(tmp_path):
    said = []
    job = Job("stribeck-measured", "stribeck-measured", (), tmp_path / "kept.json")
    assert renew([job], folder=tmp_path / "runs", say=said.append) == []
    assert "--set stribeck-measured:lower.surface.path=" in said[0]
    assert not job.target.exists()


def test_a_stored_result_of_measured_surfaces_is_not_due_for_want_of_their_files(tmp_path):
    settings = ["lower.surface.path=/a/disk.al3d", "upper.surface.path=/a/pin.opd"]
    job = Job("stribeck-measured", "stribeck-measured", (), tmp_path / "kept.json")
    job.target.write_text(json.dumps({"origin": origin("stribeck-measured", settings)}))
    assert not is_needed(job)
    assert is_needed(Job(job.name, job.scene, ("lower.surface.path=/a/other.al3d",), job.target))
    job.target.write_text(json.dumps({"origin": {**origin("stribeck-measured", settings), "scene_hash": "0"}}))
    assert is_needed(job)


def test_experiments_whose_results_are_stored_are_not_due():
    script = validation_renewal.Script("separation_datum")
    assert not is_needed(script)
    reproduced.add(script.name, {"34 um, 0.8 GPa": "undeformed_planes 53.2, stored 53.0, bar 0.1"}, 6)
    assert is_needed(script)
    reproduced.add(script.name, {"34 um, 0.8 GPa": reproduced.INSIDE}, 6)
    assert not is_needed(script)


def test_a_script_that_fails_does_not_stop_the_others(monkeypatch):
    ran = []

    def broken():
        raise ValueError("no")

    modules = {"old": broken, "other": lambda: ran.append("other")}
    monkeypatch.setattr(
        validation_renewal, "import_module", lambda name: SimpleNamespace(main=modules[name.rsplit(".", 1)[1]])
    )
    scripts = [validation_renewal.Script(name) for name in modules]
    assert validation_renewal.rerun(scripts) == ["old: ValueError: no"]
    assert ran == ["other"]
