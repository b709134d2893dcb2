"""How many convolutions random contacts take, and which of them do not converge.

    python -m reports.experiments.random_contacts

Half a minute. Surfaces of six kinds on grids of 8 to 160 cells a side, free or periodic, of square cells and others,
with and without layers (some of them on soft bases), friction that couples into the gap, a compliance, a hardness;
from a thousandth of what would press them flat to more than that; load, approach or mean gap given. Numbers of the
solver that are chosen on these contacts are judged on others (`found` with another first seed). The median and
the most of each group's counts are stored in `reports/results/random_contacts.json`, with each contact that took more
than three times the median of all.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem import Body, ContactSolution, Grid, Layer, Material, displacement_operator, solve_contact
from bem.convolution import DisplacementOperator
from reports.experiments.kept import keep, rounded

RESULT = Path(__file__).resolve().parents[1] / "results" / "random_contacts.json"
CONTACTS, FIRST = 240, 777_000
"""Contacts, and the seed of the first."""
SURFACES = ("rough", "rough", "rough", "noise", "ball", "rough ball", "rough ball", "waves", "punch")
LONG = 3.0
"""Times the median of all counts: contacts that took more are kept one by one."""

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Contact:
    """One of them: what is pressed together, and how."""

    surface: str
    gap: FloatArray
    operator: DisplacementOperator
    asked: dict[str, Any]

    @property
    def control(self) -> str:
        """What is given."""
        return next(name for name in ("load", "approach", "mean_gap") if name in self.asked)

    @property
    def stiffness(self) -> float | None:
        """Of the layer over its base; None where there is none."""
        (body,) = self.operator.bodies
        return body.layers[0].material.youngs_modulus if body.layers else None

    @property
    def groups(self) -> list[str]:
        """Those that it belongs to."""
        stiff = self.stiffness
        layer = "no layer" if stiff is None else "soft layer" if stiff < 1 else "stiff layer"
        edges = "periodic" if all(self.operator.grid.periodic) else "free along an axis or two"
        others = ["friction"] * (not self.operator.symmetric) + ["hardness"] * (self.asked["hardness"] is not None)
        return ["all", self.control, layer, edges, *others]


def heights(rng: np.random.Generator, shape: tuple[int, int], kind: str) -> FloatArray:
    """A surface of rms one."""
    long = max(shape)
    if kind == "noise":
        return rng.standard_normal(shape)
    if kind == "rough":
        hurst, rolloff, cutoff = rng.uniform(0.2, 1.0), rng.uniform(1.0, 8.0), rng.uniform(0.1, 0.5) * long
        kx = np.fft.fftfreq(shape[0], 1 / long)[:, None]
        k = np.hypot(kx, np.fft.rfftfreq(shape[1], 1 / long)[None, :])
        amplitude = np.where(k <= cutoff, np.maximum(k, rolloff) ** (-1 - hurst), 0.0)
        amplitude[0, 0] = 0.0
        return _scaled(np.fft.irfft2(amplitude * np.fft.rfft2(rng.standard_normal(shape)), s=shape))
    x, y = ((np.arange(n) + 0.5 - n / 2) / long for n in shape)
    across, along = np.meshgrid(x, y, indexing="ij")
    if kind == "ball":
        return _scaled(-(across**2 + rng.uniform(0.1, 1.0) * along**2))
    if kind == "rough ball":
        return _scaled(-(across**2 + along**2)) + 10 ** rng.uniform(-3, 0) * heights(rng, shape, "rough")
    if kind == "waves":
        waves = rng.integers((1, 0), 5)
        phases = [2 * math.pi * w * r * long / n for w, r, n in zip(waves, (across, along), shape, strict=True)]
        return _scaled(np.cos(phases[0]) + np.cos(phases[1]))
    sides = rng.uniform(0.1, 0.4, 2)
    return _scaled(((np.abs(across) < sides[0]) & (np.abs(along) < sides[1])).astype(float))


def contact(seed: int) -> Contact:
    """One drawn from a seed; base and, where there is one, layer in units of the base's Young's modulus."""
    rng = np.random.default_rng(seed)
    grid, body = _grid(rng), _body(rng)
    friction = float(rng.choice([0.3, 1.0])) if rng.random() < 0.25 else 0.0
    compliance = float(10 ** rng.uniform(-4, 0)) if rng.random() < 0.1 else 0.0
    operator = displacement_operator(grid, body, friction=friction, compliance=compliance)
    surface = SURFACES[rng.integers(len(SURFACES))]
    height = 10 ** rng.uniform(-3.0, -1.5) * heights(rng, grid.shape, surface)
    gap = height.max() - height
    slope = max(1.4 * float(np.sqrt(np.mean((np.diff(height, axis=0) / grid.spacing[0]) ** 2))), 1e-9)
    pressure = 0.5 * slope * operator.modulus_at(math.pi / (8 * grid.spacing[0]))
    hardness = 2 * pressure * float(10 ** rng.uniform(-1.5, 1.0)) if rng.random() < 0.3 else None
    asked: dict[str, Any] = {"hardness": hardness, "tolerance": float(rng.choice([1e-8, 1e-8, 1e-6]))}
    control = ("load", "load", "approach", "mean_gap")[rng.integers(4)]
    share, mean = 10 ** rng.uniform(-3.0, 0.2), float(gap.mean())
    if control == "load":
        most = math.inf if hardness is None else hardness * float(rng.uniform(0.1, 0.95))
        asked["load"] = min(share * pressure, most) * grid.area
    elif control == "mean_gap":
        asked["mean_gap"] = mean * 10 ** rng.uniform(-1.3, -0.05)
    else:
        # beyond the mean there is no approach on a doubly periodic grid
        asked["approach"] = mean * 10 ** rng.uniform(-1.0, -0.02 if all(grid.periodic) else 0.5)
    return Contact(surface, gap, operator, asked)


def _grid(rng: np.random.Generator) -> Grid:
    """Of a longer side of one."""
    shape = int(rng.integers(24, 161)), int(rng.integers(24, 161))
    form = rng.random()
    if form < 0.4:
        shape = (shape[0], shape[0]) if form < 0.3 else (shape[0], int(rng.integers(8, 14)))
    aspect = 10 ** rng.uniform(-0.5, 0.5) if rng.random() < 0.2 else 1.0
    periodic = bool(rng.integers(2)), bool(rng.integers(2))
    return Grid(shape, (1 / max(shape), aspect / max(shape)), periodic=periodic)


def _body(rng: np.random.Generator) -> Body:
    """Half of them with a layer, some with another below it; the other body of the contact is rigid."""
    base = Material("base", youngs_modulus=1.0, poissons_ratio=float(rng.choice([0.0, 0.3, 0.49])))
    if rng.random() < 0.5:
        return Body(base)
    modulus, thickness = 10 ** rng.uniform(-2, 2), 10 ** rng.uniform(-3.5, 0)
    layers = [Layer(Material("layer", youngs_modulus=float(modulus), poissons_ratio=0.3), float(thickness))]
    if rng.random() < 0.2:
        below = Material("below", youngs_modulus=float(10 ** rng.uniform(-1, 1)), poissons_ratio=0.25)
        layers.append(Layer(below, float(10 ** rng.uniform(-2, -0.5))))
    return Body(base, layers=layers)


def _scaled(field: FloatArray) -> FloatArray:
    return field / max(float(field.std()), 1e-3)


def row(seed: int, one: Contact, solution: ContactSolution) -> dict[str, Any]:
    """One contact, for whom it took long."""
    grid, operator = one.operator.grid, one.operator
    return {
        "seed": seed,
        "shape": list(grid.shape),
        "periodic": list(grid.periodic),
        "surface": one.surface,
        "stiffness": one.stiffness,
        "friction": operator.friction,
        "control": one.control,
        "hardness": one.asked["hardness"] is not None,
        "touching": solution.counted_area / grid.area,
        "convolutions": solution.convolutions,
        "status": solution.status.value,
        "residual": solution.residual,
    }


def found(contacts: int, first: int = FIRST) -> dict[str, Any]:
    """Counts of each group and each contact, and the contacts that took long or did not converge."""
    rows: list[dict[str, Any]] = []
    groups: dict[str, list[dict[str, Any]]] = {}
    for seed in range(first, first + contacts):
        one = contact(seed)
        rows.append(row(seed, one, solve_contact(one.gap, one.operator, **one.asked)))
        for name in one.groups:
            groups.setdefault(name, []).append(rows[-1])
    half = float(np.median([one["convolutions"] for one in rows]))
    return {
        "groups": [_group(name, members) for name, members in groups.items()],
        "counts": [one["convolutions"] for one in rows],
        "long": [one for one in rows if one["convolutions"] > LONG * half or one["status"] != "converged"],
    }


def _group(name: str, members: list[dict[str, Any]]) -> dict[str, Any]:
    counts = [one["convolutions"] for one in members]
    return {
        "group": name,
        "contacts": len(members),
        "median": float(np.median(counts)),
        "mean": float(np.mean(counts)),
        "most": float(max(counts)),
        "converged": sum(one["status"] == "converged" for one in members),
        "infeasible": sum(one["status"] == "infeasible" for one in members),
    }


def main() -> None:
    """Draw, solve, print and store."""
    result = rounded(found(CONTACTS))
    for one in (*result["groups"], *result["long"]):
        print(one)
    keep(RESULT, result)


if __name__ == "__main__":
    main()
