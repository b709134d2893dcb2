"""The hierarchical elastic operator and Newton's equations on it, against dense matrices and quadrature."""

import dataclasses

import mpmath
import numpy as np
import pytest

import bem.lubrication.line.deflection as line_kernel
import bem.lubrication.line.linear as line_linear
import bem.lubrication.line.newton as line_newton
from bem import solve_line_film
from bem.lubrication.line.deflection import LineOperator, logarithmic_integral, logarithmic_weights
from bem.lubrication.line.linear import factorise, film_terms
from reports.benchmarks.line_film import similarity_case


def graded(cells):
    return np.concatenate([-np.geomspace(2500, 10, cells // 5), np.linspace(-10, 0, cells - cells // 5 + 1)[1:]])


@pytest.mark.internal
@pytest.mark.parametrize(("target", "node"), [(5, 300), (399, 3), (200, 201), (200, 213), (0, 399), (20, 0), (7, 7)])
def test_weights_are_integrals_of_hats(target, node):
    """Two primitives of ln|t| in 40 digits; distances up to 1e5 cells, where second differences cancel in doubles."""
    x = graded(400)
    weight = logarithmic_weights(x, x)[target, node]
    with mpmath.workdps(40):

        def first(t):
            return t * (mpmath.log(abs(t)) - 1) if t else mpmath.mpf(0)

        def second(t):
            return t * t * (mpmath.log(abs(t)) / 2 - mpmath.mpf(3) / 4) if t else mpmath.mpf(0)

        nodes = [mpmath.mpf(float(v)) for v in x]
        t = nodes[target] - nodes[node]
        exact = mpmath.mpf(0)
        if node < len(x) - 1:
            h = nodes[node + 1] - nodes[node]
            exact += (second(t - h) - second(t)) / h + first(t)
        if node > 0:
            h = nodes[node] - nodes[node - 1]
            exact -= (second(t) - second(t + h)) / h + first(t)
    # rounding of a sum of a few terms; the near formula cancels (12 cells)^2 of it
    assert weight == pytest.approx(float(exact), rel=1e-13)


@pytest.mark.internal
@pytest.mark.parametrize("cells", [1, 64, 65, 1999])
def test_groups_of_cells_are_seen_as_all_their_hats(cells):
    nodes = graded(2000)[-cells - 1 :]
    reach = nodes[-1] - nodes[0]
    targets = np.concatenate([nodes[0] - reach * np.geomspace(1e-6, 10, 40), reach * np.geomspace(1e-9, 10, 60), nodes])
    pressure = np.random.default_rng(0).random(len(nodes))
    wanted = logarithmic_weights(targets, nodes) @ pressure
    # rounding of sums of two thousand terms
    np.testing.assert_allclose(
        logarithmic_integral(targets, nodes, pressure), wanted, rtol=0, atol=1e-13 * np.abs(wanted).max()
    )


@pytest.mark.internal
@pytest.mark.parametrize("cells", [301, 777, 2000, 2059])
def test_hierarchical_product_is_the_dense_one(cells):
    operator = LineOperator.of(graded(cells))
    assert operator.hierarchical
    pressure = np.random.default_rng(0).random(cells + (len(operator.nodes) - cells))
    dense = operator.dense @ pressure
    # the cross approximation's tolerance is 1e-11 of a block
    np.testing.assert_allclose(operator @ pressure, dense, rtol=0, atol=1e-10 * np.abs(dense).max())
    stretched = LineOperator.of(3.7 * graded(cells))
    np.testing.assert_allclose(operator.rescale(3.7) @ pressure, stretched @ pressure, rtol=1e-9)


@pytest.mark.internal
def test_no_leaf_is_empty():
    """Equal leaves: of 2058 nodes, 64 leaves of 33 would leave nothing to the last one."""
    for interior in [*range(299, 2100), *range(2100, 20000, 97), 19998]:
        operator = LineOperator(np.arange(interior + 2.0), 1.0)
        leaves = 2**operator.depth
        assert (leaves - 1) * operator.leaf < interior <= leaves * operator.leaf
        # two or four times the leaf asked for, where equal leaves need it
        assert operator.leaf <= 4 * line_kernel.LEAF


def test_any_allowed_number_of_points_gives_the_film():
    case, _ = similarity_case(3, 2)
    films = [solve_line_film(**case, points=points) for points in (2000, 2060, 8000)]
    for film in films[1:]:
        # second order: 2000 points are off by 3e-6
        assert film.minimum_thickness == pytest.approx(films[0].minimum_thickness, rel=1e-5)


@pytest.mark.internal
@pytest.mark.parametrize(("rough", "allowed"), [(1e-11, 1e-7), (1e-6, 1e-3)])
@pytest.mark.parametrize(
    ("load", "piezo", "density"),
    [
        (0.003, 5, "incompressible"),
        (10, 20, "incompressible"),
        (3000, 0, "incompressible"),
        (100, 10, "dowson_higginson"),
    ],
)
def test_hierarchical_newton_steps_are_the_dense_ones(monkeypatch, load, piezo, density, rough, allowed):
    compared = []
    plain = line_newton.solve_newton_step

    def both(operator, equations):
        if operator.hierarchical:
            right = equations.right.copy()
            right[:-1] += film_terms(equations, equations.mismatch)
            one = factorise(operator, equations).solve(right)
            other = line_linear._solve_dense(operator, equations, right)
            compared.append(float(np.abs(one - other).max() / np.abs(other).max()))
        return plain(operator, equations)

    monkeypatch.setattr(line_newton, "solve_newton_step", both)
    monkeypatch.setattr(line_kernel, "NEWTON_CROSS_TOLERANCE", rough)
    case, _ = similarity_case(load, piezo)
    oil = dataclasses.replace(case["lubricant"])
    oil = type(oil)(oil.viscosity, pressure_viscosity=oil.pressure_viscosity, density_law=density)
    solve_line_film(**{**case, "lubricant": oil}, points=701)
    assert compared
    # conditioned a few thousand times worse than the cross approximation; Newton's method does not notice 1e-3
    assert max(compared) < allowed


@pytest.mark.internal
def test_dense_equations_stand_in_where_the_hierarchical_ones_fail(monkeypatch):
    case, _ = similarity_case(3, 2)
    monkeypatch.setattr(line_newton, "CHORDS", -1)  # of hierarchical equations alone
    right = solve_line_film(**case, points=401)
    monkeypatch.setattr(line_linear.BorderedFactors, "solve", lambda factors, right: np.zeros_like(right))
    film = solve_line_film(**case, points=401)
    assert film.iterations == right.iterations
    assert film.minimum_thickness == pytest.approx(right.minimum_thickness, rel=1e-9)  # rounding, conditioned


@pytest.mark.internal
def test_last_steps_are_chord_steps(monkeypatch):
    """The same film; its last steps take the factored equations of an earlier step."""
    case, _ = similarity_case(10, 5)
    taken = []
    plain = line_linear.factorise

    def counted(operator, equations):
        taken.append(len(operator.nodes))
        return plain(operator, equations)

    monkeypatch.setattr(line_linear, "factorise", counted)

    def films():
        first = solve_line_film(**case, points=2000)
        taken.clear()
        other = solve_line_film(**{**case, "load": 1.001 * case["load"]}, points=2000, initial=first)
        return first, other, taken.count(2000)

    first, other, few = films()
    monkeypatch.setattr(line_newton, "CHORDS", -1)
    first_plain, other_plain, many = films()
    assert (few, many) == (1, 2)
    assert (other.iterations, other_plain.iterations) == (3, 2)
    for one, wanted in ((first, first_plain), (other, other_plain)):
        assert one.residual <= 1e-8  # the tolerance
        np.testing.assert_allclose(one.thickness, wanted.thickness, rtol=1e-7)
