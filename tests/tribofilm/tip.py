"""The tip of a force microscope on iron, on which films grow."""

from bem import Grid, Material
from bem.tribofilm import FilmContact, StressActivatedGrowth

IRON = Material("iron", youngs_modulus=210e9, poissons_ratio=0.3)
LAW = StressActivatedGrowth.from_electron_volts(1e-2, 0.8, 85)


def tip_contact(grid: Grid, **given):
    """A tip of 53 nm under 600 nN at 100 deg C; hardness, modulus and counterface must be among what is given."""
    arguments = {
        "gap": (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 2 / 53e-9,
        "grid": grid,
        "substrate": IRON,
        "load": 600e-9,
        "growth": LAW,
        "temperature": 373.15,
        "average": "nominal",
    }
    return FilmContact(**(arguments | given))
