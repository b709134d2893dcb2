"""Stacks of layers: frequency response against a many-digit solution, coefficients, operators, stresses."""

import numpy as np
import pytest
from coated_bodies import assert_layers_of_the_same_change_nothing, by_fourier, error_of_table
from hypothesis import given, settings
from hypothesis import strategies as st
from stack_oracle import assert_finite_and_balanced, disagreement, off_the_mean_of_a_circle

from bem import Body, Grid, InputError, Layer, Material, displacement_operator, subsurface_stress
from bem.kernels.coefficients import stress_coefficients, surface_coefficients
from bem.kernels.layered import frequency_response, hankel
from bem.kernels.layered.cells import stress_remainder, surface_remainder
from bem.kernels.loads import Load

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
SUBSTRATE = Material("substrate", youngs_modulus=2.6, poissons_ratio=0.3)
# the worst for the integrals: stiff plates on soft, nearly incompressible films turn the poles towards the real axis
STIFF_SOFT = ((800.0, 0.25, 0.5), (0.4, 0.49, 0.25), (300.0, 0.3, 0.75), (0.3, 0.49, 0.5))
MIXED = ((5.0, 0.2, 0.25), (0.05, 0.45, 0.125), (40.0, 0.3, 1.5))


def stack(layers, substrate=SUBSTRATE):
    """Of (shear modulus over the substrate's, Poisson's ratio, thickness)."""
    base = substrate.shear_modulus
    return Body(
        substrate,
        layers=[
            Layer(Material("l", youngs_modulus=2 * g * base * (1 + nu), poissons_ratio=nu), h) for g, nu, h in layers
        ],
    )


# thicknesses are whole multiples of 1/1024, so that depths of interfaces are exact: a soft layer between stiff ones
# has steep displacements, and one last digit of its depth is more than the response errs
layers_drawn = st.lists(
    st.tuples(
        st.floats(-3, 3).map(lambda e: 10.0**e),
        st.floats(0.05, 0.49),
        st.floats(-2, 0.3).map(lambda e: max(1, round(1024 * 10.0**e)) / 1024),
    ),
    min_size=2,
    max_size=5,
)


@settings(deadline=None, max_examples=20, derandomize=True)
@given(
    layers=layers_drawn,
    qh=st.floats(-4, 0.9).map(lambda e: 10.0**e),
    angle=st.floats(0, 6),
    at=st.tuples(st.integers(0, 5), st.integers(0, 16)),
    tangential=st.booleans(),
)
def test_elasticity_is_solved(layers, qh, angle, at, tangential):
    """Any stack of 2 to 5 layers, at the surface, in every medium and on its interfaces."""
    body = stack(layers)
    tops = (0.0, *body.interfaces)
    medium = min(at[0], len(layers))
    thickness = layers[medium][2] if medium < len(layers) else 1.0
    depth = tops[medium] + thickness * at[1] / 16
    q = qh / max(h for _, _, h in layers)
    # round-off; 4000 random stacks gave 1e-13 at most but where moduli jump by 1e5 twice: 1e-12
    assert disagreement(body, q * np.cos(angle), q * np.sin(angle), depth, tangential) < 1e-12


@settings(deadline=None, max_examples=60, derandomize=True)
@given(layers=layers_drawn, qh=st.floats(-6, 4).map(lambda e: 10.0**e), depth=st.floats(0, 3))
def test_finite_everywhere_and_tractions_pass(layers, qh, depth):
    """No overflow; displacements and tractions pass every interface; the surface carries the load."""
    body = stack(layers)
    q = np.array([qh / min(h for _, _, h in layers)])
    # one last digit of the depth, times q and the jump of the moduli
    assert_finite_and_balanced(q, body, depth, jump=1e-9)


@pytest.mark.internal
@pytest.mark.parametrize("layers", [STIFF_SOFT, MIXED])
def test_a_layer_cut_in_two_is_the_same(layers):
    """At every depth, thin and thick, for real wavenumbers and complex ones."""
    whole = stack(layers)
    q = np.geomspace(1e-6, 1e4, 40) / layers[0][2]
    for number, (g, nu, h) in enumerate(layers):
        for part in (0.25, 1 / 1024):
            cut = stack((*layers[:number], (g, nu, part * h), (g, nu, h - part * h), *layers[number + 1 :]))
            assert len(cut.layers) == len(layers) + 1
            for depth in (0.0, 0.3 * h, whole.interfaces[number], 4.0):
                for wave in (q, q * np.exp(0.5j)):
                    a, b = (frequency_response.wave_frame_response(wave, body, depth) for body in (whole, cut))
                    # per wavenumber, of the largest of the medium's rows
                    scale = np.abs(a).max(axis=0)
                    assert (np.abs(a - b) <= 1e-12 * scale + 1e-300).all()


@pytest.mark.internal
def test_stack_of_the_substrate_is_the_half_space():
    body = stack([(1.0, 0.3, h) for h in (0.25, 1.0, 0.5)])
    bare = Body(SUBSTRATE)
    q = np.geomspace(1e-6, 1e4, 200)
    for depth in (0.0, 0.1, 0.25, 0.9, 1.75, 3.0):
        # round-off, of numbers up to 2
        assert frequency_response.wave_frame_response(q, body, depth) == pytest.approx(
            frequency_response.wave_frame_response(q, bare, depth), abs=1e-14
        )
    for depth in (0.0, 0.25):
        nothing = frequency_response.wave_frame_response(q, body, depth, remainder=True)
        assert np.abs(nothing).max() < 1e-14


def test_complex_wavenumbers_continue_the_real_ones():
    """Cauchy: the mean over a small circle is the value at its centre, across the switch of every layer."""
    body = stack(MIXED)
    for centre in (0.5, 0.7, 4.0, 8.0):
        for depth in (0.0, 0.2, 0.3, 1.0, 2.5):
            # round-off; the trapezoidal rule on a circle is exact to it
            assert off_the_mean_of_a_circle(body, depth, centre, 0.2) <= 1e-12


@pytest.mark.internal
@pytest.mark.parametrize("layers", [STIFF_SOFT, pytest.param(MIXED, marks=pytest.mark.slow)])
@pytest.mark.parametrize("load", list(Load))
def test_tables_against_the_real_axis(layers, load):
    """The turned path gives what the real axis gives, for every order, in every medium."""
    body = stack(layers)
    radii = np.array([0.03, 0.4, 1.7, 9.0])
    cases = [hankel.surface_spectra(body, load)]
    tops = (0.0, *body.interfaces)
    cases += [hankel.stress_spectra(body, top + 0.1, load) for top in tops]
    assert max(error_of_table(spectra, radii, 1e3, panels=0.5) for spectra in cases) < 1e-12


@pytest.mark.internal
@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, False)])
@pytest.mark.parametrize("load", list(Load))
def test_coefficients_of_a_layer_cut_in_two(periodic, load):
    """Coefficients know their interfaces through the response only: a cut changes path and decay, not the answer."""
    grid = Grid((9, 6), (0.5, 0.4), periodic=periodic)
    whole = stack([(20.0, 0.2, 0.75)])
    cut = stack([(20.0, 0.2, 0.25), (20.0, 0.2, 0.5)])
    surface = surface_coefficients(grid, whole, load)
    assert surface_coefficients(grid, cut, load) == pytest.approx(surface, abs=1e-12 * np.abs(surface).max())
    for depth in (0.0, 0.2, 0.25, 0.5, 0.75, 1.5):
        stress = stress_coefficients(grid, whole, depth, load)
        # promised of the tables
        assert stress_coefficients(grid, cut, depth, load) == pytest.approx(stress, abs=1e-12 * np.abs(stress).max())


@pytest.mark.internal
@pytest.mark.parametrize("load", [pytest.param(Load.NORMAL, marks=pytest.mark.slow), Load.TANGENTIAL])
def test_coefficients_against_the_double_fourier_integral(load):
    """By polars, without Bessel functions, tables or cell integration; in every medium."""
    body, dx, dy = stack(MIXED), 0.5, 0.35
    grid = Grid((5, 4), (dx, dy))
    for depth in (None, 0.1, 1.0):
        if depth is None:
            mine = surface_remainder(grid, body, load)[None]
        else:
            mine = stress_remainder(grid, body, depth, load)
        for i, j in ((0, 0), (2, 3)):
            expected = by_fourier(body, depth, load, i * dx, j * dy, dx, dy)
            # round-off of 1e5 terms that oscillate
            assert mine[:, i, j] == pytest.approx(expected, abs=2e-12 * np.abs(mine).max())


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_tractions_and_strains_pass_every_interface(periodic):
    """Through `subsurface_stress`, with friction: zz, xz, yz and the strains along the interface do not jump."""
    body = stack(MIXED, STEEL)
    grid = Grid((8, 6), (0.3, 0.4), periodic=periodic)
    pressure = np.zeros(grid.shape)
    pressure[2:5, 2:4] = 1e8
    for number, interface in enumerate(body.interfaces):
        depths = [interface, float(np.nextafter(interface, np.inf))]
        above, below = np.moveaxis(subsurface_stress(pressure, grid, body, depths, friction=0.3), 1, 0)
        scale = max(np.abs(above).max(), np.abs(below).max())

        def in_plane(stress, solid):
            trace = solid.poissons_ratio / (1 + solid.poissons_ratio) * stress[:3].sum(axis=0)
            return np.stack([stress[0] - trace, stress[1] - trace, stress[5]]) / solid.shear_modulus

        # round-off of two different sums: closed forms plus a remainder in the outermost layer, whole transforms below
        assert above[2:5] == pytest.approx(below[2:5], abs=1e-11 * scale)
        strains = [in_plane(s, m) for s, m in ((above, body.media[number]), (below, body.media[number + 1]))]
        softest = min(solid.shear_modulus for solid in body.media[number : number + 2])
        assert strains[0] == pytest.approx(strains[1], abs=1e-11 * scale / softest)


@pytest.mark.parametrize("periodic", [(False, False), (True, False), (True, True)])
def test_identical_materials_change_nothing(periodic):
    grid = Grid((16, 12), (0.5, 0.5), periodic=periodic)
    depths = [0.2, 0.4, 1.0, 1.3, 2.0]
    assert_layers_of_the_same_change_nothing(grid, STEEL, (0.4, 0.9, 0.2), depths, seed=5)


def test_a_layer_of_nearly_no_thickness_vanishes():
    """From anywhere in the stack; 1e-7 of a cell."""
    grid = Grid((10, 8), (1.0, 1.0))
    pressure = np.zeros(grid.shape)
    pressure[3:6, 2:5] = 1e6
    rest = MIXED[:2]
    expected = displacement_operator(grid, stack(rest))(pressure)
    for place in range(3):
        layers = (*rest[:place], (30.0, 0.2, 1e-7), *rest[place:])
        found = displacement_operator(grid, stack(layers))(pressure)
        assert found == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())  # first order: 30 x 1e-7 x 2 pi


def test_the_layers_of_a_body():
    thin, thick = Layer(SUBSTRATE, 0.5), Layer(STEEL, 2.0)
    assert Body(STEEL, layer=thin) == Body(STEEL, layers=(thin,)) == Body(STEEL, layers=[thin])
    assert hash(Body(STEEL, layer=thin)) == hash(Body(STEEL, layers=[thin]))
    body = Body(STEEL, layers=[thin, thick])
    assert body.layer == thin
    assert body.interfaces == (0.5, 2.5)
    assert [body.medium_at(z) for z in (0.0, 0.5, 0.6, 2.5, 2.6)] == [0, 0, 1, 1, 2]
    assert body.surface_material == SUBSTRATE
    assert Body(STEEL).homogeneous
    assert not body.homogeneous
    assert Body(STEEL).layer is None


@pytest.mark.parametrize(
    ("arguments", "count", "named"),
    [
        ({"layers": [Layer(STEEL, 1.0), "dlc", 3]}, 2, "layers\\[1\\] 'dlc'"),
        ({"layers": Layer(STEEL, 1.0)}, 1, "must be a sequence of Layer, outermost first"),
        ({"layers": "dlc"}, 1, "must be a sequence of Layer"),
        ({"layer": Layer(STEEL, 1.0), "layers": (Layer(STEEL, 1.0),)}, 1, "both given"),
        ({"layer": "dlc", "layers": [None]}, 3, "must be a Layer"),
    ],
)
def test_mistakes_are_named_one_by_one(arguments, count, named):
    with pytest.raises(InputError, match=named) as caught:
        Body(STEEL, **arguments)
    assert len(caught.value.messages) == count


def graded(count):
    """Modulus falling by half, Poisson's ratio rising over a depth of one, as so many layers of their mean values."""
    middles = (np.arange(count) + 0.5) / count
    layers = [
        Layer(Material("part", youngs_modulus=2.0 - m, poissons_ratio=0.2 + 0.1 * m), 1.0 / count) for m in middles
    ]
    return Body(Material("base", youngs_modulus=1.0, poissons_ratio=0.3), layers=layers)


@pytest.mark.internal
def test_a_graded_coating_is_met_with_order_two():
    """At a depth of its own stiffness a cell sees the layers' mean: away from it, and for waves longer than a layer."""
    grid = Grid((24, 1), (0.5, 0.5))
    whole = [surface_coefficients(grid, graded(count), Load.NORMAL)[:, 0] for count in (8, 16, 32, 128)]
    scale = np.abs(whole[3]).max()
    errors = [np.abs(one - whole[3]).max() / scale for one in whole[:3]]
    # 128 layers are themselves off by a sixteenth of what 32 are
    assert 3.2 < errors[0] / errors[1] < 5.5
    assert 3.2 < errors[1] / errors[2] < 5.5
    assert errors[2] < 1e-3


@pytest.mark.internal
def test_fifty_layers_ask_for_few_wavenumbers(monkeypatch):
    """What a contact of many layers costs: one table for all of its grids, its wavenumbers shared by all distances."""
    asked = []
    true = frequency_response.wave_frame_response

    def counted(q, *args, **kwargs):
        asked.append(np.size(q))
        return true(q, *args, **kwargs)

    monkeypatch.setattr(frequency_response, "wave_frame_response", counted)
    hankel._cached_table.cache_clear()
    body = graded(50)
    for cells in (64, 32, 16):
        surface_coefficients(Grid((cells, cells), (6.4 / cells,) * 2), body, Load.NORMAL)
    # 35,000 were counted; 240,000 for each grid before
    assert 0 < sum(asked) < 45_000
