"""The limiting shear stress of the oil, and notes where a film's model is outside its validity."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.errors import InputError
from bem.lubrication import Lubricant, march_line_film, solve_line_film
from bem.lubrication.checks import Case, shear_beyond_measurements, viscosity_beyond_range
from bem.lubrication.oils.catalogue import find_oil
from bem.notes import has_code
from bem.notes.lubrication import (
    FILM_MOLECULAR,
    FILM_SPIKE,
    HEAT_LEFT_OUT,
    SHEAR_BEYOND_MEASURED,
    SHEAR_LIMITED,
    VISCOSITY_EXTRAPOLATED,
)
from bem.runs import plan_scene
from bem.scenes import PlainContext, get_kind

MODULUS = 115.5e9
ROLLER = {"radius": 10e-3, "contact_modulus": MODULUS, "load": math.pi * 10e-3 * 1.2e9**2 / MODULUS, "points": 500}
THESIS = {"radius": 2e-3, "contact_modulus": MODULUS, "load": 5.5 / 6e-3, "points": 500}
SPINDLE_OIL = {"viscosity": 0.01, "pressure_viscosity": 18e-9, "density_law": "incompressible"}
THESIS_OIL = {"viscosity": 0.36, "pressure_viscosity": 25e-9, "density_law": "incompressible"}


def roller(speed, ratio=0.95, **law):
    return solve_line_film(**ROLLER, speeds=(speed, ratio * speed), lubricant=Lubricant(**SPINDLE_OIL, **law))


def about(film, kind):
    return [note for note in film.notes if note.code == kind.code]


@pytest.mark.parametrize("speed", [1.0, 3.0, 10.0])
@pytest.mark.parametrize(
    "law", [{}, {"shear_law": "eyring", "shear_stress_limit": 5e6}, {"shear_law": "carreau", "shear_stress_limit": 5e6}]
)
def test_a_heavily_loaded_roller_has_the_friction_of_oils(speed, law):
    film = roller(speed, **law)
    # traction of mineral oils at such pressures: 0.03 to 0.08, and at most the coefficient with the ambient strength
    # over the mean pressure, 0.94 GPa, on top; the roller's rolling friction is below 0.001
    assert 0.02 < film.shear_force / film.load < 0.08 + 5e6 / 0.94e9 + 1e-3
    assert about(film, VISCOSITY_EXTRAPOLATED)


def test_a_spike_alone_is_not_the_middle_of_the_contact():
    """At 0.6 GPa by Hertz a spike of some GPa, as high as the mesh is fine, had viscosities in the middle extrapolated.
    Half an ellipse of pressure above p_c holds 10 % of a line's load from p0 = 1.003 p_c on."""
    light = ROLLER | {"load": math.pi * 10e-3 * 0.6e9**2 / MODULUS}
    oil = Lubricant(viscosity=0.04, pressure_viscosity=20e-9, density_law="incompressible")
    film = solve_line_film(**light, speeds=(3.0, 3.0), lubricant=oil)
    assert film.pressure.max() > 1e9
    assert film.status == "converged"
    assert not about(film, VISCOSITY_EXTRAPOLATED)
    above = ROLLER | {"load": math.pi * 10e-3 * 1.03e9**2 / MODULUS}
    (note,) = about(solve_line_film(**above, speeds=(3.0, 2.99), lubricant=oil), VISCOSITY_EXTRAPOLATED)
    assert "with a measured coefficient gave 0.001 to 1.3 times" in str(note)
    assert not about(solve_line_film(**above, speeds=(3.0, 3.0), lubricant=oil), VISCOSITY_EXTRAPOLATED)
    estimated = find_oil("ISO VG 68").at(313.15)
    (note,) = about(solve_line_film(**above, speeds=(1.0, 0.99), lubricant=estimated), VISCOSITY_EXTRAPOLATED)
    assert "as of this oil gave 0.001 to 6 times" in str(note)


@pytest.mark.internal
def test_a_spike_beyond_the_law_does_not_hide_a_glass():
    """Nine tenths of the law's range under almost all of the load, and one node far beyond it."""
    pressure = np.full(100, 0.45e9)
    pressure[90] = 3e9
    words = {}
    for alpha in (20e-9, 80e-9):
        oil = Lubricant(viscosity=0.04, pressure_viscosity=alpha, viscosity_law="barus", density_law="incompressible")
        case = SimpleNamespace(
            lubricant=oil, pressure=pressure, integral=np.sum, contact_modulus=MODULUS, not_found=None
        )
        words[alpha] = viscosity_beyond_range(case)
    # 0.04 Pa s exp(alpha p): 324 and 2e14 Pa s
    assert words[20e-9] is None
    assert has_code([words[80e-9]], VISCOSITY_EXTRAPOLATED, reason="glass")


def test_a_newtonian_oil_by_name_says_that_it_is_none():
    film = roller(3.0, shear_law="newtonian")
    assert film.shear_force / film.load > 1e3
    assert about(film, SHEAR_BEYOND_MEASURED)
    assert not about(roller(3.0), SHEAR_BEYOND_MEASURED)


@pytest.mark.internal
def test_wall_shear_by_pressure_is_no_friction_beyond_measurements():
    """With heat across the film the stress beside its middle is that of the pressure gradient, too."""
    hot = SimpleNamespace(
        lubricant=Lubricant(viscosity=0.04, pressure_viscosity=20e-9, density_law="incompressible"),
        pressure=np.array([1e8, 1e9]),
        hot_stress=np.array([-4e7, 9e7]), newtonian_stress=np.array([4e7, 9e7]),
    )  # fmt: skip
    limit = hot.limiting_stress = hot.lubricant.limiting_stress(hot.pressure)
    stress = Case.sliding_stress.func(hot)
    np.testing.assert_allclose(stress, np.minimum(hot.newtonian_stress, limit), rtol=0)
    assert shear_beyond_measurements(SimpleNamespace(**vars(hot), sliding_stress=stress)) is None
    assert shear_beyond_measurements(SimpleNamespace(**vars(hot), sliding_stress=hot.newtonian_stress)) is not None


@pytest.mark.parametrize("speed", np.geomspace(0.001, 0.4, 5))
def test_nothing_of_the_thesis_curves_is_cut(speed):
    """The full load, where pressure and shear are largest: the same bits as a Newtonian oil, and nothing to note."""
    limited, newtonian = (
        solve_line_film(**THESIS, speeds=(speed, 0.0), lubricant=Lubricant(**THESIS_OIL, **law))
        for law in ({}, {"shear_law": "newtonian"})
    )
    assert limited.shear_force == newtonian.shear_force
    np.testing.assert_array_equal(limited.shear_stress(), newtonian.shear_stress())
    assert limited.notes == newtonian.notes == ()
    stress = limited.lubricant.viscosity_at(limited.pressure) * speed / limited.thickness
    # by far: at most 6 % of the limit, inlet and exit included
    assert (stress < 0.06 * (5e6 + 0.08 * limited.pressure)).all()


@given(stress=st.floats(-1e300, 1e300), pressure=st.floats(0, 5e9), coefficient=st.floats(0.01, 0.2))
@settings(max_examples=50, deadline=None, derandomize=True)
def test_the_cut_is_sharp_and_odd(stress, pressure, coefficient):
    oil = Lubricant(
        0.1, limiting_shear_coefficient=coefficient, ambient_shear_strength=2e6, density_law="incompressible"
    )
    carried = oil.shear_stress(np.array([stress, -stress]), np.array([pressure, pressure]))
    limit = 2e6 + coefficient * pressure
    assert carried[0] == -carried[1] == (stress if abs(stress) <= limit else math.copysign(limit, stress))


def test_at_the_limit_friction_follows_from_the_load_alone():
    """tau = tau0 + Lambda p over the whole full film: force = tau0 x length + Lambda x load, and the pressure gradient
    adds what it adds for a Newtonian oil in pure rolling."""
    strength, coefficient = 2e6, 0.05
    oil = Lubricant(
        **SPINDLE_OIL | {"density_law": "dowson_higginson"},
        limiting_shear_coefficient=coefficient,
        ambient_shear_strength=strength,
    )
    film = solve_line_film(**ROLLER, speeds=(1.0, 0.5), lubricant=oil)
    newtonian = oil.viscosity_at(film.pressure) * 0.5 / film.thickness
    limit = strength + coefficient * film.pressure
    held = newtonian >= limit
    position = film.position[held]
    assert np.trapezoid(film.pressure[held], position) > 0.95 * film.load  # all but the inlet
    rolling = solve_line_film(**ROLLER, speeds=(0.75, 0.75), lubricant=oil).shear_force
    expected = np.trapezoid(limit[held], position) + np.trapezoid(np.where(held, 0.0, newtonian), film.position)
    # the two ends of the region that is held, a cell each of about five hundred
    assert film.shear_force - rolling == pytest.approx(expected, rel=5e-3)


def test_reversed_and_in_time_the_same_limit_holds():
    oil = Lubricant(**SPINDLE_OIL | {"density_law": "dowson_higginson"})
    case = {key: value for key, value in ROLLER.items() if key not in ("load", "points")}
    case |= {"lubricant": oil, "points": 301}
    load = 0.1 * ROLLER["load"]  # 0.38 GPa: a march has no fine cells for the spike of more
    marched = march_line_film(np.linspace(0, 1e-4, 3), load=lambda t: load, speeds=lambda t: (3.0, -1.5), **case)[-1]
    steady = solve_line_film(load=load, speeds=(3.0, -1.5), **case)
    back = solve_line_film(load=load, speeds=(-3.0, 1.5), **case)
    assert back.shear_force == pytest.approx(-steady.shear_force, rel=1e-12)
    assert back.notes == steady.notes
    assert 0.03 < steady.shear_force / load < 0.1
    # 301 nodes of a fixed mesh
    assert marched.shear_force == pytest.approx(steady.shear_force, rel=2e-2)
    assert about(marched, SHEAR_LIMITED)


@pytest.mark.parametrize(
    ("speeds", "oil", "kind", "reason"),
    [
        ((1e-4, 0.9e-4), {}, FILM_MOLECULAR, None),
        ((1.0, 0.95), {}, SHEAR_LIMITED, None),
        ((3.0, 3.0), {}, FILM_SPIKE, None),
        ((20.0, 20.0), {}, HEAT_LEFT_OUT, "inlet"),
        ((5.0, 2.0), {}, HEAT_LEFT_OUT, "sliding"),
        (
            (0.1, 0.099),
            {"viscosity_law": "barus", "density_law": "dowson_higginson"},
            VISCOSITY_EXTRAPOLATED,
            "elastic",
        ),
    ],
)
def test_each_note_where_it_belongs_and_not_beside(speeds, oil, kind, reason):
    heavy = solve_line_film(**ROLLER, speeds=speeds, lubricant=Lubricant(**{**SPINDLE_OIL, **oil}))
    assert has_code(heavy.notes, kind, reason=reason)
    light = solve_line_film(
        **{**ROLLER, "load": 1e4},
        speeds=(0.2, 0.18),
        lubricant=Lubricant(**SPINDLE_OIL),
    )
    assert not has_code(light.notes, kind, reason=reason)


@pytest.mark.parametrize("key", ["limiting_shear_coefficient", "ambient_shear_strength"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "5 MPa"])
def test_refusals(key, value):
    with pytest.raises(InputError, match=key):
        Lubricant(0.1, **{key: value})


SCENE = {
    "kind": "friction",
    "lower": {"material": "steel-cylinder", "surface": {"kind": "generated", "rms_height": "100 nm", "hurst": 0.8}},
    "upper": {"material": "steel-cylinder"},
    "contact": {"radius": "2 mm", "width": "6 mm", "loads": ["500 N"], "boundary_friction": 0.09},
    "oil": {"viscosity": "0.36 Pa*s", "pressure_viscosity": "25 1/GPa"},
    "speeds": ["0.01 m/s", "0.4 m/s"],
    "grid": {"shape": 50, "spacing": "2 um", "periodic": [False, True]},
    "film": {"points": 300},
}


def test_a_stribeck_curve_at_500_newton():
    """stribeck-mineral-oil with a load that gave frictions of 1e7 and more."""
    scene, _ = plan_scene(SCENE, [])
    context = PlainContext(scene.seed)
    curve = get_kind("friction").run(scene, context)
    assert all(0.03 < value < 0.1 for value in curve.friction)
    assert has_code(context.notes, SHEAR_LIMITED)
    assert not has_code(context.notes, SHEAR_BEYOND_MEASURED)
