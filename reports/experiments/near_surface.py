"""What a pressure that is constant on cells leaves of the stresses next to the surface, and what a bilinear one would.

    python -m reports.experiments.near_surface

Hertz' pressure at the centres of cells, as constant on them and as bilinear between them (made of cells of a twelfth),
against Hamilton's stresses with and without friction, at the centres of the cells. Largest differences of the von Mises
stress over the largest pressure, within 0.7 of the contact's radius and anywhere. The result is stored in
`reports/results/near_surface.json`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material
from bem.reference_solutions.hamilton import sphere_stress
from bem.stress import von_mises, von_mises_field

RESULT = Path(__file__).resolve().parents[1] / "results" / "near_surface.json"
BODY = Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.3))
PARTS = 12
DEPTHS = (0.125, 0.25, 0.5, 1.0, 2.0)
"""In cells."""


def rows_of(radius: int, friction: float) -> list[dict[str, Any]]:
    """Errors at each depth, of a contact of so many cells in radius."""
    rng, cells = np.random.default_rng(3), 2 * radius + 8
    shift = rng.uniform(-0.5, 0.5, 2)
    coarse, fine = Grid((cells, cells), (1.0, 1.0)), Grid((cells * PARTS,) * 2, (1 / PARTS,) * 2)
    x, y = np.broadcast_arrays(coarse.x[:, None] - shift[0], coarse.y[None, :] - shift[1])
    pressure = np.sqrt(np.maximum(1 - (x**2 + y**2) / radius**2, 0))
    # hats over two cells, at the centres of parts
    hats = np.maximum(1 - np.abs(fine.x[:, None] - coarse.x[None, :]), 0)
    # an odd offset puts the coarse centres between parts: fields are means of the parts around them
    bilinear = hats @ pressure @ hats.T
    rows = []
    for depth in DEPTHS:
        stress = sphere_stress(
            x, y, depth, contact_radius=radius, maximum_pressure=1.0, poissons_ratio=0.3, friction=friction
        )
        exact = von_mises(stress)
        constant = von_mises_field(pressure, coarse, BODY, [depth], friction=friction)[0]
        parts = von_mises_field(bilinear, fine, BODY, [depth], friction=friction)[0]
        half = PARTS // 2
        corners = [parts[half - i :: PARTS, half - j :: PARTS][:cells, :cells] for i in (0, 1) for j in (0, 1)]
        core = x**2 + y**2 < (0.7 * radius) ** 2
        row: dict[str, Any] = {"radius": radius, "friction": friction, "depth": depth}
        for name, found in (("constant", constant), ("bilinear", np.mean(corners, axis=0))):
            error = np.abs(found - exact)
            row |= {f"{name}_inside": float(error[core].max()), f"{name}_anywhere": float(error.max())}
        rows.append(row)
    return rows


def main() -> None:
    """Print and store."""
    rows = [row for friction in (0.0, 0.3) for radius in (8, 16) for row in rows_of(radius, friction)]
    for row in rows:
        print({key: round(value, 4) for key, value in row.items()})
    RESULT.write_text(json.dumps({"rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
