"""Where the discrete contact puts its edge: fits the constants of `bem.contact.edge` anew, in some three minutes.

    python -m reports.experiments.contact_edge

Contacts of known edge are solved with many cells across; each link between a cell in contact and one outside gives the
ratio q of gap and pressure, the cosine n of link and normal, and where the edge crosses it. What the contact's own size
adds (in proportion to a cell over the contact's radius) is fitted too and left out of the constants.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from bem import Body, ContactSolution, Grid, Material, displacement_operator, solve_contact

UNIT = Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)
DIRECTIONS = (
    (1, 0),
    (2, 1),
    (3, 1),
    (3, 2),
    (1, 1),
    (4, 1),
    (4, 3),
    (5, 1),
    (5, 2),
    (5, 3),
    (5, 4),
    (6, 1),
    (6, 5),
    (7, 2),
    (7, 4),
)
LEAST = 0.2
TERMS = 4


def links(
    solution: ContactSolution,
    axis: int,
    cosine: NDArray[np.float64],
    distance: NDArray[np.float64],
    inverse: float,
    spacing: float,
) -> NDArray[np.float64]:
    """Rows (n, q n, place, cell over size) of all links along an axis; `distance` to the edge along it, from the cell
    inside, in cells."""
    inside = solution.pressure > 0
    cut = (inside != np.roll(inside, -1, axis)) & (cosine > LEAST)
    pressure = np.where(inside, solution.pressure, np.roll(solution.pressure, -1, axis))[cut]
    gap = np.where(inside, np.roll(solution.gap, -1, axis), solution.gap)[cut]
    place = np.where(inside, distance, np.roll(distance, -1, axis))[cut]
    return np.column_stack([cosine[cut], 0.75 * gap / (pressure * spacing), place, np.full(place.size, inverse)])


def balls() -> NDArray[np.float64]:
    """Hertz' contact on a free grid: pressures constant on cells."""
    rng, rows = np.random.default_rng(0), []
    for radius, repetitions in ((30, 8), (60, 5), (120, 3)):
        grid = Grid((int(2.6 * radius),) * 2, (1.0, 1.0))
        operator = displacement_operator(grid, Body(UNIT))
        for _ in range(repetitions):
            x, y = np.meshgrid(grid.x - rng.uniform(-0.5, 0.5), grid.y - rng.uniform(-0.5, 0.5), indexing="ij")
            size, curvature = radius * rng.uniform(0.98, 1.02), 1e-3 / radius
            solution = solve_contact(0.5 * curvature * (x**2 + y**2), operator, load=4 / 3 * size**3 * curvature)
            for axis, (along, beside) in enumerate(((x, y), (y, x))):
                chord = np.sqrt(np.maximum(size**2 - beside**2, 0))
                inside = solution.pressure > 0
                distance = chord - np.where(inside & (along < 0) & np.roll(~inside, -1, axis), along, np.abs(along))
                rows.append(links(solution, axis, chord / size, distance, 1 / size, 1.0))
    return np.concatenate(rows)


def wavy() -> NDArray[np.float64]:
    """Westergaard's contact on a periodic grid, in many directions: pressures as waves."""
    cells = 384
    grid = Grid((cells, cells), (1 / cells, 1 / cells), periodic=(True, True))
    operator = displacement_operator(grid, Body(UNIT))
    rng, rows = np.random.default_rng(1), []
    for direction in DIRECTIONS:
        number = np.hypot(*direction)
        for _ in range(6):
            half_width = rng.uniform(0.15, 0.35) / number
            turns = direction[0] * grid.x[:, None] + direction[1] * grid.y[None, :] + rng.uniform()
            gap = 0.01 / number * (1 - np.cos(2 * np.pi * turns))
            load = 0.01 * np.pi * np.sin(np.pi * half_width * number) ** 2
            solution = solve_contact(gap, operator, load=load, tolerance=1e-9)
            normal = half_width - np.abs((turns + 0.5) % 1 - 0.5) / number
            for axis in range(2):
                cosine = direction[axis] / number
                if cosine > LEAST:
                    field = np.full(grid.shape, cosine)
                    distance = normal * cells / cosine
                    found = links(solution, axis, field, distance, 1 / (half_width * cells), 1 / cells)
                    rows.append(found[rng.permutation(len(found))[:150]])
    return np.concatenate(rows)


def fit(rows: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """a, b and c (3, TERMS) and the rms distance of the crossings from the edge [cells]."""
    cosine, scaled, place, inverse = rows.T
    ratio, powers = scaled / cosine, np.vander(cosine, TERMS)

    def miss(constants: NDArray[np.float64]) -> NDArray[np.float64]:
        a, b, c = (powers @ part for part in constants[: 3 * TERMS].reshape(3, TERMS))
        size = inverse * (constants[-2] + constants[-1] * cosine)
        return np.asarray(((a - b * ratio) / (c + ratio) + size - place) * cosine)

    start = np.zeros(3 * TERMS + 2)
    start[TERMS - 1 : 3 * TERMS : TERMS] = 1.0, 0.1, 1.0
    found = least_squares(miss, start, loss="soft_l1", f_scale=0.02)
    return found.x[: 3 * TERMS].reshape(3, TERMS), float(np.sqrt(np.mean(miss(found.x) ** 2)))


def main() -> None:
    """Print the constants."""
    for name, rows in (("constant on cells", balls()), ("as waves", wavy())):
        constants, rms = fit(rows)
        print(f"pressures {name}: crossings met to {rms:.4f} of a cell\n{np.array2string(constants, precision=5)}")


if __name__ == "__main__":
    main()
