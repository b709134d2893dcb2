"""Kind `friction`: what a scene gives, variants, resuming."""

import numpy as np
import pytest

from bem.scenes import PlainContext
from bem.scenes.kinds.friction import KIND, FrictionScene

SCENE = {
    "kind": "friction",
    "grid": {"shape": 64, "spacing": "1.4 um", "periodic": [False, True]},
    "lower": {
        "material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3, "hardness": "6 GPa"},
        "surface": {"kind": "generated", "rms_height": "100 nm", "correlation_length": "5 um"},
    },
    "upper": {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}},
    "cylinder": {"radius": "2 mm", "width": "6 mm", "load": "5.5 N"},
    "lubricant": {"viscosity": "0.36 Pa*s", "pressure_viscosity": "25 1/GPa"},
    "friction": {
        "speeds": ["1 mm/s", "0.03 m/s", "0.3 m/s"],
        "boundary_friction": 0.15,
        "models": ["capped", "uncoupled-capped"],
        "film_points": 150,
    },
    "repetitions": 2,
}


def run(changes=None, context=None):
    scene = FrictionScene.model_validate(SCENE | (changes or {}))
    return KIND.run(KIND.resolve(scene), context or PlainContext())


def test_summary_and_variables():
    outcome = run()
    summary = outcome.summary
    assert str(outcome.status) == "converged"
    assert summary["speed_m_s"] == [0.001, 0.03, 0.3]
    for key in ("friction", "contact_load_N", "film_load_N", "minimum_film_nm", "lambda_ratio"):
        assert len(summary[key]) == 3
    assert summary["friction"][0] == pytest.approx(0.15, rel=0.05)
    assert summary["contact_load_N"][2] == 0
    np.testing.assert_allclose(np.add(summary["contact_load_N"], summary["film_load_N"]), 5.5, rtol=1e-4)
    assert len(summary["friction_standard_deviation"]) == 3
    assert set(summary["friction_by_curve"]) == {"capped", "uncoupled-capped"}
    assert len(summary["largest_difference_percent"]["uncoupled-capped"]) == 2
    variables = outcome.variables
    assert variables["friction"].values.shape == (4, 3)
    total = variables["boundary_part"].values + variables["film_part"].values
    np.testing.assert_allclose(total, variables["friction"].values, rtol=1e-12)
    assert variables["section_film"].values.shape == (3, 64)
    # what the film is thicker than the separation is the shift: none in full film
    shift = variables["section_film"].values - variables["section_separation"].values
    assert (shift[0] > 0).all()
    assert (shift[2] == 0).all()


def test_variants_change_what_they_say():
    changes = {
        "variants": [{"name": "light", "load": "2 N"}, {"name": "rough", "lower_rms_height": "300 nm"}],
        "repetitions": 1,
        "friction": SCENE["friction"] | {"models": ["elastic"]},
    }
    outcome = run(changes)
    loads = outcome.variables["contact_load"].values + outcome.variables["film_load"].values
    np.testing.assert_allclose(loads[0], 2.0, rtol=1e-4)
    np.testing.assert_allclose(loads[1], 5.5, rtol=1e-4)
    assert outcome.variables["lambda_ratio"].values[1, 0] < outcome.variables["lambda_ratio"].values[0, 0]


def test_plan_says_what_is_skipped():
    scene = KIND.resolve(FrictionScene.model_validate(SCENE))
    steps = {step.name: step for step in KIND.plan(scene).steps}
    assert not steps["rough contact"].skipped
    assert steps["stresses"].skipped
    only = SCENE | {"friction": SCENE["friction"] | {"models": ["uncoupled-elastic"]}}
    steps = {step.name: step for step in KIND.plan(KIND.resolve(FrictionScene.model_validate(only))).steps}
    assert steps["rough contact"].skipped


def test_resumed_run_gives_the_same_bits():
    class Recorder(PlainContext):
        states: list = []  # noqa: RUF012

        def save(self, state):
            self.states.append({"records": list(state["records"])})

    class Resumed(PlainContext):
        def saved(self):
            return {"records": list(Recorder.states[1]["records"])}

    whole = run(context=Recorder())
    again = run(context=Resumed())
    np.testing.assert_array_equal(whole.variables["friction"].values, again.variables["friction"].values)


@pytest.mark.parametrize(
    "changes",
    [
        {"lubricant": {"viscosity": "0 Pa*s"}},
        {"lubricant": {"viscosity": "0.36 Pa*s", "shear_law": "eyring"}},
        {"friction": SCENE["friction"] | {"speeds": [0.0]}},
        {"lower": SCENE["lower"] | {"surface": "smooth"}},
    ],
)
def test_refusals(changes):
    with pytest.raises(ValueError, match=r"allowed|greater|input"):
        FrictionScene.model_validate(SCENE | changes)
