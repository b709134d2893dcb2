"""Plan of a case of kind `rolling`."""

from __future__ import annotations

from bem.grid import Grid
from bem.kinds.rolling.scene import RollingContactScene
from bem.scenes import build, plans, sticking
from bem.scenes.planner import Plan, Step

_TRANSFORMS_OF_CELL = 6.0 * 2.8
"""Transforms for each cell along the rolling: 2 to 3 convolutions were counted from 32 to 256 cells, each of four
transforms and vector passes."""

_TRANSFORMS_OF_STEP = 6.0 * 20
"""Transforms of a step of a history: 14 to 20 convolutions were counted."""

_CURVED_PRODUCTS = 1000
"""Products with the matrices of a curved surface, of pressures and tractions in four to six turns."""


def plan(scene: RollingContactScene) -> Plan:
    """Plan the computation of one case.

    Raises
    ------
    InputError : surfaces that cannot be generated on the grid.
    """
    if scene.shape.conforming:
        return _plan_on_curved_rail(scene)
    history = scene.history

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "rolling",
                f"transient, {history.steps(grid.spacing[0])} steps of a cell, "
                f"{sticking.friction_words(scene.roll.friction)}"
                if history is not None
                else f"steady along x, {sticking.friction_words(scene.roll.friction)}",
                transforms=_TRANSFORMS_OF_CELL * max(grid.shape[0], 40)
                if history is None
                else _TRANSFORMS_OF_STEP * history.steps(grid.spacing[0]),
                points=points,
                # directions that GMRES keeps, on the cells in contact
                memory=8.0 * points * 6 + 8.0 * grid.cells * 2 * 62,
                kept=8.0 * grid.cells * 10,
                seconds=0.05,
            ),
        )

    return sticking.plan_around(scene, steps, 0.5)


def _plan_on_curved_rail(scene: RollingContactScene) -> Plan:
    """Plan rolling on a curved surface: ny^2 numbers for each wavenumber along x and each of five kernels."""
    grid = build.grid_of(scene.grid)
    matrices = (grid.shape[0] + 1) * grid.shape[1] ** 2

    def seconds(cells: float) -> float:
        return cells * (1e-6 + 1e-8 * _CURVED_PRODUCTS)

    return Plan.of(
        *plans.of_bodies(scene, grid, 1.0),
        Step(
            "rolling",
            f"steady along x, {sticking.friction_words(scene.roll.friction)}, {scene.contact.words()}; on the curved "
            f"surface of the rail, about {_CURVED_PRODUCTS} products with its matrices",
            memory=8.0 * matrices * 8,
            seconds=seconds(matrices),
            kept=8.0 * grid.cells * 10,
        ),
        plans.error_bars(
            scene.outputs.errors,
            "the same on the grid of twice the cell",
            memory=8.0 * matrices,
            seconds=seconds(matrices / 8),
        ),
        plans.figures(grid.cells),
    )
