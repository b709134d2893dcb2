"""Graded grids: numbers, nesting, tags, determinism."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes import describe, gmsh_model
from meshes.grids import (
    CELL_TAGS,
    FACET_TAGS,
    REACH,
    WIDER,
    graded,
    half_space_grid,
    harmonic_grid,
    layer_names,
    moving_band_grid,
    progression,
    rectangle_grid,
)

pytest.importorskip("gmsh")


def built(builder):
    """Node coordinates, cells by tag, facet tags of a mesh."""
    with gmsh_model("test") as model:
        builder.build(model)
        tags, coordinates, _ = model.mesh.getNodes()
        groups = {}
        for dimension, tag in model.getPhysicalGroups():
            nodes, cells = 0, 0
            for entity in model.getEntitiesForPhysicalGroup(dimension, tag):
                types, elements, _ = model.mesh.getElements(dimension, entity)
                cells += sum(len(e) for e in elements)
                nodes += len(types)
            groups[dimension, tag] = cells
        total = sum(len(e) for e in model.mesh.getElements(builder.dimension)[1])
        return np.sort(tags), coordinates.reshape(-1, 3)[np.argsort(tags)], groups, total


@settings(deadline=None, max_examples=80)
@given(
    first=st.floats(1e-4, 0.5),
    growth=st.floats(1.1, 4.0),
    length=st.floats(0.01, 1e4),
    fine_at_end=st.booleans(),
)
def test_graded_intervals_nest_and_grow(first, growth, length, fine_at_end):
    coarse = graded(1.0, 1.0 + length, first, growth, 1, fine_at_end=fine_at_end)
    fine = graded(1.0, 1.0 + length, first, growth, 3, fine_at_end=fine_at_end)
    nodes, finer = np.array(coarse.nodes()), np.array(fine.nodes())
    assert fine.cells == 3 * coarse.cells
    # each coarse node is a fine one; round-off of powers
    np.testing.assert_allclose(finer[::3], nodes, atol=1e-9 * length)
    sizes = np.diff(nodes)
    assert np.all(sizes > 0)
    if coarse.cells > 1:
        smallest = sizes[-1] if fine_at_end else sizes[0]
        assert smallest == pytest.approx(first, rel=1e-6)


def test_progression_nests():
    coarse, fine = progression(0.0, 1.0, 3, 50.0), progression(0.0, 1.0, 6, 50.0)
    np.testing.assert_allclose(np.array(fine.nodes())[::2], coarse.nodes(), atol=1e-14)


def test_a_wrong_interval_is_refused():
    with pytest.raises(ValueError, match="growth 1"):
        graded(0.0, 1.0, 0.1, 1.0, 1)


@pytest.mark.parametrize(
    "builder",
    [
        half_space_grid(thickness=None, level=1),
        half_space_grid(thickness=0.1, level=2),
        half_space_grid(thickness=5.0, level=1, boxes=1),
        harmonic_grid(thickness=0.01, level=1),
        harmonic_grid(thickness=1.5, level=1),
        harmonic_grid(thickness=None, level=1),
        half_space_grid(thickness=(0.3, 0.1), level=1),
        harmonic_grid(thickness=(0.5, 0.1, 0.2), level=1),
        rectangle_grid(half_length=1.0, half_width=0.5, level=2),
        moving_band_grid(peclet=10.0, level=1),
    ],
    ids=lambda builder: type(builder).__name__,
)
def test_a_mesh_is_whole_tagged_and_always_the_same(builder):
    tags, points, groups, total = built(builder)
    np.testing.assert_array_equal(tags, np.arange(1, len(tags) + 1))  # no gaps: dolfinx needs that
    axes = [builder.x, builder.z] if builder.dimension == 2 else [builder.x, builder.y, builder.z]
    assert total == np.prod([sum(interval.cells for interval in axis) for axis in axes])
    assert sum(count for (dimension, _), count in groups.items() if dimension == builder.dimension) == total
    stack = builder.layers if isinstance(builder.layers, tuple) else (1,) * (builder.layers > 0)
    for name in layer_names(4):
        assert ((builder.dimension, CELL_TAGS[name]) in groups) == (name in layer_names(len(stack)))
    assert groups[builder.dimension - 1, FACET_TAGS["loaded"]] > 0
    # the nodes lie where the intervals say; gmsh integrates the progression along the line to about 1e-6
    for axis, column in zip(axes, points.T, strict=False):
        nodes = np.unique([node for interval in axis for node in interval.nodes()])
        nearest = np.min(np.abs(column[:, None] - nodes), axis=1)
        assert np.all(nearest <= 1e-5 * np.maximum(np.abs(column), np.diff(nodes).min()))
    again = built(builder)
    np.testing.assert_array_equal(points, again[1])


@pytest.mark.parametrize(
    ("at_level", "levels"),
    [
        (lambda level: half_space_grid(thickness=0.3, level=level), (1, 2, 3)),
        (lambda level: half_space_grid(thickness=(0.3, 0.1), level=level), (1, 2, 3)),
        (lambda level: harmonic_grid(thickness=0.5, level=level), (1, 2, 3)),
        (lambda level: moving_band_grid(peclet=300.0, level=level), (1, 2, 3)),
        (lambda level: rectangle_grid(half_length=1.0, half_width=0.5, level=level), (2, 3, 4)),
        (lambda level: rectangle_grid(half_length=1.0, half_width=0.5, level=level, thickness=0.9), (2, 3, 4)),
    ],
    ids=["half-space", "stack", "harmonic", "moving band", "rectangle", "rectangle on a layer"],
)
def test_every_part_of_a_mesh_is_finer_at_the_next_level(at_level, levels):
    """Error bars come from the difference of meshes: where two are alike in a layer, the bar there is blind."""
    for coarse, fine in itertools.pairwise(levels):
        grids = at_level(coarse), at_level(fine)
        for axis in ("x", "y", "z"):
            if hasattr(grids[0], axis):
                parts = zip(getattr(grids[0], axis), getattr(grids[1], axis), strict=True)
                assert all(a.cells < b.cells for a, b in parts), (coarse, fine, axis)


@pytest.mark.parametrize(("thickness", "half_width"), [(2.86, 0.375), (1.0, 0.25), (3.0, 1.0)])
def test_cells_of_a_thick_layer_are_no_taller_than_the_load_is_wide(thickness, half_width):
    """Equal cells, 0.72 tall on the finest mesh under a load 0.75 wide, left displacements 2 % off."""
    grid = rectangle_grid(half_length=1.0, half_width=half_width, level=4, thickness=thickness)
    heights = np.diff(grid.z[0].nodes())
    assert heights[0] < half_width / 2
    assert np.all(np.diff(heights) > 0)
    assert heights[-1] < 0.3 * thickness  # at the interface nearly as low as the equal ones that resolve it


def test_a_layer_as_thin_as_the_load_is_wide_has_equal_cells():
    grid = rectangle_grid(half_length=1.0, half_width=0.5, level=4, thickness=0.5)
    np.testing.assert_allclose(np.diff(grid.z[0].nodes()), 0.125, rtol=1e-12)


def test_wider_boxes_leave_the_mesh_inside_alone():
    narrow, wide = (half_space_grid(thickness=0.3, level=2, boxes=n) for n in (0, 2))
    assert wide.x[: len(narrow.x)] == narrow.x
    assert wide.z[: len(narrow.z)] == narrow.z
    assert narrow.x[-1].end == REACH
    assert wide.x[-1].end == REACH * WIDER**2


def test_a_builder_describes_itself():
    entry = describe(half_space_grid(thickness=0.3, level=1))
    assert entry["builder"] == "meshes.grids.PlaneGrid"
    assert tuple(entry["parameters"]["layers"]) == (1,)
