"""Central pressures of point films have no bar where the spike before the outlet lies at the centre."""

import numpy as np
import pytest

from bem import Lubricant
from bem.accuracy.point import PointCase, point_bars, spike_at_centre

pytestmark = pytest.mark.internal


@pytest.mark.parametrize(("width", "flat", "spiked"), [(0.08, 0.3, True), (0.08, 3.0, False), (0.6, 0.3, False)])
def test_a_spike_is_steep_and_the_highest(width, flat, spiked):
    x = (np.arange(41) - 20) * 0.1
    spike = np.exp(-(x[:, None] ** 2 + x[None] ** 2) / width**2)
    away = flat * np.exp(-((x[:, None] + 1) ** 2) / 0.3**2) * np.ones(41)
    assert spike_at_centre(x, x, spike + away) is spiked


def test_a_film_with_its_spike_at_the_centre_has_no_bar_of_the_central_pressure():
    # Moes' M 2.1 and L 11: the central pressure was 44 % off under a bar of 6 %
    modulus, radius, coefficient, viscosity = 50e9, 0.02, 2e-8, 0.1
    number = (11.3 / (coefficient * 2 * modulus)) ** 4
    mean = 0.5 * number * 2 * modulus * radius / viscosity
    case = PointCase(
        load=2.13 * 2 * modulus * radius**2 * number**0.75,
        radii=(radius, radius / 3.7),
        contact_modulus=modulus,
        speeds=((mean, 0.0), (mean, 0.0)),
        lubricant=Lubricant(
            viscosity, pressure_viscosity=coefficient, viscosity_law="barus", density_law="incompressible"
        ),
        cells=(47, 47),
    )
    bars = point_bars(case, case.on(case.cells))
    assert bars.values["central_pressure"] is None
    assert any(note.values["reason"] == "spike-at-centre" for note in bars.notes)
    assert all(bars.values[name] > 0 for name in ("central_thickness", "minimum_thickness"))
