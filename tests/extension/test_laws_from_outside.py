"""One file outside the package adds a viscosity law and a wear criterion, each with a parameter: in Python, in a scene,
through the command line; and what is refused."""

import json
import os
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from small_scenes import WEAR

import bem
from bem import Lubricant, laws
from bem.errors import InputError
from bem.extensions import load_file
from bem.laws import parameter
from bem.lubrication.viscosity import ViscosityLaw
from bem.scenes import load_scene
from bem.scenes.load import dump_scene
from bem.scenes.schema import scene_schema

OUTSIDE = '''
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import bem
from bem.laws import parameter
from bem.lubrication.viscosity import ViscosityLaw
from bem.wear.criterion import StressCriterion


@bem.register
@dataclass(frozen=True)
class TwoSlopes(ViscosityLaw):
    """Barus up to a pressure, half the slope beyond."""

    name: ClassVar[str] = "two_slopes"
    bend: float = parameter("pressure where the slope halves", "Pa", above=0)

    def log_viscosity_ratio(self, pressure, viscosity, pressure_viscosity):
        low = np.minimum(pressure, self.bend)
        slope = np.where(pressure < self.bend, pressure_viscosity, 0.5 * pressure_viscosity)
        return pressure_viscosity * (low + 0.5 * (pressure - low)), slope


@bem.register
@dataclass(frozen=True)
class OverStress(StressCriterion):
    """Von Mises stress above a threshold."""

    name: ClassVar[str] = "over_stress"
    threshold: float = parameter("stress that does no harm", "Pa", at_least=0)

    def equivalent_stress(self, stress):
        return np.maximum(bem.von_mises(stress) - self.threshold, 0.0)
'''
FILM = """
kind = "film"
lower = { material = "steel-cylinder" }
upper = { material = "steel-cylinder" }
cylinder = { radius = "2 mm", width = "6 mm", load = "20 N" }
motion = { kind = "table", times = [0, 1e-3], speeds = ["0.1 m/s", "0.1 m/s"] }
march = { duration = "1e-3 s", steps = 2, points = 101 }
[oil]
viscosity = "0.2 Pa*s"
pressure_viscosity = "20 1/GPa"
"""


@pytest.fixture
def outside(tmp_path, monkeypatch):
    """The file's laws, registered for one test."""
    path = tmp_path / "my_laws.py"
    path.write_text(OUTSIDE)
    before = {family: set(laws.laws_of(family).values()) for family in laws.FAMILIES}
    yield load_file(str(path))
    sys.modules.pop("my_laws", None)
    for family, kept in before.items():
        for law in set(laws.laws_of(family).values()) - kept:
            laws.unregister(law)


def bem_run(folder, text, *more, settings=(), **environment):
    (folder / "scene.toml").write_text(text)
    asked = (f"--set={one}" for one in settings)
    return subprocess.run(
        [sys.executable, "-m", "bem", *more, "run", "scene.toml", "--out", "out", "--no-figures", *asked],
        cwd=folder, capture_output=True, text=True, timeout=300, check=False, env={**os.environ, **environment},
    )  # fmt: skip


def test_a_viscosity_law_in_python(outside):
    oil = Lubricant(0.2, pressure_viscosity=20e-9, viscosity_law="two_slopes", bend=1e8, density_law="incompressible")
    assert oil == Lubricant(
        0.2, pressure_viscosity=20e-9, viscosity_law=outside.TwoSlopes(bend=1e8), density_law="incompressible"
    )
    assert oil.bend == 1e8
    assert oil.viscosity_at(np.array([3e8]))[0] == pytest.approx(0.2 * np.exp(2 + 2), rel=1e-14)
    with pytest.raises(InputError, match=r"bend is missing.*two_slopes.*\[Pa\]"):
        Lubricant(0.2, viscosity_law="two_slopes", density_law="incompressible")
    with pytest.raises(InputError, match=r"two_slope' is unknown - did you mean 'two_slopes'"):
        Lubricant(0.2, viscosity_law="two_slope", density_law="incompressible")
    with pytest.raises(InputError, match=r"bent is unknown - did you mean 'bend'"):
        Lubricant(0.2, viscosity_law="two_slopes", bend=1e8, bent=1e8, density_law="incompressible")
    with pytest.raises(InputError, match=r"bend 0 must be positive and finite \[Pa\]"):
        Lubricant(0.2, viscosity_law="two_slopes", bend=0, density_law="incompressible")


def test_a_viscosity_law_in_a_scene(outside):
    """Beside the law's key or in its table, in any unit; written and read again; in the schema."""
    text = FILM + 'viscosity_law = "two_slopes"\nbend = "0.1 GPa"\n'
    scene = load_scene(tomllib.loads(text))
    assert scene.oil.viscosity_law == outside.TwoSlopes(bend=1e8)
    again = load_scene(tomllib.loads(dump_scene(scene)), ['oil.bend="200 MPa"'])
    assert again.oil.viscosity_law.bend == 2e8
    table = load_scene(tomllib.loads(FILM + 'viscosity_law = { kind = "two_slopes", bend = "1000 bar" }\n'))
    assert table.oil.build() == scene.oil.build()
    oil = scene_schema("film")["$defs"]["OilScene"]["properties"]
    assert "two_slopes" in oil["viscosity_law"]["anyOf"][0]["enum"]
    assert "a pressure" in json.dumps(oil["bend"])
    for wrong, message in (
        ('"two_slops"', r'viscosity_law = "two_slops": not allowed - did you mean "two_slopes"'),
        ('"two_slopes"', "the two_slopes law without bend"),
        ('"two_slopes"\nbend = "1 N"', r'oil.bend = "1 N": is not a pressure'),
        ('{ kind = "two_slopes", bend = "-1 MPa" }', "oil.viscosity_law.bend.*greater than 0"),
        ('{ kind = "two_slopes", bent = "1 MPa" }', 'viscosity_law.bent: unknown key - did you mean "bend"'),
    ):
        with pytest.raises(InputError, match=message) as caught:
            load_scene(tomllib.loads(FILM + f"viscosity_law = {wrong}\n"))
        assert len(caught.value.messages) == 1


def test_a_viscosity_law_through_the_command_line(tmp_path, outside):
    """The bend far above all pressures is Barus; far below, Barus with half the slope gives almost the same film."""
    films = {}
    for name, oil in (
        ("barus", 'viscosity_law = "barus"\n'),
        ("high", 'viscosity_law = "two_slopes"\nbend = "5 GPa"\n'),
        ("low", 'viscosity_law = "two_slopes"\nbend = "1 MPa"\n'),
    ):
        folder = tmp_path / name
        folder.mkdir()
        done = bem_run(folder, FILM + oil, BEM_LAWS=str(tmp_path / "my_laws.py"))
        assert done.returncode == 0, done.stderr
        films[name] = json.loads((folder / "out" / "summary.json").read_text())["thinnest_film_nm"]
        assert ("bend" in (folder / "out" / "scene.toml").read_text()) == (name != "barus")
    assert films["high"] == pytest.approx(films["barus"], rel=1e-12)
    assert films["low"] < 0.95 * films["barus"]


def test_a_wear_criterion_from_a_scene_is_a_higher_strength(tmp_path, outside):
    """Over a threshold of 0.2 GPa at a strength of 0.6 GPa yields what von Mises yields at 0.8 GPa."""
    found = []
    for strength, criterion in (
        ("0.6 GPa", '{ kind = "over_stress", threshold = "0.2 GPa" }'),
        ("0.8 GPa", '"von_mises"'),
        ("0.6 GPa", '"von_mises"'),
    ):
        folder = tmp_path / str(len(found))
        folder.mkdir()
        soft = f'lower.material={{ catalogue = "steel-disk", yield_stress = "{strength}" }}'
        settings = (soft, f"wear.criterion={criterion}", "cycles.count=2", "cycles.settled=2")
        done = bem_run(folder, WEAR, settings=settings, BEM_LAWS=str(tmp_path / "my_laws.py"))
        assert done.returncode == 0, done.stderr
        found.append(json.loads((folder / "out" / "summary.json").read_text()))
    ours, same, weaker = ((one["particles_per_cycle"], one["particle_thickness_nm"]) for one in found)
    assert ours[0] == same[0] > 0
    # boundaries lie where interpolated stress crosses the strength: the same but for round-off of the two sums
    assert ours[1] == pytest.approx(same[1], rel=1e-6)
    assert weaker != same


def test_a_wear_criterion_in_python(outside):
    from bem.wear import WearModel

    model = WearModel(criterion=outside.OverStress(threshold=1e8))
    assert model.criterion_law.equivalent_stress(np.array([3e8, 0, 0, 0, 0, 0])) == pytest.approx(2e8)
    assert WearModel(criterion={"kind": "over_stress", "threshold": 1e8}) == model
    with pytest.raises(InputError, match="over_stres' is unknown - did you mean 'over_stress'"):
        WearModel(criterion="over_stres")


def test_a_law_of_growth_and_a_hardness_in_a_scene():
    """Built as tables with units; the plan asks the laws for bounds that they do not give themselves."""
    from bem.scenes import library
    from bem.scenes.kind import get_kind
    from bem.tribofilm import GrowthLaw, PropertyLaw

    @dataclass(frozen=True)
    class Steady(GrowthLaw):
        """The same at any stress."""

        name: ClassVar[str] = "steady"
        speed: float = parameter("of growth", "m/s", above=0)

        def rate(self, shear_stress, temperature):
            return np.full_like(shear_stress, self.speed)

    @dataclass(frozen=True)
    class Ramp(PropertyLaw):
        """Linear in thickness up to an end."""

        name: ClassVar[str] = "ramp"
        start: float = parameter("without a film", "Pa", above=0)
        end: float = parameter("of a thick film", "Pa", above=0)
        length: float = parameter("from which it is thick", "m", above=0)

        def __call__(self, thickness, temperature):
            return self.start + (self.end - self.start) * min(thickness / self.length, 1.0)

    data = library()["tribofilm-afm-tip"]
    film = {key: value for key, value in data["film"].items() if not key.startswith(("activation", "prefactor"))}
    film |= {
        "growth": {"kind": "steady", "speed": "2 nm/min"},
        "hardness": {"kind": "ramp", "start": "6 GPa", "end": "2 GPa", "length": "20 nm"},
    }
    change = {"variants": []}
    try:
        bem.register(Steady)
        bem.register(Ramp)
        scene = load_scene(data | change | {"film": film})
        assert scene.film.kinetics().speed == pytest.approx(2e-9 / 60, rel=1e-6, abs=0)
        assert scene.film.hardness.lowest(5e-8, 300.0) == 2e9
        assert scene.film.hardness.highest(300.0) == 6e9
        assert get_kind("tribofilm").model.model_validate(scene.model_dump()) == scene
        with pytest.raises(InputError, match="growth with activation_energy"):
            load_scene(data | change | {"film": film | {"activation_energy": "0.8 eV"}})
        with pytest.raises(InputError, match="no activation_energy and activation_volume"):
            load_scene(data | change | {"film": {key: value for key, value in film.items() if key != "growth"}})
    finally:
        laws.unregister(Steady)
        laws.unregister(Ramp)


def test_an_installed_package_registers_by_its_entry_point(tmp_path):
    (tmp_path / "my_laws.py").write_text(OUTSIDE)
    (tmp_path / "my_laws-1.0.dist-info").mkdir()
    (tmp_path / "my_laws-1.0.dist-info" / "METADATA").write_text("Metadata-Version: 2.1\nName: my-laws\nVersion: 1.0\n")
    (tmp_path / "my_laws-1.0.dist-info" / "entry_points.txt").write_text("[bem.laws]\nmine = my_laws\n")
    code = "import bem; print(bem.Lubricant(0.2, viscosity_law='two_slopes', bend=1e8).viscosity_law)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False,
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
    )  # fmt: skip
    assert done.stdout.strip() == "TwoSlopes(bend=100000000.0)", done.stderr


@pytest.mark.parametrize("content", [None, "1/0"])
def test_a_file_that_cannot_be_loaded_is_named(tmp_path, content):
    if content is not None:
        (tmp_path / "bad.py").write_text(content)
    done = bem_run(tmp_path, FILM, BEM_LAWS=str(tmp_path / "bad.py"))
    assert done.returncode == 2
    assert "extensions from BEM_LAWS=" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


def test_what_is_no_law_is_refused():
    class NotFrozen(ViscosityLaw):
        name: ClassVar[str] = "not_frozen"

    @dataclass(frozen=True)
    class Taken(ViscosityLaw):
        name: ClassVar[str] = "barus"

    @dataclass(frozen=True)
    class Strange(ViscosityLaw):
        name: ClassVar[str] = "Not a name"

    @dataclass(frozen=True)
    class Empty(ViscosityLaw):
        name: ClassVar[str] = "empty"

    for wrong, message in (
        (NotFrozen, "frozen dataclass"),
        (Empty, "Empty does not define log_viscosity_ratio, which every viscosity_law needs"),
        (Taken, "'barus' is taken by bem.lubrication.viscosity.Barus"),
        (Strange, "lower-case"),
        (dict, "does not derive"),
        (3, "does not derive"),
    ):
        with pytest.raises(InputError, match=message):
            bem.register(wrong)


def test_one_name_is_one_unit():
    from bem.lubrication.shear import ShearLaw

    @dataclass(frozen=True, kw_only=True)
    class Other(ShearLaw):
        name: ClassVar[str] = "other"
        shear_stress_limit: float = parameter("a share", above=0)

    with pytest.raises(InputError, match=r"shear_stress_limit is in \[\], but \w+ has it in \[Pa\]"):
        bem.register(Other)


def test_every_law_says_what_it_is_and_where_it_comes_from():
    for family in laws.FAMILIES:
        for name, law in laws.laws_of(family).items():
            assert law.__doc__, (family, name)
            assert all(about.meaning for about in law.parameters().values()), (family, name)
