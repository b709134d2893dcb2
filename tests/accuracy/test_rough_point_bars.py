"""Error bars of films with contact inside: what they have where half as many cells differ by chance in little."""

import re
from dataclasses import replace

import numpy as np
import pytest

from bem import Lubricant
from bem.accuracy.rough_point import (
    RULES,
    SMALL,
    STEEP,
    RoughPointCase,
    at_rim,
    narrow_notes,
    opening,
    rough_point_bars,
)
from bem.errors import Status
from bem.reference_solutions.hertz import ellipse_contact

pytestmark = pytest.mark.internal

RADIUS, LOAD, MODULUS = 0.01, 20.0, 115e9
AREA = np.pi * np.prod(ellipse_contact(radii=(RADIUS, RADIUS), contact_modulus=MODULUS, load=LOAD).semi_axes)
HALF = np.sqrt(AREA / np.pi)
CASE = RoughPointCase(
    load=LOAD,
    radii=(RADIUS, RADIUS),
    contact_modulus=MODULUS,
    speeds=((0.0, 0.0), (1e-3, 0.0)),
    lubricant=Lubricant(
        0.03, pressure_viscosity=18e-9, shear_law="eyring", shear_stress_limit=5e6, density_law="incompressible"
    ),
    heights=lambda x, y: 80e-9 * np.cos(8 * x / HALF) * np.cos(8 * y / HALF),
    least_film=1e-9,
    boundary_friction=0.12,
)


@pytest.fixture(scope="module")
def film():
    found = CASE.on((64, 64))
    assert found.status == "converged"
    assert 0.02 < found.contact_share < 0.98
    return found


def bars_beside(film, monkeypatch, **changes):
    """With a film on half as many cells that differs in these figures alone."""
    monkeypatch.setattr(RoughPointCase, "on", lambda case, cells: replace(film, **changes))
    return rough_point_bars(CASE, film, AREA).values


def test_shares_have_what_the_film_above_the_least_one_may_move_them_by(film, monkeypatch):
    share, over = film.contact_share, film.mean_thickness - CASE.least_film
    bars = bars_beside(film, monkeypatch, mean_thickness=film.mean_thickness + 0.1 * over)
    assert bars["mean_thickness"] == pytest.approx(0.1 * RULES["mean_thickness"].factor * over, rel=1e-6, abs=0)
    wanted = STEEP * share * (1 - share) * 0.1 * RULES["mean_thickness"].factor
    assert bars["contact_load_share"] == pytest.approx(wanted, rel=1e-6)
    # rubbed by the share alone, at least
    assert bars["traction_coefficient"] >= 0.12 * bars["contact_load_share"] * (1 - 1e-9)
    assert bars["friction_power"] >= 1e-3 * film.load * 0.12 * bars["contact_load_share"] * (1 - 1e-9)


def test_areas_have_what_whole_cells_scatter(film, monkeypatch):
    bars = bars_beside(film, monkeypatch)
    cell = (film.x[1] - film.x[0]) * (film.y[1] - film.y[0])
    touching = int(film.touching.sum())
    # some cells of every spot lie at its edge, and no more than there are
    assert 0.6 * cell / AREA < bars["contact_area_share"] < 0.6 * np.sqrt(touching) * cell / AREA * (1 + 1e-9)


def test_a_least_film_is_met_only_where_contact_is_sure(film, monkeypatch):
    thinner = 0.9 * film.mean_thickness
    sure = bars_beside(film, monkeypatch, mean_thickness=0.9999 * film.mean_thickness)
    assert sure["minimum_thickness"] < 1e-6 * CASE.least_film
    barely = replace(film, contact_share=1e-4)
    bars = bars_beside(barely, monkeypatch, mean_thickness=thinner, contact_share=2e-4)
    assert bars["minimum_thickness"] == pytest.approx(bars["mean_thickness"], rel=1e-6, abs=0)
    assert bars["mean_thickness"] == pytest.approx(
        RULES["mean_thickness"].factor * 0.1 * film.mean_thickness, rel=1e-6, abs=0
    )


def test_contact_in_constrictions_narrower_than_a_cell_is_said():
    """Bumps that touch at the rim alone."""
    heights = lambda x, y: 100e-9 * np.cos(8.5 * x / HALF) * np.cos(8.5 * y / HALF)  # noqa: E731
    case = replace(CASE, speeds=((0.0, 0.0), (0.03, 0.0)), heights=heights, least_film=4.3e-9)
    coarse, fine = case.on((48, 48)), case.on((128, 128))
    assert 0 < fine.contact_share < 0.7 * coarse.contact_share < SMALL
    (note,) = narrow_notes(case, coarse)
    assert (note.code, note.values.get("reason")) == ("film-cells-few", "rim")
    assert at_rim(case, coarse) > 0.7
    # on as many cells as it says the opening has one of them, and a fortieth fewer do not
    wanted = (int(n) for n in note.values["wanted"].split(" x "))
    for n, at, width in zip(wanted, (coarse.x, coarse.y), opening(case, coarse.mean_thickness), strict=True):
        assert 1 <= width / ((at[1] - at[0]) * 48 / n) < 1 + 1 / 40
    assert narrow_notes(case, fine) == []
    # a film that was not found has no share to speak of
    assert narrow_notes(case, replace(coarse, status=Status.STALLED)) == []
    # nothing touches, or nearly all
    assert narrow_notes(case, replace(coarse, contact_share=0.0)) == []
    assert narrow_notes(case, replace(coarse, contact_share=0.9)) == []


def test_only_the_axis_with_wide_cells_takes_more():
    heights = lambda x, y: 100e-9 * np.cos(8.5 * x / HALF) * np.cos(8.5 * y / HALF)  # noqa: E731
    case = replace(CASE, speeds=((0.0, 0.0), (0.03, 0.0)), heights=heights, least_film=4.3e-9)
    film = case.on((48, 160))
    (note,) = narrow_notes(case, film)
    assert re.fullmatch(r"\d+ x 160", note.values["wanted"])


def test_contact_on_a_summit_inside_is_not_said_to_be_at_the_rim(film):
    """The same share of the load on one cell in the middle: no finer cells were shown to lower it."""
    small = replace(film, contact_share=0.5 * SMALL)
    narrow = replace(CASE, radii=(RADIUS / 4, RADIUS / 4))  # its opening has less than a cell
    summit = np.zeros_like(film.pressure)
    summit[np.abs(film.x).argmin(), np.abs(film.y).argmin()] = 1e9
    inside = replace(small, pressure=film.oil_pressure + summit)
    assert at_rim(narrow, inside) == 0
    assert narrow_notes(narrow, inside) == []
    outside = replace(small, pressure=film.oil_pressure + np.roll(summit, 28, axis=0))
    assert at_rim(narrow, outside) == 1
    assert len(narrow_notes(narrow, outside)) == 1


def test_the_gap_opens_to_a_film_as_its_power_two_thirds():
    (thin, same), (thick, _) = (opening(CASE, film) for film in (1e-10, 8e-10))
    assert same == pytest.approx(thin, rel=1e-9)
    # the gap beside a ball goes as the distance to 3/2, next to its edge
    assert thick / thin == pytest.approx(4, rel=0.02)
    gap = 8 * np.sqrt(2) / (3 * np.pi) * (HALF**2 / RADIUS) * (thin / HALF) ** 1.5
    assert gap == pytest.approx(1e-10, rel=0.02)
