"""What the page shows of finished runs: one map at a time, few runs over each other, and no more read than is drawn."""

import json

import numpy as np
import pytest
from small_scenes import CONTACT

import bem.plots.compare
from bem import InputError, ResultsError, open_run, run_scene
from bem.app import run_view as views
from bem.app.run_view import MOST_COMPARED, comparison, map_view, overlay, partial_view, run_view, solid_view
from bem.campaigns import campaign_of
from bem.campaigns.refine import solve_case
from bem.results.checkpoint import save_checkpoint
from bem.scenes.kind import get_kind
from bem.scenes.load import load_scene
from bem.scenes.records import pack

pytestmark = pytest.mark.internal

SMALL = {key: CONTACT[key] for key in ("kind", "grid", "lower", "contact")}
DEPTHS = [0.0, 1e-7, 2e-7]


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    for number, load in enumerate((80e6, 90e6), 1):
        scene = SMALL | {"outputs": {"errors": False, "von_mises": True, "depths": DEPTHS}}
        run_scene(scene | {"contact": {"mean_pressure": load}}, folder / f"a-{number:03d}", figures=False)
    return [folder / f"a-{number:03d}" for number in (1, 2)]


def test_a_run_without_its_maps(runs):
    found = run_view(runs[0])
    assert dict(found.tables[0].rows)["contact area fraction"].endswith("%")
    assert "pressure" in found.maps
    json.dumps([*found.over, *found.curves], allow_nan=False)


def test_answers_lead_and_the_load_that_was_given_is_none(runs):
    found = run_view(runs[0])
    assert found.main is None  # the map is what is looked for
    words = [one.words for one in found.answers]
    assert "contact area fraction" in words
    assert "residual" not in words


def test_colours_of_a_map_up_to_its_extremes(runs):
    """Without, they end where lone points begin, and the bar says so."""
    arrays = open_run(runs[0]).arrays
    values = np.asarray(arrays["pressure"].values)
    ends = [
        [map_view(runs[0], "contact", "pressure", 0, whole=whole).picture["data"][0][end] for end in ("zmin", "zmax")]
        for whole in (True, False)
    ]
    picture = map_view(runs[0], "contact", "pressure", 0, whole=True).picture
    factor = np.max(picture["data"][0]["z"]) / values.max()
    np.testing.assert_allclose(ends[0], [values.min() * factor, values.max() * factor], rtol=1e-5)
    assert "colours end" not in picture["data"][0]["colorbar"]["title"]["text"]


def test_what_is_finished_of_a_run_that_goes_on(tmp_path):
    """Two of three cases: their figures, and a curve over what varies, with the third left out."""
    scene = SMALL | {"outputs": {"errors": False}, "over": {"contact.mean_pressure": ["70 MPa", "80 MPa", "90 MPa"]}}
    folder = tmp_path / "run"
    run_scene(scene, folder, figures=False, workers=1)
    whole = open_run(folder).summary
    campaign = campaign_of(load_scene(folder / "scene.toml"))
    records = [compute_case(case) for case in campaign.cases[:2]]
    (folder / "cases").mkdir(exist_ok=True)
    for file in (folder / "cases").iterdir():
        file.unlink()
    for number, record in enumerate(records):
        state = {"_record": pack(record), "_notes": [], "_seconds": {}, "_wall_time_s": 1.0}
        save_checkpoint(folder / "cases" / f"{number:05d}.bin", state, "contact")
    found = partial_view(folder)
    assert (found.finished, found.cases) == (2, 3)
    drawn = found.pictures[0]["data"][0]
    assert drawn["y"][2] is None
    ratio = np.array(drawn["y"][:2]) / np.array(whole["contact_area_fraction"][:2])
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-5)
    json.dumps(found.pictures, allow_nan=False)


def compute_case(case):
    from bem.campaigns.context import CaseContext, Silent

    return solve_case(get_kind("contact"), case.scene, CaseContext(case, None, None, Silent(), 0.0))


def test_one_map_and_the_sections_through_a_place(runs):
    arrays, found = open_run(runs[0]).arrays, run_view(runs[0])
    name = next(name for name, layers in found.layers.items() if len(layers) > 1)
    index = len(found.layers[name]) - 1
    plain = np.asarray(arrays[name].values).reshape(-1, *arrays[name].shape[-2:])[index]
    view = map_view(runs[0], "contact", name, index)
    drawn = np.array(view.picture["data"][0]["z"]).T
    ratio = drawn.max() / plain.max()
    np.testing.assert_allclose(drawn, plain * ratio, rtol=1e-5, atol=1e-5 * drawn.max())
    at = (view.picture["data"][0]["x"][3], view.picture["data"][0]["y"][5])
    moved = map_view(runs[0], "contact", name, index, at=at)
    np.testing.assert_allclose(moved.sections["data"][0]["y"], drawn[:, 5], rtol=1e-5, atol=1e-5 * drawn.max())
    np.testing.assert_allclose(moved.sections["data"][1]["y"], drawn[3], rtol=1e-5, atol=1e-5 * drawn.max())


def test_of_a_stack_of_maps_one_is_read(runs):
    arrays = open_run(runs[0]).arrays
    name, stack = next((name, item) for name, item in arrays.items() if item.dims[-3:] == ("depth", "x", "y"))
    place = (len(DEPTHS) - 1,) if stack.ndim == 3 else (0, len(DEPTHS) - 1)
    one = stack.at(place)
    assert "values" not in vars(stack)
    np.testing.assert_array_equal(one, arrays[name].values[place])
    json.dumps(solid_view(runs[0], name, 0), allow_nan=False)


def test_runs_over_each_other_are_few_and_whole(runs, tmp_path):
    found = comparison(runs, ["a", "b"])
    results, scenes = ({row[0]: row[1:] for row in table.rows} for table in found.tables)
    assert scenes["contact: mean pressure"] == ("80 MPa", "90 MPa")  # names and units, not keys
    assert results["load"][1].endswith("(+12.5 %)")
    drawn = overlay(runs, ["a", "b"])
    assert all(len({trace["line"]["color"] for trace in one["data"]}) == 2 for one in drawn)
    json.dumps(drawn, allow_nan=False)
    for count in (0, 1, MOST_COMPARED + 1):
        with pytest.raises(InputError, match="allowed: 2 to"):
            comparison(runs[:1] * count, ["a"] * count)
        with pytest.raises(InputError, match="allowed: 2 to"):
            overlay(runs[:1] * count, ["a"] * count)
    with pytest.raises(ResultsError):
        overlay([runs[0], tmp_path], ["a", "b"])


def test_runs_over_each_other_read_what_they_draw(runs, monkeypatch):
    """Of all variables that the runs have, those of six panels."""
    looked = []
    panel = bem.plots.compare.panel
    monkeypatch.setattr(bem.plots.compare, "_MOST_PANELS", 2)
    monkeypatch.setattr(
        bem.plots.compare, "panel", lambda d, name, row=None: looked.append(name) or panel(d, name, row=row)
    )
    held = []
    monkeypatch.setattr(views, "opened_dataset", keep_open(views.opened_dataset, held))
    assert overlay(runs, ["a", "b"])
    drawable = len(held[0][1])
    assert len(set(looked)) < drawable
    for dataset, _ in held:
        arrays = {name: item for name, item in dataset.variables.items() if name not in dataset.indexes and item.ndim}
        assert arrays
        assert not [name for name, item in arrays.items() if item._in_memory]


def keep_open(opened, held):
    from contextlib import contextmanager

    @contextmanager
    def kept(path):
        with opened(path) as dataset:
            held.append((dataset, list(dataset.data_vars)))
            yield dataset

    return kept
