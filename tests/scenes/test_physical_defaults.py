"""Defaults that decide film and friction: shear law, density, heat and oil volume, the same in every kind of scene."""

import tomllib
from importlib.resources import files

import pytest

from bem import load_scene
from bem.scenes.load import library

STARTS = ("film", "friction", "point_film", "point_film_time", "running_in", "running_in_life", "traction")
"""Folders of kinds whose start has an oil."""
HOT = ("friction", "running_in", "running_in_life", "traction")
"""Those whose film may have heat."""
MIXED = ("friction", "running_in", "running_in_life")
"""Those whose film and asperities share the load."""
THESIS = (
    "hardness-optimum",
    "particle-size-against-speed",
    "running-in-stribeck",
    "stribeck-measured",
    "stribeck-mineral-oil",
)
"""Built-in scenes of the thesis with an oil."""


def start(folder):
    """The start of a kind that `bem new` writes, without its choice of heat."""
    table = tomllib.loads(files(f"bem.kinds.{folder}").joinpath("basic.toml").read_text(encoding="utf-8"))
    table.pop("thermal", None)
    return table


@pytest.mark.parametrize("folder", STARTS)
def test_oils_are_compressible_and_sheared_by_the_constants_of_their_base(folder):
    oil = load_scene(start(folder)).oil
    assert (oil.shear_law.name, oil.density_law.name) == ("base_oil", "dowson_higginson")


@pytest.mark.parametrize("folder", HOT)
def test_films_are_hot_unless_constants_are_missing(folder):
    table = start(folder)
    assert load_scene(table).thermal == "lumped"
    plain = {"oil": {"viscosity": "20 mPa*s", "pressure_viscosity": "20 1/GPa"}}
    assert load_scene(table | plain).thermal == "off"
    cold = {"upper": {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3, "hardness": "7 GPa"}}}
    assert load_scene(table | cold).thermal == "off"
    assert load_scene(table | {"thermal": "off"}).thermal == "off"


@pytest.mark.parametrize("folder", MIXED)
def test_oil_is_counted_where_the_film_carries(folder):
    assert load_scene(start(folder)).sharing.oil_volume == "loaded"


def test_films_without_a_model_of_heat_are_cold():
    table = start("friction") | {"contact": {"radius": "10 mm", "width": "8 mm", "loads": ["200 N"]}}
    table["contact"]["boundary_friction"] = 0.12
    assert load_scene(table).thermal == "lumped"
    endless = {"sharing": {"separation": "film"}, "grid": table["grid"] | {"periodic": [True, True]}}
    assert load_scene(table | endless).thermal == "off"
    cell = start("friction") | {"grid": {"shape": 32, "lengths": "40 um", "periodic": True}}
    assert load_scene(cell).thermal == "off"


@pytest.mark.parametrize("name", THESIS)
def test_scenes_of_the_thesis_name_its_choices(name):
    table = library()[name]
    assert table["oil"]["shear_law"] == "limited"
    assert table["oil"]["density_law"] == "incompressible"
    assert table["sharing"]["oil_volume"] == "patch"
    assert table["thermal"] == "off"
