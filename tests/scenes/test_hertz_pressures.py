"""Maximum Hertz pressures in place of loads: kinds film, wear and tribofilm."""

import numpy as np
import pytest

from bem import InputError, load_scene, plan_scene, run_scene
from bem.materials import contact_modulus
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact, smooth_load
from bem.scenes.kind import get_kind

STEEL = {"material": "steel-52100"}
FILM = {
    "kind": "film", "name": "film", "lower": STEEL, "upper": STEEL,
    "cylinder": {"radius": "10 mm", "width": "8 mm", "hertz_pressure": "0.4 GPa"},
    "oil": {"grade": "ISO VG 68", "temperature": "60 degC"}, "outputs": {"errors": False},
    "motion": {"kind": "table", "times": ["0 s", "1 ms"], "speeds": ["0.2 m/s", "0.2 m/s"]},
    "march": {"duration": "1 ms", "steps": 2, "points": 201},
}  # fmt: skip
WEAR = {
    "kind": "wear", "name": "wear", "lower": STEEL, "upper": STEEL,
    "cylinder": {"radius": "2 mm", "width": "6 mm", "hertz_pressures": ["0.8 GPa", "1.2 GPa"], "friction": 0.1},
    "domain": {"cells": 16, "half_widths": 4}, "depths": {"count": 8, "spacing": "200 nm"}, "cycles": {"count": 1},
}  # fmt: skip
RUBBED = {
    "kind": "tribofilm", "name": "rubbed", "lower": STEEL, "upper": STEEL,
    "grid": {"shape": 32, "lengths": "300 um"}, "shape": {"kind": "sphere", "radius": "5 mm"},
    "rubbing": {"hertz_pressures": ["0.5 GPa", "1 GPa"], "temperatures": ["80 degC"], "duration": "1 min"},
    "film": {
        "activation_energy": "0.8 eV", "activation_volume": "40 angstrom^3", "wear_coefficient": "1e-4 1/s",
        "hardness": {"kind": "constant", "value": "3 GPa"},
        "youngs_modulus": {"kind": "constant", "value": "100 GPa"},
    },
}  # fmt: skip


def modulus_of(scene):
    return contact_modulus(scene.lower.build().material, scene.upper.build().material)


@pytest.mark.parametrize("radii", [(5e-3, 5e-3), (5e-3, 20e-3), (5e-3, np.inf)])
def test_the_load_of_a_pressure_has_that_pressure(radii):
    load = smooth_load(radii=radii, contact_modulus=115e9, maximum_pressure=1.2e9)
    solve = {"contact_modulus": 115e9, "load": load}
    line = np.isinf(radii[1])
    smooth = cylinder_contact(radius=radii[0], **solve) if line else ellipse_contact(radii=radii, **solve)
    assert smooth.maximum_pressure == pytest.approx(1.2e9, rel=1e-12)


def test_a_film_in_time_has_the_load_of_its_pressure(tmp_path):
    scene, _ = plan_scene(FILM)
    per_length = scene.cylinder.per_length(0.5, modulus_of(scene))
    line = cylinder_contact(radius=10e-3, contact_modulus=modulus_of(scene), load=per_length)
    assert line.maximum_pressure == pytest.approx(0.4e9, rel=1e-12)
    by_load = {**FILM, "cylinder": {"radius": "10 mm", "width": "8 mm", "load": per_length * 8e-3}}
    found = [run_scene(table, tmp_path / str(i), figures=False).summary for i, table in enumerate((FILM, by_load))]
    assert found[0]["film_at_end_nm"] == pytest.approx(found[1]["film_at_end_nm"], rel=1e-9)


def test_wear_runs_over_pressures_as_over_their_loads():
    scene = get_kind("wear").resolved(load_scene(WEAR))
    assert scene.cylinder.hertz_pressures is None
    for load, pressure in zip(scene.cylinder.loads, (0.8e9, 1.2e9), strict=True):
        line = cylinder_contact(radius=2e-3, contact_modulus=modulus_of(scene), load=load / 6e-3)
        assert line.maximum_pressure == pytest.approx(pressure, rel=1e-12)
    (axis,) = get_kind("wear").axes(scene)[:1]
    assert axis.values == tuple(scene.cylinder.loads)
    assert load_scene(WEAR).smooth_contact().maximum_pressure == pytest.approx(0.8e9, rel=1e-12)


@pytest.mark.parametrize(
    ("shape", "periodic"),
    [
        ({"kind": "sphere", "radius": "5 mm"}, False),
        ({"kind": "ellipsoid", "radius": "5 mm", "radius_y": "9 mm"}, False),
        ({"kind": "cylinder", "radius": "5 mm"}, [False, True]),
    ],
)
def test_a_tribofilm_grows_under_the_load_of_its_pressure(shape, periodic):
    table = {**RUBBED, "shape": shape, "grid": {**RUBBED["grid"], "periodic": periodic}}
    scene = get_kind("tribofilm").resolved(load_scene(table))
    assert scene.rubbing.hertz_pressures is None
    smooth = scene.smooth_contact((300e-6, 300e-6))
    assert smooth.maximum_pressure == pytest.approx(0.5e9, rel=1e-9)
    power = 2 if shape["kind"] == "cylinder" else 3
    assert scene.rubbing.loads[1] / scene.rubbing.loads[0] == pytest.approx(2**power, rel=1e-12)


def test_pressures_beside_loads_and_of_flats_are_refused():
    for table, name, key, also in (
        (FILM, "cylinder", "load", "1 N"),
        (WEAR, "cylinder", "loads", ["1 N"]),
        (RUBBED, "rubbing", "loads", ["1 N"]),
    ):
        with pytest.raises(InputError, match=f"{key} and hertz_pressures? are given; allowed: exactly one of"):
            load_scene({**table, name: {**table[name], key: also}})
        neither = {k: v for k, v in table[name].items() if not k.startswith("hertz")}
        with pytest.raises(InputError, match=f"none of {key}, hertz_pressures? is given"):
            load_scene({**table, name: neither})
    with pytest.raises(InputError, match=r"hertz_pressures of a flat; allowed: a radius"):
        load_scene({**WEAR, "cylinder": {"width": "6 mm", "hertz_pressures": ["1 GPa"]}})
    with pytest.raises(InputError, match="hertz_pressures under a shape of kind flat"):
        load_scene({**RUBBED, "shape": {"kind": "flat"}})
