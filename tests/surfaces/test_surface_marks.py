"""Marks of a tool: each statistic against its closed form, the same surface on every grid, mistakes in words."""

import math

import numpy as np
import pytest

from bem import Grid, InputError, describe_surface, load_scene, plan_scene, run_scene
from bem.scenes.build import heights_of, marks_of
from bem.scenes.checks.facts import examine
from bem.surfaces import PROCESSES, cross_hatch, feed_marks, generate_surface, hatch_angle

FEED, NOSE = 1e-4, 8e-4
PERIODIC = (True, True)
HATCH = {"angle": math.radians(60), "spacing": 1e-4, "width": 1.2e-5, "depth": 1.6e-6}


def strip(cells=4000, feeds=5, periodic=(True, True)):
    return Grid((cells, 3), (feeds * FEED / cells, 1e-6), periodic=periodic)


@pytest.mark.parametrize("lay", ["x", "y"])
def test_cusps_have_their_moments_and_autocorrelation(lay):
    """Fourier coefficients of t^2 go with 1 / n^2, so the autocorrelation is Bernoulli's polynomial of order 4."""
    grid = strip()
    if lay == "x":
        grid = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=PERIODIC)
    z = feed_marks(grid, feed=FEED, nose_radius=NOSE, seed=3, lay=lay)
    assert z.shape == grid.shape
    along = z if lay == "y" else z.T
    assert (along == along[:, :1]).all()
    line = along[:, 0]
    height = FEED**2 / (8 * NOSE)
    # 800 cells a feed: sums for integrals of a parabola, 1e-6 of them; the peak lies up to half a cell beside a middle
    assert np.ptp(line) == pytest.approx(height, rel=3e-3)
    rms = np.sqrt(np.mean(line**2))
    assert rms == pytest.approx(FEED**2 / (12 * math.sqrt(5) * NOSE), rel=1e-5)
    assert np.mean(line**3) / rms**3 == pytest.approx(2 * math.sqrt(5) / 7, rel=1e-4)
    assert np.mean(line**4) / rms**4 == pytest.approx(15 / 7, rel=1e-4)
    lag = np.arange(0, 800, 50)
    found = [np.mean(line * np.roll(line, shift)) / rms**2 for shift in lag]
    t = lag / 800
    np.testing.assert_allclose(found, 1 - 30 * t**2 * (1 - t) ** 2, atol=1e-4)


@pytest.mark.parametrize("periodic", [PERIODIC, (False, False)])
def test_marks_are_the_same_on_every_grid(periodic):
    """Middles of 3 k cells of a side fall on every third of k's, so both grids see the same places."""
    for marks, keys in (
        (feed_marks, {"feed": FEED, "nose_radius": NOSE}),
        (cross_hatch, HATCH | {"angle": math.pi / 2}),
    ):
        coarse, fine = (
            marks(Grid((n, n), (5e-4 / n, 5e-4 / n), periodic=periodic), seed=7, **keys) for n in (180, 540)
        )
        np.testing.assert_allclose(fine[1::3, 1::3], coarse, rtol=0, atol=1e-9 * np.ptp(coarse))


@pytest.mark.parametrize("lay", ["x", "y"])
@pytest.mark.parametrize("repeats", [False, True])
def test_grooves_run_in_two_directions(lay, repeats):
    """Cells a step along a groove apart are equally far across it: what is deep is so in one of two directions."""
    half = HATCH["angle"] / 2
    # one step along x and one along y are a step along a groove: cells of that ratio
    dx, dy = (1.6e-6, 1.6e-6 / math.tan(half)) if lay == "y" else (2e-6, 2e-6 * math.tan(half))
    grid = Grid((300, 300), (dx, dy), periodic=PERIODIC if repeats else (False, False))
    z = cross_hatch(grid, seed=4, lay=lay, **HATCH)
    assert hatch_angle(grid, HATCH["angle"], HATCH["spacing"], lay) == pytest.approx(HATCH["angle"], rel=1e-12)
    # deeper than half: nothing but its own groove and crossing ones is there, and its line goes on one way or the other
    deep = z < -0.5 * HATCH["depth"]
    assert deep.mean() > 0.02
    inner = slice(1, -1), slice(1, -1)
    ways = [np.minimum(np.roll(deep, (1, s), (0, 1)), np.roll(deep, (-1, -s), (0, 1)))[inner] for s in (1, -1)]
    assert (ways[0] | ways[1])[deep[inner]].all()
    for way in ways:
        assert (way & deep[inner]).sum() > 0.3 * deep[inner].sum()
    if repeats:  # nothing happens where the ends meet
        shifted = np.roll(deep, 150, axis=0)
        joined = [np.minimum(np.roll(shifted, (1, s), (0, 1)), np.roll(shifted, (-1, -s), (0, 1))) for s in (1, -1)]
        assert (joined[0] | joined[1])[shifted][:, None].all()


def test_grooves_leave_the_plateau_that_chance_leaves():
    """Each of N places of a direction covers w / D of it: (1 - w / D)^2N lies between, and the share below a depth is
    that of narrower grooves; both within the scatter of forty surfaces."""
    grid = Grid((200, 200), (2e-6, 2e-6), periodic=PERIODIC)
    keys = HATCH | {"angle": math.pi / 2}
    drawn = [cross_hatch(grid, seed=seed, **keys) for seed in range(40)]
    period = 4e-4 / math.sqrt(2)
    count = round(period / HATCH["spacing"])
    for depth in (0.0, 0.3, 0.8):
        width = HATCH["width"] * math.sqrt(1 - depth)
        covered = 1 - (1 - width / period) ** (2 * count)
        found = [np.mean(z < -depth * HATCH["depth"]) for z in drawn]
        # four standard errors of the mean: chance leaves them in one of 16,000
        assert np.mean(found) == pytest.approx(covered, abs=4 * np.std(found) / math.sqrt(len(found)))
    assert min(z.min() for z in drawn) == pytest.approx(-HATCH["depth"], rel=0.03)  # half a cell beside the middle


def test_a_groove_is_a_parabola_as_deep_as_it_is():
    """One direction alone, by its section: a grid so short that one groove of each is on it."""
    grid = Grid((400, 400), (5e-7, 5e-7), periodic=PERIODIC)
    z = cross_hatch(grid, seed=1, angle=math.pi / 2, spacing=1.3e-4, width=2e-5, depth=1e-6)
    z = np.minimum(z, 0)
    x = grid.x
    # along x a groove of 45 deg is sqrt(2) times as wide: its area in a row is 2/3 of depth by that, of two apart
    rows = [row for row in z if np.count_nonzero(np.diff(np.sign(row))) == 4]
    assert rows
    for row in rows[:10]:
        assert -row.sum() * (x[1] - x[0]) == pytest.approx(2 * 2 / 3 * 1e-6 * 2e-5 * math.sqrt(2), rel=1e-3, abs=0)


@pytest.mark.parametrize(
    ("marks", "change", "message"),
    [
        (feed_marks, {"feed": 1e-3}, "0 < feed <= nose_radius"),
        (feed_marks, {"feed": 5e-6}, "shorter than 4 cells"),
        (feed_marks, {"feed": 1.3e-4}, "is 3.846 feeds; take 390 um or 520 um, or a feed of 166.67 um"),
        (feed_marks, {"feed": 6e-4}, "is 0.8333 feeds; take 600 um, or a feed of 500 um"),
        (cross_hatch, {"angle": 4.0}, "between 0 and pi"),
        (cross_hatch, {"width": 2e-4}, "no groove wider"),
        (cross_hatch, {"depth": -1e-6}, "positive"),
        (cross_hatch, {"width": 5e-6}, "less than 4 cells"),
        (cross_hatch, {"angle": math.radians(45)}, "53.13 deg is the nearest that does; 500 um and 1.207 mm do"),
    ],
)
def test_mistakes_are_said(marks, change, message):
    grid = Grid((250, 250), (2e-6, 2e-6), periodic=PERIODIC)
    keys = {"feed": FEED, "nose_radius": NOSE} if marks is feed_marks else HATCH
    with pytest.raises(InputError, match=message):
        marks(grid, seed=1, **(keys | change))


def test_what_the_message_says_does():
    """Lengths that a message offers are those of a grid that takes the marks."""
    for lay in ("x", "y"):
        lengths = (5e-4, 1.2071e-3) if lay == "y" else (1.2071e-3, 5e-4)
        grid = Grid((300, 300), (lengths[0] / 300, lengths[1] / 300), periodic=PERIODIC)
        keys = HATCH | {"angle": math.radians(45), "width": 2e-5}
        assert cross_hatch(grid, seed=1, lay=lay, **keys).min() < 0
        # the offered length is rounded to four digits
        assert hatch_angle(grid, keys["angle"], keys["spacing"], lay) == pytest.approx(keys["angle"], rel=1e-3)


def test_no_grid_of_one_row_has_two_directions():
    with pytest.raises(InputError, match="no room"):
        cross_hatch(Grid((200, 1), (2e-6, 2e-6)), seed=1, **HATCH)


SCENE = {
    "kind": "contact",
    "grid": {"shape": 128, "lengths": ["500 um", "500 um"], "periodic": True},
    "lower": {"material": "steel-52100", "surface": {"process": "turned", "feed_marks": {}}},
    "contact": {"mean_pressure": "50 MPa"},
    "outputs": {"errors": False},
}


def scene_of(**surface):
    return load_scene({**SCENE, "lower": {"material": "steel-52100", "surface": surface}})


@pytest.mark.internal
def test_a_turned_surface_is_its_cusps_and_what_lies_between():
    turned = PROCESSES["turned"]
    surface = scene_of(process="turned", feed_marks={}).lower.surface
    grid = Grid((256, 256), (5e-4 / 256, 5e-4 / 256), periodic=PERIODIC)
    drawn = heights_of(surface, grid, 3)
    between = generate_surface(grid, seed=3, **turned.between_marks().statistics())
    cusps = feed_marks(grid, seed=3, **turned.feed_marks)
    np.testing.assert_allclose(drawn, between + cusps - cusps.mean(), atol=1e-6 * np.std(drawn))
    assert abs(drawn.mean()) < 1e-12 * np.std(drawn)
    # waves that know nothing of the cusps: squares add, but for what few of them have in common by chance
    found = describe_surface(drawn, grid.spacing, periodic=(True, True))
    assert found.Sq == pytest.approx(math.hypot(between.std(), cusps.std()), rel=0.05)
    assert found.Sq == pytest.approx(turned.rms_height, rel=0.06)  # that of the cusps themselves


@pytest.mark.internal
def test_a_honed_surface_is_near_its_catalogue():
    surface = scene_of(process="honed", cross_hatch={"angle": "90 deg"}).lower.surface
    grid = Grid((512, 512), (2e-6, 2e-6), periodic=PERIODIC)
    found = describe_surface(heights_of(surface, grid, 1), grid.spacing, periodic=(True, True))
    honed = PROCESSES["honed"]
    assert found.Sq == pytest.approx(honed.rms_height, rel=0.2)
    assert found.Ssk < honed.skewness
    assert "The scene itself gives cross_hatch.angle" in surface.source


@pytest.mark.internal
def test_a_resolved_scene_says_its_marks():
    surface = scene_of(process="turned", feed_marks={"feed": "125 um"}, lay="x").lower.surface
    assert (surface.feed_marks.feed, surface.feed_marks.nose_radius) == (125e-6, 8e-4)
    assert (surface.skewness, surface.kurtosis, surface.elongation) == (0.0, 3.0, pytest.approx(10.0))
    again = scene_of(**surface.model_dump(exclude_none=True)).lower.surface
    assert again == surface
    marks = marks_of(surface, Grid((125, 125), (4e-6, 4e-6), periodic=PERIODIC), 1)
    assert (marks == marks[:1]).all()


@pytest.mark.parametrize(
    ("surface", "message"),
    [
        ({"process": "ground", "feed_marks": {}}, "feed_marks of a surface that is ground.*process turned, or none"),
        ({"process": "turned", "feed_marks": {"feed": "1 mm"}}, "feed is longer than nose_radius"),
        ({"process": "turned", "feed_marks": {"fed": "1 mm"}}, 'did you mean "feed"'),
        ({"process": "honed", "cross_hatch": {"width": "1 mm"}}, "wider than their spacing"),
        (
            {"kind": "generated", "rms_height": "9 nm", "correlation_length": "9 um", "feed_marks": {"feed": "1 mm"}},
            "nose_radius",
        ),
    ],
)  # fmt: skip
def test_mistakes_in_scenes_are_said(surface, message):
    with pytest.raises(InputError, match=message):
        scene_of(**surface)


def test_both_marks_are_one_too_many():
    marks = {
        "feed_marks": {"feed": "0.1 mm", "nose_radius": "1 mm"},
        "cross_hatch": {"angle": "1 rad", "spacing": "20 um", "width": "20 um", "depth": "1 um"},
    }
    with pytest.raises(InputError, match="both given"):
        scene_of(kind="generated", rms_height="9 nm", correlation_length="9 um", **marks)


@pytest.mark.internal
def test_a_large_grid_is_described_by_a_part_of_it_that_holds_no_whole_feeds():
    """Twenty-five feeds on the grid, twelve and a half on the quarter that a plan looks at."""
    surface = {"kind": "generated", "rms_height": "100 nm", "hurst": 0.8, "rolloff_wavelength": "20 um"}
    surface |= {"cutoff_wavelength": "4 um", "feed_marks": {"feed": "40 um", "nose_radius": "0.8 mm"}}
    grid = {"shape": 1024, "lengths": ["1 mm", "1 mm"], "periodic": True}
    scene = load_scene({**SCENE, "grid": grid, "lower": {"material": "steel-52100", "surface": surface}})
    assert plan_scene(scene)
    ((_, found),) = examine(scene).surfaces
    # waves and cusps know nothing of each other; a part of a surface has a few per cent more or less
    assert found.rms_height == pytest.approx(math.hypot(1e-7, (40e-6) ** 2 / (12 * math.sqrt(5) * 8e-4)), rel=0.05)


def test_a_scene_is_refused_before_any_work_and_runs_where_it_fits(tmp_path):
    with pytest.raises(InputError, match=r"lower\.surface\.feed_marks: the grid repeats"):
        plan_scene({**SCENE, "grid": {**SCENE["grid"], "lengths": ["430 um", "500 um"]}})
    done = run_scene({**SCENE, "name": "turned"}, tmp_path / "run", figures=False)
    assert done.summary["status"] == "converged"
    drawn = done.arrays["lower_height"].values
    peaks = drawn.mean(axis=1)
    assert (
        np.count_nonzero((peaks > np.roll(peaks, 1)) & (peaks > np.roll(peaks, -1)) & (peaks > 0.5 * peaks.max())) == 5
    )
