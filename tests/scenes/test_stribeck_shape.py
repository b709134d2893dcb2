"""Curves that a user sees first have the shape of a Stribeck curve: boundary lubrication, a minimum, full film."""

import copy
import tomllib
from importlib.resources import files

import numpy as np
import pytest

from bem.friction.solve import solve_setup
from bem.kinds.friction.scene import resolve
from bem.scenes import build, load_scene
from bem.scenes.load import library

COARSE = {"grid": {"shape": 64, "lengths": "240 um"}, "film": {"cells": 48}}


def built_in():
    return dict(library()["stribeck-ball-on-disc"])


def template():
    return tomllib.loads(files("bem.kinds.friction").joinpath("basic.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize("table", [built_in, template])
def test_friction_falls_from_the_boundary_to_the_film(table):
    scene = resolve(load_scene(copy.deepcopy(table()) | COARSE))
    height = build.heights_of(scene.lower.surface, build.grid_of(scene.grid), 1, lambda text: None)
    setup, points = scene.curve_setup("off"), []
    for speeds in list(scene.speeds.build())[::2]:
        points.append(solve_setup(setup, height, speeds, points[-1] if points else None))
    friction, ratio = (np.array([getattr(p, name) for p in points]) for name in ("friction", "lambda_ratio"))
    assert [p.status.value for p in points] == ["converged"] * len(points)
    assert friction[0] > 0.09
    assert friction[0] > 0.75 * scene.contact.boundary_friction
    least = int(friction.argmin())
    assert 0.7 < ratio[least] < 4
    assert (np.diff(friction[: least + 1]) < 0).all()
    film = friction[ratio > 1]
    assert film.size >= 1
    assert film.max() < min(0.05, 0.6 * friction[0])
