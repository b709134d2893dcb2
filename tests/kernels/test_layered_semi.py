"""Layered bodies on grids with one periodic axis: mode sums, image sums, datum, the interface."""

import numpy as np
import pytest
from coated_bodies import assert_identical_materials_add_nothing, assert_tractions_and_strains_pass, coated

from bem import Body, Grid
from bem.kernels.coefficients import STRESS_PARITY, stress_coefficients, surface_coefficients
from bem.kernels.layered import frequency_response, hankel, semi_periodic
from bem.kernels.layered.cells import stress_remainder as free_stress
from bem.kernels.layered.semi_periodic import stress_remainder, surface_remainder
from bem.kernels.loads import Load

pytestmark = pytest.mark.internal

AXES = [(False, True), (True, False)]


def mode_sum(grid, body, depth, load, offsets):
    """Every wavenumber along the period, each integrated along the free axis: (components, offsets).

    What the layer adds; below it the whole. Uses neither the split nor a table. Of a displacement under pressure: the
    difference from the first offset.
    """
    tangential = load is Load.TANGENTIAL
    along = 0 if grid.periodic[0] else 1
    inside = depth is None or depth <= body.layer.thickness
    decay = 2 * body.layer.thickness - (depth or 0.0) if inside else depth
    period = grid.lengths[along]
    modes = 2 * np.pi / period * np.arange(int(40 * period / (2 * np.pi * decay)) + 1)
    reach = max(abs(o[1 - along]) for o in offsets) * grid.spacing[1 - along] + max(grid.spacing)
    edges = np.union1d(hankel.graded(1e-4 / decay, 1 / decay), np.linspace(0, 40 / decay, 24 + int(9 * reach / decay)))
    k, weights = hankel.gauss_rule(edges)
    kx, ky = (k[:, None], modes[None]) if along == 1 else (modes[None], k[:, None])
    kx, ky = np.broadcast_arrays(kx, ky)
    if depth is None:
        spectrum = frequency_response.surface_response(kx, ky, body, load, remainder=True)[None]
        parities = [(-1, 1) if tangential else (1, 1)]
    else:
        spectrum = frequency_response.stress_response(kx, ky, body, depth, load, remainder=inside)
        parities = STRESS_PARITY[load]
    measure = weights[:, None] * np.where(modes > 0, 2.0, 1.0) * grid.cell_area / (np.pi * period)
    measure = measure * np.sinc(kx * grid.spacing[0] / 2 / np.pi) * np.sinc(ky * grid.spacing[1] / 2 / np.pi)
    out = np.empty((len(parities), len(offsets)))

    def wave(i, j, parity):
        x, y = kx * i * grid.spacing[0], ky * j * grid.spacing[1]
        return (np.cos(x) if parity[0] > 0 else np.sin(x)) * (np.cos(y) if parity[1] > 0 else np.sin(y))

    first = wave(*offsets[0], (1, 1)) if depth is None and not tangential else 0.0
    for c, parity in enumerate(parities):
        sign = 1.0 if parity == (1, 1) else -1.0
        for n, (i, j) in enumerate(offsets):
            out[c, n] = sign * np.sum(spectrum[c] * measure * (wave(i, j, parity) - first))
    return out


@pytest.mark.parametrize("periodic", AXES)
@pytest.mark.parametrize(
    ("ratio", "nu1", "nu2", "thickness"),
    [
        (0.01, 0.45, 0.2, 0.7),
        pytest.param(0.01, 0.45, 0.2, 20.0, marks=pytest.mark.slow),
        pytest.param(100.0, 0.2, 0.3, 0.7, marks=pytest.mark.slow),
        (100.0, 0.2, 0.3, 20.0),
    ],
)
@pytest.mark.parametrize("load", list(Load))
def test_mode_sums(periodic, ratio, nu1, nu2, thickness, load):
    grid = Grid((7, 6), (1.0, 1.3), periodic=periodic)
    body = coated(ratio, nu1, nu2, thickness)
    offsets = [(0, 0), (1, 0), (2, 2), (5, 3), (6, 5)]
    at = tuple(np.array(offsets).T)
    surface = surface_remainder(grid, body, load)
    values = surface[at] - (surface[0, 0] if load is Load.NORMAL else 0.0)
    # 1e-12 of the largest: round-off of oscillating sums, the split is cut at 1e-16; measured 2e-13
    largest = np.abs(surface_coefficients(grid, body, load)).max()
    assert values == pytest.approx(mode_sum(grid, body, None, load, offsets)[0], abs=1e-12 * largest)
    for depth in (0.0, 0.6 * thickness, 1.5 * thickness):
        stress = stress_remainder(grid, body, depth, load)
        expected = mode_sum(grid, body, depth, load, offsets)
        assert stress[(slice(None), *at)] == pytest.approx(expected, abs=1e-12 * np.abs(stress).max())


@pytest.mark.parametrize("periodic", AXES)
@pytest.mark.parametrize("load", list(Load))
def test_images_of_a_thin_layer(periodic, load):
    """Layer a tenth of a cell: free coefficients summed over images, for the components whose tails fall off fast."""
    along = 1 if periodic[1] else 0
    images, cells = 60, 6
    grid = Grid((cells, cells), (1.0, 1.0), periodic=periodic)
    body = coated(10.0, 0.2, 0.4, 0.1)
    shape = [cells, cells]
    shape[along] = cells * (images + 1) + 1
    for depth in (0.05, 0.3):
        free = np.moveaxis(free_stress(Grid(tuple(shape), (1.0, 1.0)), body, depth, load), 1 + along, 1)
        stress = np.moveaxis(stress_remainder(grid, body, depth, load), 1 + along, 1)
        for component in (2, 3, 4) if load is Load.NORMAL else (2,):
            parity = STRESS_PARITY[load][component][along]
            for j in range(cells // 2 + 1):
                images_sum = free[component, j::cells][:images].sum(axis=0)
                images_sum = images_sum + parity * free[component, cells - j :: cells][:images].sum(axis=0)
                # what falls off like z / r^5 or faster leaves 1e-10 beyond 360 cells
                assert stress[component, j] == pytest.approx(images_sum, abs=1e-9 * np.abs(stress).max())


@pytest.mark.parametrize("periodic", AXES)
@pytest.mark.parametrize("load", list(Load))
@pytest.mark.parametrize("thickness", [0.02, 3.0, 300.0])
def test_tractions_and_strains_pass_the_interface(periodic, load, thickness):
    """Above: closed forms plus a remainder; below: one transform."""
    grid = Grid((30, 3) if periodic[1] else (3, 30), (1.0, 1.0), periodic=periodic)
    body = coated(8.0, 0.2, 0.42, thickness)
    assert_tractions_and_strains_pass(grid, body, load, of_strains=1e-12)


@pytest.mark.parametrize("periodic", AXES)
@pytest.mark.parametrize("load", list(Load))
def test_identical_materials_add_nothing(periodic, load):
    grid = Grid((12, 9), (1.0, 1.5), periodic=periodic)
    assert_identical_materials_add_nothing(grid, load, on_surface=1e-14, below=3e-13)


@pytest.mark.parametrize("periodic", AXES)
@pytest.mark.parametrize("load", list(Load))
def test_thin_and_thick_layers_keep_the_datum(periodic, load):
    """The numbers of the substrate for 1e-6 cells, of the layer for 1e6 domains, constant included."""
    grid = Grid((10, 8), (1.0, 1.0), periodic=periodic)
    # first order in h m / cell = 4e-5, and in (domain / h)
    for thickness, tolerance in ((1e-6, 1e-4), (1e7, 1e-4)):
        body = coated(40.0, 0.25, 0.4, thickness)
        bare = Body(body.material if thickness < 1 else body.layer.material)
        surface = surface_coefficients(grid, bare, load)
        assert surface_coefficients(grid, body, load) == pytest.approx(surface, abs=tolerance * np.abs(surface).max())


@pytest.mark.parametrize("load", list(Load))
def test_far_cells_are_line_loads(load, monkeypatch):
    """The hand-over at eight periods changes nothing; nor does where the spectrum is split."""
    grid = Grid((40, 3), (1.0, 1.0), periodic=(False, True))
    body = coated(30.0, 0.2, 0.4, 0.5)
    results = [surface_remainder(grid, body, load)[None], stress_remainder(grid, body, 0.2, load)]
    monkeypatch.setattr(semi_periodic, "_LINE_LOAD_DISTANCE", 100.0)
    monkeypatch.setattr(semi_periodic, "_SPLIT", 55.0)
    monkeypatch.setattr(semi_periodic, "_SPLIT_END", 55.0 + 48.0)
    for cached in (semi_periodic._bessel_panel, semi_periodic._cached_short_range_table):
        cached.cache_clear()
    for before, after in zip(
        results, [surface_remainder(grid, body, load)[None], stress_remainder(grid, body, 0.2, load)], strict=True
    ):
        assert before == pytest.approx(after, abs=3e-13 * np.abs(after).max())  # round-off
    for cached in (semi_periodic._bessel_panel, semi_periodic._cached_short_range_table):
        cached.cache_clear()


@pytest.mark.parametrize("periodic", AXES)
def test_one_cell_per_period_is_plane_strain(periodic):
    """A strip: 1/pi integral of the response cos(k x) sinc(k a), against the table of one cell per period."""
    shape = (6, 1) if periodic[1] else (1, 6)
    grid = Grid(shape, (1.0, 1.0), periodic=periodic)
    body = coated(7.0, 0.2, 0.4, 0.6)
    q, weights = hankel.gauss_rule(np.union1d(hankel.graded(1e-3, 1.0), np.arange(0, 60, 0.25)))
    free = 0 if periodic[1] else 1
    for depth in (0.9, 2.0):
        stress = stress_coefficients(grid, body, depth, Load.NORMAL).reshape(6, 6)
        kx, ky = (q, 0 * q) if free == 0 else (0 * q, q)
        spectrum = frequency_response.stress_response(kx, ky, body, depth, Load.NORMAL) * weights / np.pi
        spectrum *= np.sinc(q / (2 * np.pi))
        x = np.arange(6.0)[:, None]
        expected = [np.cos(q * x) @ spectrum[c] for c in range(3)]
        expected += [-np.sin(q * x) @ spectrum[c] for c in (3, 4)]
        assert stress[:5] == pytest.approx(np.array(expected), abs=1e-12)  # round-off
        assert not stress[5].any()


@pytest.mark.parametrize("load", list(Load))
def test_grids_of_one_period_share_their_tables(load, monkeypatch):
    made = []

    def counted(values):
        made.append(values.shape)
        return interpolate(values)

    interpolate = hankel.interpolate_panels
    monkeypatch.setattr(hankel, "interpolate_panels", counted)
    monkeypatch.setattr(semi_periodic, "interpolate_panels", counted)
    body = coated(3.0, 0.3, 0.25, 0.37)  # of no other test
    surface_remainder(Grid((80, 8), (1.0, 1.0), periodic=(False, True)), body, load)
    first = len(made)
    surface_remainder(Grid((40, 4), (2.0, 2.0), periodic=(False, True)), body, load)
    assert first >= 2
    assert len(made) == first
    for other in (
        Grid((80, 8), (1.0, 1.5), periodic=(False, True)),
        Grid((8, 80), (1.0, 1.0), periodic=(True, False)),
    ):
        known = len(made)
        surface_remainder(other, body, load)
        assert len(made) > known
