"""States of cells follow from their pressures."""

import numpy as np
import pytest

from bem.contact.solution import contact_state

pytestmark = pytest.mark.internal


def test_cells_are_open_elastic_or_capped():
    pressure = np.array([[0.0, 1e9], [6e9, 5.999e9]])
    assert contact_state(pressure).tolist() == [[0, 1], [1, 1]]
    assert contact_state(pressure, 6e9).tolist() == [[0, 1], [2, 1]]
    assert contact_state(pressure).dtype == np.int8
