"""Pictures of the theory pages that closed forms draw: `python -m reports.docs.theory_pictures` draws them again."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from bem.kernels.anisotropic import angular_function
from bem.materials import CATALOGUE
from bem.plots.style import BLUE, GREEN, ORANGE
from bem.reference_solutions.tense_ball import tense_ball
from reports.docs.tasks import save_small

HERE = Path(__file__).resolve().parent / "theory"
_SURFACES = (((0, 0, 1), (1, 0, 0)), ((1, 1, 0), (0, 0, 1)), ((1, 1, 1), (1, -1, 0)))
"""Normal and direction along x of the surfaces that are drawn."""


def crystals(figure: Figure) -> None:
    """Displacement at one distance from a point force, over its mean, on three surfaces of three crystals."""
    angles = np.linspace(0, 2 * np.pi, 361)
    for number, (name, title) in enumerate(
        (("silicon-crystal", "silicon"), ("copper-crystal", "copper"), ("iron-crystal", "iron"))
    ):
        stiffness = CATALOGUE[name].material.stiffness
        assert stiffness is not None
        axes = figure.add_subplot(1, 3, number + 1, projection="polar")
        for (normal, along_x), colour in zip(_SURFACES, (BLUE, ORANGE, GREEN), strict=True):
            turned = stiffness.oriented(normal, along_x)
            mean = 1 / (np.pi * turned.plane_strain_modulus)
            miller = "".join(map(str, normal))
            label = f"({miller}), {turned.plane_strain_modulus / 1e9:.0f} GPa"
            axes.plot(angles, angular_function(turned, angles) / mean, color=colour, label=label)
        axes.set_ylim(0.7, 1.2)
        axes.set_yticks([0.8, 0.9, 1.0, 1.1])
        axes.set_xticklabels([])
        axes.tick_params(labelsize=7)
        axes.set_title(title)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.02), fontsize=8, frameon=False)


def surface_tension(figure: Figure) -> None:
    """Load and approach of a ball at one contact radius, over the elastocapillary length."""
    axes = figure.add_subplot()
    ratios = np.geomspace(0.03, 30, 41)
    balls = [tense_ball(1.0, 10.0, 1.0, 0.5 * float(ratio), 32) for ratio in ratios]
    load = np.array([one.load for one in balls]) / (4 / 3 / 10.0)
    axes.loglog(ratios, load, color=BLUE, label="load, over Hertz")
    axes.loglog(ratios, [one.approach * 10.0 for one in balls], color=ORANGE, label="approach, over Hertz")
    axes.loglog(ratios, 0.75 * np.pi * ratios, "--", color="0.5", label="load of a film: 2γ/R on the area")
    axes.set_ylim(0.5, 100)
    axes.set_xlabel("elastocapillary length over contact radius, s / a")
    axes.legend()


PICTURES = {"crystal-surfaces": (crystals, (9.0, 3.9)), "tense-ball": (surface_tension, (5.5, 3.6))}
"""Functions that draw, and sizes [inches], by the names of the files."""


def main() -> None:
    """Draw all pictures again."""
    for name, (draw, size) in PICTURES.items():
        figure = Figure(figsize=size, layout="constrained")
        draw(figure)
        with tempfile.TemporaryDirectory() as scratch:
            figure.savefig(Path(scratch) / "picture.png", dpi=110)
            save_small(Path(scratch) / "picture.png", HERE / f"{name}.png")


if __name__ == "__main__":
    main()
