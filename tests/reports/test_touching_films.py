"""The section on rough balls from full film to contact: what it says of rows, and the stored ones."""

import copy

import pytest

from reports import touching_films as section
from reports.experiments import kept, touching_films


def case(*rows):
    """Of rows (ratio, share of load sharing, its friction, its film); films bear nothing, at 0.04 and 10 nm."""
    film = {"contact_load_share": 0.0, "traction_coefficient": 0.04, "mean_thickness": 1e-8, "minimum_thickness": 1e-9}
    bars = {
        "contact_load_share": 0.001,
        "traction_coefficient": 0.001,
        "mean_thickness": 1e-9,
        "minimum_thickness": None,
    }
    made = []
    for ratio, share, friction, thickness in rows:
        loaded = {"share": share, "friction": friction, "thickness": thickness, "with_oil_on_contact": friction}
        status = {"status": "converged"}
        made.append({"lambda": ratio, "film": film | status, "bars": bars, "loaded": loaded | status})
    return {"surface": "bumps", "rms": 5e-8, "shortest": 0.74, "rows": made}


def test_the_verdict_ends_above_the_first_row_that_is_off_by_more_than_the_films_bar():
    one = case((3.0, 0.0, 0.04, 1e-8), (1.0, 0.3, 0.04, 1.29e-8), (0.5, 0.0, 0.04, 1e-8))
    other = case((2.9, 0.0509, 0.0449, 1e-8), (1.1, 0.0, 0.04, 2e-8), (0.5, 0.0, 0.04, 1e-8))
    said = section.verdict([one, other])
    assert "bear down to a smooth film of 2.9 times" in said
    assert "of friction down to a smooth film of 0.5 times" in said
    assert "of the mean film down to a smooth film of 2.9 times" in said
    assert "30 % of the load, where they bear 0.00 (0 to 0.1) %" in said
    # bars of 0.001 of the load and of friction, and of a tenth of the film, are granted and no more
    assert section.verdict([case((2.0, 0.0511, 0.0491, 1.31e-8))]).count("nowhere") == 4
    stalled = case((1.0, 0.3, 0.04, 1e-8))
    stalled["rows"][0]["loaded"]["status"] = "stalled"
    assert "No film converged" in section.verdict([stalled])
    assert section.together([stalled]) == []


def test_rows_together_say_what_films_span():
    ((ratio, count, share, loaded, film, friction, _),) = section.together(
        [case((1.0, 0.2, 0.05, 2e-8)), case((1.1, 0.3, 0.02, 1e-8))]
    )
    assert (ratio, count, share) == ("1 to 1.1", "2", "0.00 (0 to 0.1) %")
    assert (loaded, film, friction) == ("0.2 to 0.3", "0.5 to 1", "0.5 to 1.2")


def test_orders_are_of_the_last_three_grids():
    rows = [{"share": value} for value in (0.085, 0.021, 0.005, 0.001)]
    assert "order 2.0" in section.orders(rows, "share")
    assert "no order" in section.orders(rows[:2], "share")
    assert "no order" in section.orders([{"share": value} for value in (0.1, 0.2, 0.1)], "share")


def test_surfaces_have_the_height_and_direction_they_are_named_for():
    import numpy as np

    x = np.linspace(-touching_films.HALF, touching_films.HALF, 129)
    inside = np.hypot(x[:, None], x) < touching_films.HALF
    steeper = {}
    for surface in touching_films.SURFACES:
        heights = surface.heights(*np.meshgrid(x, x, indexing="ij"))
        assert np.sqrt((heights[inside] ** 2).mean()) == pytest.approx(surface.rms, rel=1e-12)
        along, across = (float((np.diff(heights, axis=axis) ** 2).mean()) ** 0.5 for axis in (0, 1))
        steeper[surface.name] = along / across
    # a quarter of the slope along what is four times as long, and the other way round, to what 64 waves scatter
    assert steeper["along the flow"] == pytest.approx(0.25, rel=0.3)
    assert steeper["across the flow"] == pytest.approx(4, rel=0.3)


def test_stored_rows_are_shown(monkeypatch):
    stored = kept.found("touching_films")
    body = section.body()
    cases = stored["cases"]
    assert "data:image/png" in body
    assert "Only" not in body
    fewer = copy.deepcopy(stored)
    fewer["cases"] = cases[:1]
    found = kept.found
    monkeypatch.setattr(section, "found", lambda name: fewer if name == section.NAME else found(name))
    assert f"Only {len(cases[0]['rows'])} of {stored['asked']} films" in section.body()
