"""A stored result is stale when its scene or the code that its kind runs has changed; renewal runs just those."""

import json
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
import xarray

from reports import validation_origin, validation_renewal
from reports.validation_origin import code_hash, modules, origin, scene_hash, stale
from reports.validation_renewal import Job, jobs, renew
from reports.validation_values import EXPERIMENTS, STORED

SMALL = ("synthetic.shape=[256, 256]",)


@pytest.fixture
def small(tmp_path):
    return Job("map", "particles-afm-map", SMALL, tmp_path / "kept" / "map.json")


def test_a_result_without_origin_is_stale():
    assert stale("uniform-asperities", {"kind": "asperities"}).startswith("stale: kept without")


def test_scene_and_code_each_make_a_result_stale():
    summary = {"kind": "friction", "origin": origin("stribeck-mineral-oil", "friction")}
    assert stale("stribeck-mineral-oil", summary) == ""
    for part, key in (("scene", "scene_hash"), ("code", "code_hash")):
        other = {**summary, "origin": {**summary["origin"], key: "0"}}
        assert stale("stribeck-mineral-oil", other) == f"stale: {part} changed since"
    set_otherwise = {**summary, "origin": origin("stribeck-mineral-oil", "friction", ["repetitions=1"])}
    assert stale("stribeck-mineral-oil", set_otherwise) == ""  # it holds for what was set, which the page shows
    set_otherwise["origin"]["settings"] = []
    assert stale("stribeck-mineral-oil", set_otherwise) == "stale: scene changed since"


def test_where_measured_surfaces_lie_is_no_part_of_the_scene():
    at = [scene_hash("stribeck-measured", [f"lower.surface.path={folder}/disk.al3d"]) for folder in ("/a", "/b/c")]
    assert at[0] == at[1] != scene_hash("stribeck-measured", ["lower.surface.path=/a/other.al3d"])


def test_code_of_a_kind_is_its_own_module_and_the_rooms_below():
    names = {
        kind: {"/".join(p.relative_to(validation_origin.CODE).parts) for p in modules(kind)}
        for kind in ("friction", "wear", "asperities")
    }
    assert names["friction"] >= {"scenes/kinds/friction.py", "scenes/build.py", "materials.py"}
    assert any(name.startswith("lubrication/") for name in names["friction"])
    assert not any(name.startswith("wear/") for name in names["friction"])
    assert any(name.startswith("stress/") for name in names["wear"])
    for kind, found in names.items():
        assert not any(name.startswith(("cli/", "plots/", "results/", "campaigns/")) for name in found), kind
    assert len({code_hash(kind) for kind in names}) == len(names)


def test_comments_and_docstrings_are_no_code():
    texts = ('"""A."""\nx = 1  # one\n', '"""B."""\n\n\nx = 1\n', "x = 2\n")
    bare = []
    for text in texts:
        bare.append(validation_origin._bare(text))
    assert bare[0] == bare[1] != bare[2]


def test_code_changed_since_a_result_was_stored_is_told_from_history(tmp_path, monkeypatch):
    def git(*words):
        return subprocess.run(
            ["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], cwd=tmp_path, check=True, capture_output=True
        )

    (tmp_path / "bem").mkdir()
    module, beside, result = tmp_path / "bem" / "m.py", tmp_path / "bem" / "other.py", tmp_path / "result.json"
    module.write_text("x = 1\n")
    monkeypatch.setattr(validation_origin, "CODE", tmp_path / "bem")
    monkeypatch.setattr(validation_origin, "modules", lambda kind: (module,))
    monkeypatch.setattr(validation_origin, "_bare_once", lambda path: validation_origin._bare(path.read_text()))
    assert validation_origin.changed_since_stored(result, ["any"]) == ""  # no history to tell
    git("init", "-q")
    result.write_text("{}")
    git("add", ".")
    git("commit", "-qm", "one")
    module.write_text("x = 1  # the same\n")
    beside.write_text("y = 1\n")
    assert validation_origin.changed_since_stored(result, ["any"]) == ""
    module.write_text("x = 2\n")
    assert validation_origin.changed_since_stored(result, ["any"]).endswith("code changed in bem/m.py")
    git("rm", "-q", "--cached", "bem/m.py")
    git("commit", "-qm", "two")
    (tmp_path / "result.json").write_text("{}\n")
    git("commit", "-qam", "three")
    git("add", ".")
    assert validation_origin.changed_since_stored(result, ["any"]).endswith("code changed in bem/m.py")  # a new one
    result.write_text("{} ")  # stored anew
    assert validation_origin.changed_since_stored(result, ["any"]) == ""


def test_renewal_keeps_a_result_with_its_origin_and_leaves_it_while_it_holds(small, tmp_path):
    said = []
    assert renew([small], folder=tmp_path / "runs", say=said.append) == []
    kept = json.loads(small.target.read_text())
    assert stale(small.scene, kept) == ""
    assert kept["origin"]["settings"] == list(SMALL)
    assert kept["status"] == "converged"
    assert renew([small], folder=tmp_path / "runs", say=said.append) == []
    assert len(said) == 1  # it held: nothing was run
    kept["origin"]["code_hash"] = "0"
    small.target.write_text(json.dumps(kept))
    assert renew([small], folder=tmp_path / "runs", say=said.append) == []
    assert len(said) == 2
    assert stale(small.scene, json.loads(small.target.read_text())) == ""


def test_a_run_begun_with_other_code_is_not_gone_on_with(small, tmp_path, monkeypatch):
    monkeypatch.setattr(validation_origin, "code_hash", lambda kind: "before")
    renew([small], folder=tmp_path / "runs")
    first = (tmp_path / "runs" / "map" / "summary.json").stat().st_mtime_ns
    monkeypatch.undo()
    renew([small], folder=tmp_path / "runs")
    assert (tmp_path / "runs" / "map" / "summary.json").stat().st_mtime_ns > first
    assert json.loads(small.target.read_text())["origin"]["code_hash"] == code_hash("particles")


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
    run = SimpleNamespace(summary={"kind": "wear"}, dataset={"radius": array})
    assert validation_renewal._history(run) == {"cycle_radius_nm": [[2.0, 2.0, None], [None, None, None]]}


def test_pressures_and_volumes_of_wear_and_radii_of_running_in_are_kept_cycle_by_cycle():
    def over_cycles(*values):
        return xarray.DataArray([values], dims=("load", "cycle"))

    data = {
        "radius": over_cycles(1e-9, 2e-9),
        "volume": over_cycles(3e-18, 0.0),
        "contact_load": over_cycles(2.0, 2.0),
        "contact_area": over_cycles(1e-9, 2e-9),
    }
    kept = validation_renewal._history(SimpleNamespace(summary={"kind": "wear"}, dataset=data))
    assert kept["cycle_volume_um3"] == [[3.0, 0.0]]
    assert kept["cycle_pressure_Pa"] == [[2e9, 1e9]]
    sphere = 4 / 3 * np.pi * 100e-9**3
    data = {
        "volume_over_cycles": over_cycles(5 * sphere, 0.0),
        "particles_over_cycles": over_cycles(5.0, 0.0),
        "contact_share": over_cycles(0.9, 0.8),
    }
    kept = validation_renewal._history(SimpleNamespace(summary={"kind": "running-in"}, dataset=data))
    assert kept == {"cycle_radius_nm": [[100.0, None]], "cycle_contact_share": [[0.9, 0.8]]}


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


def test_scripts_are_run_where_their_result_is_stale(monkeypatch):
    ran, module = [], SimpleNamespace(main=lambda: ran.append("main"))
    monkeypatch.setattr(validation_renewal, "import_module", lambda name: module)
    monkeypatch.setattr(validation_renewal.kept, "stale", lambda name: "" if name == "fresh" else "not run")
    scripts = [validation_renewal.Script(name) for name in ("fresh", "old")]
    assert validation_renewal.rerun(scripts) == []
    assert ran == ["main"]

    def broken():
        raise ValueError("no")

    module.main = broken
    assert validation_renewal.rerun(scripts) == ["old: ValueError: no"]
