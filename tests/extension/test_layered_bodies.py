"""From outside the package: a body under two layers, from Python and from a scene through `bem run`."""

import json
import sys

import pytest

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact, subsurface_stress, von_mises
from bem.cli import main

SCENE = """
kind = "contact"

[lower]
material = "steel-52100"

[[lower.layers]]
material = "dlc"
thickness = "2 um"

[[lower.layers]]
material = {name = "chromium", youngs_modulus = "279 GPa", poissons_ratio = 0.21}
thickness = "500 nm"

[grid]
shape = 24
spacing = "4 um"

[shape]
kind = "sphere"
radius = "10 mm"

[contact]
load = "4 N"
friction = 0.1

[outputs]
von_mises = true
depths = ["1 um", "2 um", "2.4 um", "3 um", "10 um"]
"""


def bem(monkeypatch, *arguments):
    """Exit code of the command line."""
    monkeypatch.setattr(sys, "argv", ["bem", *arguments])
    with pytest.raises(SystemExit) as end:
        main()
    return end.value.code or 0


def material(name, modulus, ratio):
    return Material(name, youngs_modulus=modulus, poissons_ratio=ratio)


def test_from_python_and_from_a_scene(tmp_path, monkeypatch):
    """The same contact in both ways; its stresses at depths in both layers and below."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.toml").write_text(SCENE)
    assert bem(monkeypatch, "run", "two.toml", "--out", "run") == 0
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["status"] == "converged"
    assert "chromium" in (tmp_path / "run" / "scene.toml").read_text()

    steel = material("steel", 207e9, 0.3)
    layers = (Layer(material("dlc", 200e9, 0.25), 2e-6), Layer(material("chromium", 279e9, 0.21), 500e-9))
    body = Body(steel, layers=layers)
    grid = Grid((24, 24), (4e-6, 4e-6))
    gap = (grid.x[:, None] ** 2 + grid.y**2) / 20e-3
    solution = solve_contact(gap, displacement_operator(grid, body, friction=0.1), load=4.0)
    depths = [1e-6, 2e-6, 2.4e-6, 3e-6, 10e-6]
    stress = von_mises(subsurface_stress(solution.pressure, grid, body, depths, friction=0.1))
    # both to the solver's tolerance of 1e-8
    assert summary["approach_m"] == pytest.approx(solution.approach, rel=1e-6)
    assert summary["max_von_mises_of_points_Pa"] == pytest.approx(stress.max(), rel=1e-5)
    # the order of the layers matters: a stiffer, thicker one outermost gives in less
    swapped = solve_contact(gap, displacement_operator(grid, Body(steel, layers=layers[::-1]), friction=0.1), load=4.0)
    bare = solve_contact(gap, displacement_operator(grid, Body(steel), friction=0.1), load=4.0)
    assert len({f"{s.approach:.6e}" for s in (solution, swapped, bare)}) == 3
    assert abs(solution.approach / bare.approach - 1) < 0.1  # thin: not far from steel


def test_the_plan_names_the_layers(tmp_path, monkeypatch, capsys):
    (tmp_path / "two.toml").write_text(SCENE)
    assert bem(monkeypatch, "plan", str(tmp_path / "two.toml")) == 0
    assert "2 layers (dlc 2 um, chromium 0.5 um) on the lower body" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (('material = "dlc"\nthickness = "2 um"', 'material = "dlc"\nthickness = "0 um"'), "lower.layers"),
        (('material = "dlc"\n', 'material = "dlcc"\n'), "dlc"),
        (('[[lower.layers]]\nmaterial = "dlc"', '[lower.layer]\nmaterial = "dlc"'), "layer and layers are both given"),
    ],
)
def test_a_bad_layer_is_named_and_nothing_is_written(tmp_path, monkeypatch, capsys, change, named):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.toml").write_text(SCENE.replace(*change))
    assert bem(monkeypatch, "run", "two.toml", "--out", "run") == 2
    assert named in capsys.readouterr().err
    assert not (tmp_path / "run").exists()
