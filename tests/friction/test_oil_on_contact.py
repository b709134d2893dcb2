"""Shear of the oil on cells in contact: what it is, that friction is without it, and when that is said."""

from typing import get_type_hints

import numpy as np
import pytest
from mixed_case import mixed_case

from bem import Lubricant, solve_mixed
from bem.accuracy.bars import ErrorBars
from bem.friction.result_notes import MATTERS, oil_on_contact_notes
from bem.kinds.friction.errors import notes_of_bars
from bem.kinds.friction.record import CurveRecord
from bem.notes import Level
from bem.notes.accuracy import NoBar, named
from bem.notes.friction import OIL_ON_CONTACT
from bem.notes.lubrication import INLET_FRICTION
from bem.scenes.lubrication import notes_of_balance

CASE = mixed_case(
    100,
    0.9e-6,
    4e-6,
    lubricant=Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
    boundary_friction=0.15,
)


def said(point):
    return [note for note in point.notes if note.code == OIL_ON_CONTACT.code]


@pytest.mark.internal
@pytest.mark.parametrize("speeds", [(0.03, 0.0), (0.0, 0.03)])
def test_what_is_left_out_is_the_films_stress_on_cells_in_contact(speeds):
    point = solve_mixed(**CASE, speeds=speeds)
    film, touching, resists = point.patch_film, point.contact_pressure > 0, 1 if speeds[0] > speeds[1] else -1
    more = point.oil_on_contact * point.load
    assert point.film_force + more == pytest.approx(resists * film.shear_force, rel=1e-12)
    # the contact's area is known better than by its cells, which have it too large (`bem.numerics.subcell`)
    stress = resists * np.broadcast_to(film.shear_stress, point.grid.shape)
    counted = float(stress[touching].sum()) * point.grid.cell_area * 6e-3 / point.grid.lengths[1]
    assert 0.7 * counted < more < counted
    assert bool(said(point)) is (point.oil_on_contact > MATTERS * point.friction)


def test_rolling_resistance_in_pure_rolling_is_that_of_the_whole_film():
    """Without the cells in contact it would be larger than the whole: pressure drives the oil there forward."""
    point = solve_mixed(**CASE, speeds=(0.03, 0.03))
    assert point.contact_load > 0.1 * point.load
    assert point.film_force == pytest.approx(point.patch_film.shear_force, rel=1e-12)
    assert point.friction * point.load == pytest.approx(point.film_force, rel=1e-12)
    assert point.oil_on_contact == 0
    assert not said(point)


@pytest.mark.internal
def test_less_friction_with_oil_on_contact_is_said_with_its_reason():
    (note,) = oil_on_contact_notes([(0.1, -0.03)])
    assert note.values["reason"] == "less"
    assert oil_on_contact_notes([(0.1, 0.03)])[0].values["reason"] == "more"


def test_nothing_is_left_out_of_a_full_film():
    point = solve_mixed(**CASE, speeds=(0.6, 0.0))
    assert point.full_film
    assert point.oil_on_contact == 0
    assert not said(point)


@pytest.mark.internal
def test_the_note_names_the_worst_of_many_speeds_and_is_silent_where_little_changes():
    assert oil_on_contact_notes([(0.1, 0.004), (0.05, -0.002), (0.0, 0.0)]) == ()
    (one,) = oil_on_contact_notes([(0.1, 0.01), (0.1, 0.004)])
    assert (one.values["with_oil"], one.values["friction"]) == pytest.approx((0.11, 0.1))
    assert not one.values["most"]
    (many,) = oil_on_contact_notes([(0.1, 0.01), (0.05, 0.02)])
    assert (many.values["with_oil"], many.values["friction"]) == pytest.approx((0.07, 0.05))
    assert many.values["most"]
    assert (one.level, many.level) == (Level.INFO, Level.CAUTION)
    assert oil_on_contact_notes([(0.0, 0.01)])


@pytest.mark.internal
def test_the_inlet_s_note_is_of_the_printed_friction_coefficient():
    """0.0066 of a film's coefficient of 0.018 is 1 % of the whole friction where asperities carry most of the load."""
    own = INLET_FRICTION(added=0.0066, friction=0.018, reason="film")
    assert notes_of_balance([own], [own], 0.1266, 0.19) == ()
    (note,) = notes_of_balance([own], [own], 0.04, 0.5)
    assert note.values["added"] == pytest.approx(0.0033)
    assert note.values["friction"] == pytest.approx(0.04)
    assert "0.04, counts asperities" in note
    assert notes_of_balance([own], [own]) == (own.at("film"),)  # of a kind that prints no friction coefficient


def test_what_has_no_error_bar_is_named_as_a_second_balance():
    (figure,) = get_type_hints(CurveRecord, include_extras=True)["loaded_friction"].__metadata__
    assert "else those of a second balance" in figure.no_bar


def test_missing_bars_of_an_extrapolated_film_are_said_once_and_by_the_names_of_the_table():
    """Two notes gave one reason, of the lambda ratio and of a minimum that the table does not have."""
    bars = ErrorBars().without("lambda_ratio", NoBar.SCALED_FILM).without("minimum_film", NoBar.SCALED_FILM)
    (note,) = notes_of_bars(bars)
    assert set(note.values["figures"]) == set(
        named(["lambda_ratio", "minimum_film_whole", "minimum_film", "lambda_ratio_mixed"])
    )
    assert "up to 20 times too large, or a third" in note
