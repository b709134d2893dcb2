"""Films on coated bodies: without a film the coated body alone, a film of the coating's material a thicker coating."""

import numpy as np
import pytest
from tip import IRON, tip_contact

from bem import Body, Grid, InputError, Layer, Material, displacement_operator, grow_tribofilm, solve_contact
from bem.notes import has_code
from bem.notes.checks import TRIBOFILM_ON_COATING
from bem.runs import plan_scene
from bem.scenes import PlainContext, get_kind
from bem.scenes.checks import examine, scene_warnings
from bem.tribofilm import Constant, FadingSubstrate, grow_local_film, solve_film_contact

CARBON = Material("carbon", youngs_modulus=150e9, poissons_ratio=0.2, hardness=15e9)
NITRIDE = Material("nitride", youngs_modulus=300e9, poissons_ratio=0.25, hardness=20e9)
COATING = (Layer(CARBON, 6e-9), Layer(NITRIDE, 3e-9))
GRID = Grid((32, 32), (1.2e-9, 1.2e-9))
HARD = Constant(6e9)
TIMES = np.linspace(0, 1000, 11)


def contact(**change):
    given = {"grid": GRID, "counterface": IRON, "hardness": HARD, "modulus": Constant(15e9), "layers": COATING}
    return tip_contact(**{**given, **change})


def solved(body, case, counterface=IRON):
    return solve_contact(
        case.gap,
        displacement_operator(GRID, (body, Body(counterface))),
        load=case.load,
        hardness=6e9,
        tolerance=case.contact_tolerance,
    )


def test_without_a_film_the_contact_is_that_of_the_coated_body():
    case = contact()
    alone, coated = solve_film_contact(case, 0.0), solved(Body(IRON, layers=COATING), case)
    assert alone.pressure.tobytes() == coated.pressure.tobytes()
    bare = solve_film_contact(contact(layers=()), 0.0)
    assert np.abs(alone.pressure - bare.pressure).max() > 0.01 * bare.pressure.max()


def test_a_film_of_the_coatings_material_is_a_thicker_coating():
    case = contact(modulus=Constant(CARBON.youngs_modulus), poissons_ratio=CARBON.poissons_ratio)
    thicker = Body(IRON, layers=(Layer(CARBON, 10e-9), COATING[1]))
    grown, coated = solve_film_contact(case, 4e-9), solved(thicker, case)
    np.testing.assert_allclose(grown.pressure, coated.pressure, atol=1e-4 * 6e9)
    thin = solved(Body(IRON, layers=COATING), case)
    assert np.abs(thin.pressure - coated.pressure).max() > 1e-3 * 6e9


def test_a_coating_of_the_substrates_material_changes_no_film():
    same = (Layer(IRON, 5e-9),)
    films = [grow_tribofilm(TIMES, contact(layers=layers), wear_coefficient=3e-3) for layers in (same, ())]
    np.testing.assert_allclose(films[0].history.thickness, films[1].history.thickness, rtol=2e-3, atol=1e-14)


def test_a_film_on_a_stiff_coating_follows_its_stiffness_mean_and_local():
    """A stiffer body has higher pressures, and growth is activated by stress."""
    stiff, soft = ((Layer(Material("coat", youngs_modulus=e, poissons_ratio=0.25), 8e-9),) for e in (300e9, 70e9))
    for grow in (grow_tribofilm, grow_local_film):
        thick, thin = (
            grow(TIMES, contact(layers=layers, load=150e-9), wear_coefficient=3e-3).history.thickness[-1]
            for layers in (stiff, soft)
        )
        assert thick > 1.02 * thin > 0


def test_the_counterbodys_coating_is_in_the_contact_and_its_hardness_caps():
    soft = Material("soft", youngs_modulus=100e9, poissons_ratio=0.3, hardness=4e9)
    case = contact(layers=(), counterface_layers=(Layer(soft, 5e-9),))
    assert case.hardness_at(0.0) == 4e9
    found = solve_film_contact(case, 0.0)
    expected = solve_contact(
        case.gap,
        displacement_operator(GRID, (Body(IRON), Body(IRON, layers=case.counterface_layers))),
        load=case.load,
        hardness=4e9,
        tolerance=case.contact_tolerance,
    )
    assert found.pressure.tobytes() == expected.pressure.tobytes()
    with pytest.raises(InputError, match="counterface_layers"):
        contact(counterface=None, counterface_layers=case.counterface_layers)


def run(*settings):
    scene, _ = plan_scene("tribofilm-ball", ("grid.shape=80", "rubbing.points=9", "outputs.errors=false", *settings))
    return scene, get_kind("tribofilm").run(scene, PlainContext(scene.seed))


STACK = 'lower.layers=[{material="dlc",thickness="2 um"},{material="tungsten-carbide",thickness="0.5 um"}]'


def test_a_scene_grows_a_film_on_a_stack_and_says_what_is_known_of_it():
    scene, film = run(STACK)
    _, bare = run()
    assert film.status is bare.status
    assert film.film_thickness > 0
    assert film.film_thickness != bare.film_thickness
    reasons = {
        note.values["reason"] for note in scene_warnings(examine(scene)) if note.code == TRIBOFILM_ON_COATING.code
    }
    assert {"growth", "hardness"} <= reasons
    assert not has_code(scene_warnings(examine(plan_scene("tribofilm-ball")[0])), TRIBOFILM_ON_COATING)
    same = 'film.hardness={kind="fading_substrate",substrate="20 GPa",film="2 GPa",length="190 nm"}'
    scene, _ = plan_scene("tribofilm-ball", (STACK, same))
    reasons = {
        note.values["reason"] for note in scene_warnings(examine(scene)) if note.code == TRIBOFILM_ON_COATING.code
    }
    assert "hardness" not in reasons
    for load, told in (("5 N", False), ("100 N", True)):  # a smooth ball far below both hardnesses, and one near
        smooth = ("lower.surface=smooth", "upper.surface=smooth", f'rubbing.loads=["{load}"]', 'shape.radius="2 mm"')
        scene, _ = plan_scene("tribofilm-ball", (STACK, *smooth))
        found = [note for note in scene_warnings(examine(scene)) if note.code == TRIBOFILM_ON_COATING.code]
        pressure = examine(scene).cases[0].smooth.maximum_pressure
        assert (pressure > 3e9) is told  # half of the hardness of the bare substrate, 6 GPa
        assert any(note.where == "film.hardness.substrate" for note in found) is told


def test_hardness_of_a_film_fades_from_the_coatings():
    fading = FadingSubstrate(CARBON.hardness, 2e9, 4e-9)
    assert contact(hardness=fading, counterface=NITRIDE).hardness_at(0.0) == CARBON.hardness
