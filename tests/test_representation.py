"""What results look like at a prompt and in a notebook."""

import dataclasses

import numpy as np
import pytest

import bem
from bem import Body, ContactSolution, Grid, Lubricant, Material, Status, displacement_operator, solve_contact
from bem.representation import readable

STEEL = Material("steel <1>", youngs_modulus=210e9, poissons_ratio=0.3)


@pytest.fixture(scope="module")
def solution():
    grid = Grid((16, 16), (1e-6, 1e-6))
    gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 2e-2
    return solve_contact(gap, displacement_operator(grid, Body(STEEL)), load=1e-3)


def test_arrays_show_as_shape_and_range(solution):
    text = repr(solution)
    assert isinstance(solution, ContactSolution)
    assert f"pressure=<16x16 array, 0 to {solution.pressure.max():.4g}>" in text
    assert "status='converged'" in text
    assert "load=0.001" in text
    assert len(text) < 800
    assert "array(" not in text
    assert "<td>approach</td>" in solution._repr_html_()


def test_film_shows_without_its_state():
    film = bem.solve_line_film(
        load=1e5, radius=2e-3, contact_modulus=115e9, speeds=(0.1, 0.0), points=400,
        lubricant=Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
    )  # fmt: skip
    text = repr(film)
    assert "minimum_thickness=" in text
    assert "array(" not in text
    assert "state" not in text
    assert len(text) < 1200  # a line for each of 24 fields and a note; one shown array would be longer


def test_inputs_show_in_full_and_in_notebooks_as_tables():
    grid = Grid((4, 5), (1e-6, 2e-6), periodic=(True, False))
    assert eval(repr(grid)) == grid
    assert eval(repr(STEEL)) == STEEL
    assert "<td>(4, 5)</td>" in grid._repr_html_()
    assert "steel &lt;1&gt;" in STEEL._repr_html_()


def test_every_public_result_is_short():
    """No public dataclass dumps its arrays: each has a repr of its own, or holds no arrays."""
    for name in bem.__all__:
        found = getattr(bem, name)
        if not (isinstance(found, type) and dataclasses.is_dataclass(found)):
            continue
        arrays = [f for f in dataclasses.fields(found) if "Array" in str(f.type) and f.repr]
        assert not arrays or "_repr_html_" in vars(found), name


@pytest.mark.internal
def test_odd_values():
    @readable
    @dataclasses.dataclass
    class Odd:
        empty: object
        table: object
        status: Status
        many: list
        text: str

    shown = repr(Odd(np.zeros((0, 3)), np.zeros(3, [("a", float)]), Status.STALLED, list(range(9)), "x" * 500))
    assert "<0x3 array>" in shown
    assert "<3 array>" in shown
    assert "'stalled'" in shown
    assert "<9 list entries>" in shown
    assert len(shown) < 300
