"""The section on rough balls from full film to contact: what it says of rows, and the stored ones."""

import copy

import pytest

from reports import touching_films as section
from reports.experiments import kept, touching_cells, touching_films


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
    assert [one["surface"] for one in cases] == [surface.name for surface in touching_films.SURFACES]
    assert all(len(one["rows"]) == len(touching_films.LAMBDAS) for one in cases)
    assert "data:image/png" in body
    assert "Only" not in body
    for row in (row for one in cases for row in one["rows"]):
        film = row["film"]
        if film["status"] == "converged":
            assert film["residual"] <= 1e-8
            assert 0 <= film["contact_load_share"] <= 1
            # never below the least film of 1 nm, and there where surfaces touch
            assert film["minimum_thickness"] > 0.999e-9
            assert (film["contact_load_share"] > 0) == (film["minimum_thickness"] < 1.001e-9)
    fewer = copy.deepcopy(stored)
    fewer["cases"] = cases[:1]
    found = kept.found
    monkeypatch.setattr(section, "found", lambda name: fewer if name == section.NAME else found(name))
    assert f"Only {len(cases[0]['rows'])} of {stored['asked']} films" in section.body()


def test_stored_shares_settle_once_the_constrictions_have_a_cell_and_bars_cover_what_is_left():
    films = kept.found("touching_cells")["films"]
    assert [film["speed"] for film in films] == [speed for speed, _ in touching_cells.FILMS]
    for film in films:
        rows = film["rows"]
        assert [row["cells"] for row in rows] == list(touching_cells.CELLS)
        shares = [row["share"] for row in rows]
        assert all(row["status"] == "converged" for row in rows)
        if shares[-1] == 0:
            # where nothing touches, the minimum is thinner on coarse cells and the mean thicker
            minima, means = ([row[name] for row in rows] for name in ("minimum", "mean"))
            assert minima[0] < minima[1] < 0.9 * minima[-1]
            assert means[0] > means[1] > means[2] > means[3]
            continue
        changes = [shares[k] - shares[k + 1] for k in range(3)]
        # at least of first order, so that what is left is no more than the last change
        assert changes[0] > 2 * changes[1] > 4 * changes[2] > 0
        limit = shares[-1] - changes[2]
        for row in rows:
            assert row["at_rim"] > 0.7
            assert row["cells_wide"] < 3.5
            if row["share_bar"] is not None:
                assert row["share_bar"] > row["share"] - limit
            if row["opening"] < 0.4:
                assert row["share"] > 2 * shares[-1]
            if row["opening"] > 1:
                assert row["share"] < 1.5 * shares[-1]
