"""Kind `film`: a film in time from a scene."""

import numpy as np
import pytest
from pydantic import ValidationError
from small_scenes import FILM

from bem.campaigns.collect import outcome_of
from bem.kinds.film.kind import KIND
from bem.kinds.film.scene import FilmScene
from bem.scenes import PlainContext

pytestmark = pytest.mark.internal

SCENE = FILM | {
    "motion": {"kind": "table", "times": ["0 s", "5 ms", "10 ms"], "speeds": ["0.05 m/s", "0 m/s", "0.05 m/s"]},
    "march": {"duration": "12 ms", "steps": 40, "points": 201},
}


def run(changes=None):
    scene = FilmScene.model_validate(SCENE | (changes or {}))
    return outcome_of(scene, KIND.run(scene, PlainContext()))


def test_stop_and_start():
    outcome = run()
    assert str(outcome.status) == "converged"
    variables = outcome.variables
    film = variables["minimum_film"].values
    time = variables["time"].values
    assert film.shape == time.shape == (41,)
    assert variables["thickness"].values.shape == (41, 201)
    thinnest = time[film.argmin()]
    assert 4e-3 < thinnest < 8e-3  # while it stands, or just after
    assert outcome.summary["thinnest_film_time_s"] == pytest.approx(thinnest)
    assert outcome.summary["thinnest_film_nm"] == pytest.approx(1e9 * film.min())
    assert outcome.summary["volume_imbalance"] < 1e-4
    load = np.trapezoid(variables["film_pressure"].values, variables["film_x"].values, axis=1)
    np.testing.assert_allclose(load[1:] * 6e-3, 5.5, rtol=1e-5)
    assert load[0] * 6e-3 == pytest.approx(5.5, rel=2e-3)  # the steady film, put on this mesh


def test_figures_have_their_errors():
    summary = run().summary
    for name in ("thinnest_film_nm", "film_at_end_nm", "largest_friction_force_N"):
        assert 0 < summary[f"{name}_error"] < summary[name], name
    # its bar covered 69 % of errors
    assert summary["thinnest_film_time_s_error"] is None
    assert "volume_imbalance_error" not in summary
    assert not [key for key in run({"outputs": {"errors": False}}).summary if key.endswith("_error")]


def test_reciprocating_and_changing_load():
    outcome = run(
        {
            "motion": {"kind": "reciprocating", "speed": "0.1 m/s", "period": "40 ms"},
            "cylinder": SCENE["cylinder"] | {"load_end": "8 N"},
            "march": {"duration": "20 ms", "steps": 40, "points": 201},
        }
    )
    speed = outcome.variables["speed"].values
    assert speed[0] == pytest.approx(0.1)
    assert speed[-1] == pytest.approx(-0.1)
    friction = outcome.variables["friction"].values
    assert friction[0] > 0 > friction[-1]
    load = np.trapezoid(outcome.variables["film_pressure"].values[-1], outcome.variables["film_x"].values)
    assert load * 6e-3 == pytest.approx(8.0, rel=1e-5)


def test_friction_has_its_scatter_from_the_oil_where_its_constants_are_known():
    oil = {"grade": "ISO VG 68", "temperature": "60 degC"}
    march = {"duration": "12 ms", "steps": 48, "points": 201}
    changes = {"oil": oil, "cylinder": SCENE["cylinder"] | {"load": "500 N"}, "outputs": {"errors": False}}
    outcome = run(changes | {"march": march})
    friction, scatter = (outcome.variables[name].values for name in ("friction", "friction_oil_scatter"))
    sliding = np.abs(outcome.variables["speed"].values) > 0.01
    # oils of one base differ by a fifth; the rolling part of the force has none of it
    assert (0.03 * np.abs(friction[sliding]) < scatter[sliding]).all()
    assert (scatter[sliding] < 0.5 * np.abs(friction[sliding])).all()
    standing = np.abs(outcome.variables["speed"].values) < 1e-12
    assert standing.any()
    assert (scatter[standing] < 1e-9).all()
    largest = np.abs(friction).argmax()
    assert outcome.summary["largest_friction_force_oil_scatter_N"] == pytest.approx(500 * scatter[largest], rel=0.01)
    limited = run(changes | {"oil": oil | {"shear_law": "limited"}})
    assert "friction_oil_scatter" not in limited.variables
    assert "largest_friction_force_oil_scatter_N" not in limited.summary


def test_cavitation_is_an_option():
    motion = {"motion": {"kind": "reciprocating", "speed": "0.05 m/s", "period": "4 ms"}}
    short = {"duration": "2 ms", "steps": 40, "points": 201}
    made = run(motion | {"march": short})
    kept = run(motion | {"march": short | {"cavitation": "mass_conserving"}})
    assert "film_fraction" not in made.variables
    fraction = kept.variables["film_fraction"].values
    assert fraction.shape == (41, 201)
    assert fraction.min() < 0.1  # far behind the exit
    # the film that forms at the former exit has only the oil that left there
    assert kept.summary["film_at_end_nm"] < 0.9 * made.summary["film_at_end_nm"]
    assert kept.summary["volume_imbalance"] < 1e-5
    with pytest.raises(ValidationError, match="mass_conserving"):
        FilmScene.model_validate(SCENE | {"march": short | {"cavitation": "jfo"}})


def test_plan_skips_the_rough_contact():
    steps = {step.name: step for step in KIND.plan(FilmScene.model_validate(SCENE)).steps}
    assert steps["rough contact"].skipped
    assert not steps["film in time"].skipped


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"motion": {"kind": "table", "times": ["0 s", "1 s"], "speeds": [0.0, 0.1]}}, "rest"),
        ({"motion": {"kind": "table", "times": ["1 s", "0 s"], "speeds": [0.1, 0.1]}}, "rise"),
        ({"motion": {"kind": "table", "times": ["0 s", "1 s", "2 s"], "speeds": [0.1, 0.1]}}, "as many"),
        ({"motion": {"kind": "reciprocating", "speed": 0.1}}, "period"),
        ({"lower": FILM["lower"] | {"surface": {"kind": "generated", "rms_height": 1e-7, "hurst": 0.8}}}, "rough"),
    ],
)
def test_refusals(changes, word):
    with pytest.raises(ValidationError, match=word):
        FilmScene.model_validate(SCENE | changes)
