"""Error bars of rough films by waves, against ten stored marches that their factors were not chosen on."""

import json

from bem.accuracy.waves import FILM, MINIMUM, PRESSURE, wave_bars
from bem.lubrication.waves.plateau import Plateau
from bem.lubrication.waves.ripples import FilmRipples
from reports.experiments.wave_ripples import DESIGN, JUDGED, RESULT


def bars_of(row):
    """Bars of the figures of a stored row, from ripples with its standard deviations."""
    plateau = Plateau(row["central"], 1e9, 1e6, 1e6, 0.0, 1.15e11, 1.0, 1e-5, 1e-4)
    empty = [None] * 8
    ripples = FilmRipples(
        *empty,
        rms_heights=row["heights"],
        rms_film_ripple=row["film"]["waves"],
        rms_pressure_ripple=row["pressure"]["waves"],
        minimum_thickness=row["minimum"]["waves"],
        touching_share=0.0,
        tension_share=0.0,
        plateau=plateau,
    )
    return wave_bars(ripples).values


def covered(rows, shrink=1.0):
    found = []
    for row in rows:
        bars = bars_of(row)
        for name, bar in (("film", "film_ripple"), ("pressure", "pressure_ripple"), ("minimum", None)):
            bar = bars[bar or "rough_minimum_thickness"]
            found.append(abs(row[name]["marched"] - row[name]["waves"]) <= shrink * bar)
    return sum(found) / len(found)


def test_nine_in_ten_marched_figures_are_within_their_bars():
    rows = json.loads(RESULT.read_text("utf-8"))["found"]
    assert len(rows["judged"]) == sum(JUDGED.values())
    assert len(rows["design"]) == sum(DESIGN.values())
    assert covered(rows["judged"]) >= 0.9
    # bars that cover anything would say nothing
    assert covered(rows["judged"], shrink=0.3) < 0.7


def test_bars_grow_with_the_heights_over_the_film():
    row = {
        "central": 1e-7,
        "heights": 5e-8,
        "film": {"waves": 1e-8},
        "pressure": {"waves": 1e8},
        "minimum": {"waves": 1e-8},
    }
    low, high = bars_of(row), bars_of(row | {"heights": 1e-7})
    assert low["film_ripple"] / 1e-8 == FILM[0] + 0.5 * FILM[1]
    assert high["pressure_ripple"] / 1e8 == PRESSURE[0] + PRESSURE[1]
    assert low["rough_minimum_thickness"] == MINIMUM * 1e-8
