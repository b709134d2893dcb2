"""Random scenes of the kind `contact`, run to the end: an answer within its bounds, or one clear refusal."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.campaigns.collect import outcome_of
from bem.errors import InputError, Status
from bem.runs import plan_scene
from bem.scenes import PlainContext, get_kind

pytestmark = pytest.mark.internal

KIND = get_kind("contact")


def decades(low, high):
    return st.floats(low, high, allow_nan=False).map(lambda power: float(f"{10.0**power:.3g}"))


moduli = st.fixed_dictionaries(
    {"youngs_modulus": decades(3, 12), "poissons_ratio": st.sampled_from([-0.5, 0.0, 0.1, 0.3, 0.49])},
    optional={"hardness": decades(5, 11)},
)
surfaces = st.one_of(
    st.just({"kind": "smooth"}),
    st.fixed_dictionaries(
        {
            "kind": st.just("generated"),
            "rms_height": decades(-10, -5),
            "correlation_length": decades(-6, -4),
            "skewness": st.sampled_from([0.0, -0.5]),
            "kurtosis": st.sampled_from([3.0, 4.0]),
        }
    ),
)
shapes = st.sampled_from(
    [
        {"kind": "flat"},
        {"kind": "sphere", "radius": "1 mm"},
        {"kind": "cylinder", "radius": 1e-5},
        {"kind": "ellipsoid", "radius": 1e-3, "radius_y": 1.0},
        {"kind": "sinusoid", "amplitude": "10 nm", "wavelength": "8 um"},
    ]
)
controls = st.one_of(
    st.fixed_dictionaries({"load": decades(-12, 3)}),
    st.fixed_dictionaries({"mean_pressure": decades(0, 10)}),
    st.fixed_dictionaries({"approach": st.one_of(decades(-11, -5), st.just(-1e-9), st.just(0.0))}),
    st.fixed_dictionaries({"mean_gap": decades(-11, -5)}),
)
scenes = st.fixed_dictionaries(
    {
        "kind": st.just("contact"),
        "seed": st.integers(0, 3),
        "grid": st.fixed_dictionaries(
            {
                "shape": st.tuples(st.sampled_from([1, 2, 7, 8, 12]), st.sampled_from([1, 3, 8])).map(list),
                "spacing": st.sampled_from([[1e-6, 1e-6], [1e-6, 5e-6]]),
                "periodic": st.tuples(st.booleans(), st.booleans()).map(list),
            }
        ),
        "lower": st.fixed_dictionaries({"material": moduli, "surface": surfaces}),
        "upper": st.one_of(st.just({}), st.fixed_dictionaries({"material": moduli, "surface": surfaces})),
        "shape": shapes,
        "contact": st.tuples(
            controls,
            st.sampled_from([{}, {"behaviour": "capped"}, {"behaviour": "capped", "hardness": 1e9}]),
            st.sampled_from([{}, {"friction": 0.3}]),
        ).map(lambda parts: parts[0] | parts[1] | parts[2] | {"max_iterations": 500}),
        "outputs": st.sampled_from([{}, {"von_mises": True, "depths": [0.0, 1e-6]}, {"stresses": True}]),
    }
)


@given(scenes)
@settings(deadline=None, max_examples=60, derandomize=True)
def test_an_answer_within_its_bounds_or_a_refusal(data):
    try:
        scene, _ = plan_scene(data)
        outcome = outcome_of(scene, KIND.run(scene, PlainContext(scene.seed)))
    except InputError as error:
        assert all(error.messages)  # noqa: PT017
        return
    assert outcome.status in Status
    pressure = outcome.variables["pressure"].values
    cap = scene.contact.hardness or np.inf
    assert np.isfinite(pressure).all()
    assert pressure.min() >= 0
    assert pressure.max() <= cap
    for name, item in outcome.variables.items():
        if item.values.dtype.kind == "f":
            assert np.isfinite(item.values).all(), name
    if outcome.status == Status.CONVERGED:
        assert outcome.summary["residual"] <= scene.contact.tolerance
        if scene.contact.load is not None:
            # the load is a constraint of the solver, met to round-off
            assert np.isclose(outcome.summary["load_N"], scene.contact.load, rtol=1e-9)
    else:
        assert outcome.where
