"""Criteria against numpy's eigenvalues."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.wear.criterion import MaximumTension, Tresca, VonMises, principal_stresses

pytestmark = pytest.mark.internal


def matrices(stress):
    xx, yy, zz, yz, xz, xy = stress
    return np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), (0, 1), (-2, -1))


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 10**6), scale=st.sampled_from([1e-3, 1.0, 1e9]))
def test_principal_stresses_are_the_eigenvalues(seed, scale):
    stress = scale * np.random.default_rng(seed).standard_normal((6, 40))
    expected = np.moveaxis(np.linalg.eigvalsh(matrices(stress)), -1, 0)
    # an angle from arccos near +-1 has half the digits: two equal principal stresses split by sqrt(eps)
    assert np.allclose(principal_stresses(stress), expected, rtol=0, atol=3e-7 * scale)


@pytest.mark.parametrize(
    ("stress", "von_mises", "shear", "tension"),
    [
        ([0, 0, 0, 0, 0, 0], 0, 0, 0),
        ([-1, -1, -1, 0, 0, 0], 0, 0, 0),
        ([2, 0, 0, 0, 0, 0], 2, 2, 2),
        ([0, 0, 0, 0, 1, 0], np.sqrt(3), 2, 1),
        ([0, 0, -3, 0, 0, 0], 3, 3, 0),
    ],
)
def test_known_states(stress, von_mises, shear, tension):
    state = np.array(stress, dtype=float)[:, None]
    assert VonMises().equivalent_stress(state)[0] == pytest.approx(von_mises, abs=1e-12)
    assert Tresca().equivalent_stress(state)[0] == pytest.approx(shear, abs=1e-7)
    assert MaximumTension().equivalent_stress(state)[0] == pytest.approx(tension, abs=1e-7)


def test_tresca_is_within_its_factor_of_von_mises():
    """The factor decides what may be skipped: it must be an upper bound, and one that is attained."""
    stress = np.random.default_rng(1).standard_normal((6, 5000))
    ratio = Tresca().equivalent_stress(stress) / VonMises().equivalent_stress(stress)
    factor = Tresca().von_mises_factor
    assert ratio.max() <= factor * (1 + 1e-9)
    assert ratio.max() > 0.999 * factor
