"""A cell of the roughness that repeats under a cylinder: against Hertz, a patch that holds it, and the ends."""

import numpy as np
import pytest

from bem import Body, Grid, Layer, Lubricant, Material, generate_surface, solve_mixed
from bem.accuracy import MixedCase, mixed_bars, solve_coarser_mixed
from bem.accuracy.mixed import mixed_figures
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.friction.models import films_of, rough_contact
from bem.friction.result_notes import coating_notes
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.materials import contact_modulus
from bem.notes import Level
from bem.surfaces.waves import on_cells

STEEL = Body(Material(name="steel", youngs_modulus=207e9, poissons_ratio=0.3))
WAVE, A_WAVE = 20e-6, 16
CELL = Grid((A_WAVE, A_WAVE), (WAVE / A_WAVE, WAVE / A_WAVE), periodic=(True, True))
LONG = 33
PATCH = Grid((LONG * A_WAVE, A_WAVE), CELL.spacing, periodic=(False, True))
"""As long as the grid of the film over cells: both means of the oil follow the length of the patch a little."""
LINE = {
    "bodies": (STEEL, STEEL),
    "radius": 0.02,
    "width": 0.01,
    "load": 540.0,
    "lubricant": Lubricant(0.05, pressure_viscosity=15e-9),
    "boundary_friction": 0.12,
    "film_points": 400,
}
"""Half-width 110 um: five and a half waves."""
SPEEDS = (0.1, 0.0)


def waves(grid, amplitude=60e-9):
    x, y = (2 * np.pi * axis / WAVE for axis in (grid.x, grid.y))
    return amplitude * np.cos(x)[:, None] * np.cos(y)[None, :]


@pytest.fixture(scope="module")
def both():
    """Set-up and rough contact of the cell and of the patch, and a film on each."""
    found = []
    for grid in (CELL, PATCH):
        setup = MixedSetup(grid=grid, **LINE)
        found.append((setup, rough_contact(setup, waves(grid), SPEEDS), films_of(setup, SPEEDS).under(400.0, 0, None)))
    return found


@pytest.mark.internal
def test_hertz_pressure_flattens_the_grid_of_the_film():
    setup = MixedSetup(grid=CELL, **LINE)
    grid, a = setup.film_grid, setup.smooth.half_width(540.0)
    assert a == pytest.approx(110e-6, rel=0.01)
    assert setup.slices == pytest.approx(2 * a * 0.01 / WAVE**2, rel=1e-12)
    hertz = 2 * 540.0 / 0.01 / (np.pi * a) * np.sqrt(np.maximum(1 - (grid.x / a) ** 2, 0))[:, None]
    gap = displacement_operator(grid, setup.bodies)(hertz)[:, 0] + grid.x**2 / (2 * 0.02)
    assert np.ptp(gap[np.abs(grid.x) < 0.9 * a]) < 5e-4 * a**2 / 0.04  # 128 cells across, ends of the ellipse sampled


@pytest.mark.internal
def test_cells_are_pressed_as_a_patch_that_holds_the_contact(both):
    """The same load, film and waves; what is left is that of sixteen cells a wave and of the contact's edge."""
    (_, cells, film), (_, patch, same) = both
    one, other = cells.at_load(film, 140.0, 1e-6, None), patch.at_load(same, 140.0, 1e-6, None)
    assert one.status is other.status is Status.CONVERGED
    assert one.load == pytest.approx(140.0, rel=1e-9)
    assert one.pressure.sum() * cells.setup.film_grid.cell_area == pytest.approx(140.0, rel=1e-9)
    assert one.opening == pytest.approx(other.opening, rel=0.01)
    assert one.area == pytest.approx(other.area, rel=0.05)
    means = other.pressure.reshape(LONG, A_WAVE, A_WAVE).mean(axis=(1, 2))
    centres = PATCH.x.reshape(LONG, A_WAVE).mean(axis=1)
    inside = np.abs(centres) < 0.7 * 110e-6
    expected = np.interp(centres, cells.setup.film_grid.x, one.pressure[:, 0])
    np.testing.assert_allclose(expected[inside], means[inside], rtol=0.02)


@pytest.mark.internal
def test_load_sharing_is_that_of_the_patch():
    """Random heights of another draw on the patch, eight correlation lengths to the half-width."""
    shares, friction = [], []
    cell = Grid((120, 120), (2.2e-6, 2.2e-6), periodic=(True, True))
    whole = Grid((160, 120), (2.2e-6, 2.2e-6), periodic=(True, True))
    patch = Grid(whole.shape, whole.spacing, periodic=(False, True))
    for grid, drawn, seed in ((cell, cell, 1), (patch, whole, 2)):
        heights = generate_surface(drawn, rms_height=0.1e-6, correlation_length=13.2e-6, seed=seed)
        found = solve_setup(MixedSetup(grid=grid, **LINE), heights, SPEEDS)
        assert found.status is Status.CONVERGED
        shares.append(found.contact_load / found.load)
        friction.append(found.friction)
    assert 0.3 < shares[0] < 0.7
    assert shares[0] == pytest.approx(shares[1], abs=0.03)
    assert friction[0] == pytest.approx(friction[1], rel=0.05)


def test_ends_of_the_curve_are_boundary_friction_and_a_full_film():
    heights = waves(CELL, 200e-9)
    slow = solve_mixed(**LINE, grid=CELL, height=heights, speeds=(1e-6, 0.0))
    fast = solve_mixed(**LINE, grid=CELL, height=heights, speeds=(20.0, 0.0))
    assert slow.status is fast.status is Status.CONVERGED
    assert slow.friction == pytest.approx(0.12, rel=1e-3)
    assert slow.contact_load == pytest.approx(540.0, rel=1e-3)
    assert fast.full_film
    assert fast.contact_load == 0
    assert fast.separation.shape == fast.film_along_x[0].shape == (A_WAVE,)


@pytest.mark.internal
def test_speeds_share_the_law_of_the_cell(monkeypatch):
    from bem.friction import homogenised_contact

    solved = []
    original = homogenised_contact.solve_contact
    monkeypatch.setattr(
        homogenised_contact, "solve_contact", lambda *args, **kwargs: solved.append(1) or original(*args, **kwargs)
    )
    setup = MixedSetup(grid=CELL, **LINE)
    first = solve_setup(setup, waves(CELL), SPEEDS)
    second = solve_setup(setup, waves(CELL), (0.05, 0.0), first)
    assert len(solved) == homogenised_contact.STEPS
    assert second.contact_load > first.contact_load
    solve_setup(setup, waves(CELL, 50e-9), (0.05, 0.0), first)
    assert len(solved) == 2 * homogenised_contact.STEPS


@pytest.mark.internal
def test_long_waves_are_said():
    long = Grid((16, 16), (10e-6, 10e-6), periodic=(True, True))
    heights = 60e-9 * np.cos(2 * np.pi * long.x / 160e-6)[:, None] * np.ones((1, 16))
    found = solve_setup(MixedSetup(grid=long, **LINE), heights, SPEEDS)
    (said,) = (note for note in found.notes if note.code == "repeated-patch")
    assert said.values["reason"] == "waves"
    width = 2 * min(MixedSetup(grid=long, **LINE).smooth.half_axes(LINE["load"]))
    assert said.values["side"] == pytest.approx(2 * width, rel=1e-12, abs=0)  # Hertz' width, not that of the cylinder
    with pytest.raises(InputError, match="uncoupled asperities need a patch that holds the contact"):
        MixedSetup(**{**LINE, "grid": CELL, "contact_model": "uncoupled"})
    with pytest.raises(InputError, match='make it "loaded"'):
        MixedSetup(**{**LINE, "grid": CELL, "oil_volume": "patch"})


@pytest.mark.internal
def test_an_area_that_the_cells_do_not_resolve_is_said_as_of_a_patch():
    """Repeated patches said 4.7 ± 2.5 % of contact without the caution of a patch that holds the contact."""
    grid = Grid((64, 64), (1e-6, 1e-6), periodic=(True, True))
    for rms, said in ((100e-9, True), (5e-9, False)):
        height = generate_surface(grid, rms_height=rms, seed=2, correlation_length=1.6e-6)
        setup = MixedSetup(**{**LINE, "grid": grid, "hardness": 3e9})
        contact = rough_contact(setup, height, SPEEDS)
        pressed = contact.at_load(films_of(setup, SPEEDS).under(1.0, 0, None), 539.0, 1e-5, None)
        assert [note.values["reason"] for note in pressed.notes if note.code == "contact-unresolved"] == [
            "spots"
        ] * said


@pytest.mark.internal
def test_error_bars_cover_the_finer_patch():
    """36 cases of steel and PEEK, with and without hardness, had at most 0.54 of their bars."""
    side, found = 128e-6, []
    drawn = generate_surface(
        Grid((32, 32), (side / 32, side / 32), periodic=(True, True)),
        rms_height=0.1e-6,
        correlation_length=16e-6,
        seed=1,
    )
    for cells in (32, 96):
        grid = Grid((cells, cells), (side / cells, side / cells), periodic=(True, True))
        setup, heights = MixedSetup(grid=grid, **LINE), on_cells(drawn, grid.shape)
        found.append(MixedCase(setup, heights, solve_setup(setup, heights, SPEEDS)))
    bars = mixed_bars(found[0], solve_coarser_mixed(found[0])).values
    coarse, fine = (mixed_figures(case.solution) for case in found)
    assert 0.1 < coarse["contact_load"] / 540 < 0.9
    for name, bar in bars.items():
        assert bar is not None
        assert abs(coarse[name] - fine[name]) <= bar
    assert 0 < bars["friction"] < 0.05 * coarse["friction"]


@pytest.mark.internal
def test_a_soft_layer_thicker_than_the_contact_is_outside_the_film_s_model():
    soft = Material(name="polymer", youngs_modulus=3.7e9, poissons_ratio=0.4)

    def notes(thickness, material=soft, grid=CELL):
        coated = Body(STEEL.material, layer=Layer(material, thickness))
        return coating_notes(MixedSetup(**{**LINE, "grid": grid, "bodies": (STEEL, coated)}))

    (note,) = notes(100e-6)
    assert note.level is Level.OUTSIDE_MODEL
    assert note.values["stiffer"] == pytest.approx(227.5 / 4.405, rel=1e-3)
    (thick,) = notes(20e-3)  # where the contact is as wide as on the layer's material, and 0.04 radii: 4 % too stiff
    assert thick.values["modulus"] == pytest.approx(contact_modulus(STEEL.material, soft), rel=0.05)
    assert note.values["modulus"] > 1.5 * thick.values["modulus"]
    assert "Set sharing.film_modulus" in note
    (held,) = notes(100e-6, grid=PATCH)
    assert "leave out [grid]" in held
    for thin in (notes(20e-6), notes(100e-6, STEEL.material)):
        assert [note.level for note in thin] == [Level.INFO]
