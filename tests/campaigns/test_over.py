"""The table `[over]`: any keys of any kind, their combinations, repetitions; one dataset with all of it."""

import numpy as np
import pytest
from small_scenes import CONTACT

from bem.errors import InputError
from bem.materials import CATALOGUE
from bem.runs import plan_scene, run_scene


def over(**keys):
    return CONTACT | {"over": keys["over"]} | {key: value for key, value in keys.items() if key != "over"}


def test_all_combinations_of_any_keys_are_one_dataset(tmp_path):
    scene = over(
        over={"contact": {"mean_pressure": "log:20 MPa:80 MPa:3"}, "lower.material": ["steel-disk", "brass-disk"]}
    )
    run = run_scene(scene, tmp_path / "run")
    drawn = {path.stem for path in (tmp_path / "run" / "figures").glob("*.png")}
    assert {"pressure-map", "figures-over-keys"} <= drawn
    assert not [note for note in run.summary["notes"] if note["code"] == "side-task-failed"]
    data = run.dataset
    assert data["contact_area_fraction"].dims == ("contact.mean_pressure", "lower.material")
    np.testing.assert_allclose(data["contact.mean_pressure"], [20e6, 40e6, 80e6], rtol=1e-11)  # twelve digits typed
    assert data["contact.mean_pressure"].attrs["units"] == "Pa"
    assert list(data["lower.material"].values) == ["steel-disk", "brass-disk"]
    assert data["pressure"].dims == ("contact.mean_pressure", "lower.material", "x", "y")
    assert (np.diff(data["contact_area_fraction"].values, axis=0) > 0).all(), "more load, more contact"
    # the cap follows the material of each case, not that of the scene as a whole
    caps = [CATALOGUE[name].material.hardness for name in ("steel-disk", "brass-disk")]
    np.testing.assert_array_equal(data["pressure"].values.max(axis=(0, 2, 3)), caps)
    assert len(run.summary["load_N"]) == 6
    for i, pressure in enumerate(data["contact.mean_pressure"].values):
        one, _ = plan_scene(CONTACT, [f"contact.mean_pressure={float(pressure)!r}"])
        alone = run_scene(one, tmp_path / f"alone-{i}", figures=False)
        assert alone.summary["contact_area_fraction"] == run.summary["contact_area_fraction"][2 * i]


def test_a_key_below_a_material_of_the_catalogue_does_what_it_does_in_a_scene(tmp_path):
    """The yield stress follows the hardness, as where the scene itself says another hardness."""
    scene = over(over={"lower.material.hardness": ["1 GPa", "2 GPa"]}, outputs={"von_mises": True, "vtk": False})
    data = run_scene(scene, tmp_path / "over", figures=False).dataset
    for i, hardness in enumerate(("1 GPa", "2 GPa")):
        alone = run_scene(
            CONTACT | {"outputs": {"von_mises": True, "vtk": False}},
            tmp_path / str(i),
            settings=[f"lower.material.hardness={hardness}"],
            figures=False,
        )
        assert alone.summary["yielded_volume_m3"] == float(data["yielded_volume"][i])


def test_repetitions_of_any_kind(tmp_path):
    run = run_scene(CONTACT | {"repetitions": 3}, tmp_path / "three", figures=False)
    each = run.summary["approach_m_each"]
    assert len(set(each)) == 3, "surfaces of their own"
    assert run.summary["approach_m"] == pytest.approx(np.mean(each), rel=1e-15)
    assert run.summary["approach_m_spread"] == pytest.approx(np.std(each, ddof=1), rel=1e-14)
    assert run.dataset["pressure"].dims == ("repetition", "x", "y")
    alone = run_scene(CONTACT, tmp_path / "one", figures=False)
    assert alone.summary["approach_m"] == each[0], "the first repetition is the scene without repetitions"


def test_the_scene_file_runs_again_to_the_same_bits(tmp_path):
    scene = over(over={"seed": [1, 2]}, repetitions=2)
    first = run_scene(scene, tmp_path / "a", figures=False)
    again = run_scene(tmp_path / "a" / "scene.toml", tmp_path / "b", figures=False)
    assert first.dataset["pressure"].dims == ("seed", "repetition", "x", "y")
    np.testing.assert_array_equal(first.dataset["pressure"].values, again.dataset["pressure"].values)


def test_grids_of_their_own_keep_the_maps_of_the_last(tmp_path):
    run = run_scene(over(over={"grid.shape": [16, 24]}), tmp_path / "run", figures=False)
    assert run.dataset["pressure"].shape == (24, 24)
    assert run.dataset["contact_area_fraction"].dims == ("grid.shape",)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"contact.loud": ["1 N", "2 N"]}, "loud: unknown key"),
        ({"contact.mean_pressure": ["20 MPa", "20 N"]}, 'at contact.mean_pressure = "20 N"'),
        ({"seed": []}, "no list of values"),
        ({"seed": [1, 1]}, "same value twice"),
        ({"seed": "1:2:x"}, "count"),
        ({"": [1]}, "no key"),
        ("seed", "not a table of keys"),
    ],
)
def test_what_cannot_be_run_is_said_before_any_work(tmp_path, table, words):
    with pytest.raises(InputError) as caught:
        run_scene(over(over=table), tmp_path / "run")
    assert words in str(caught.value)
    assert not (tmp_path / "run").exists()
