"""Surface temperature of sources of heat that move over half-spaces: steady and in time, one body or a pair.

The heat is at rest on the grid, the bodies move under it along x. `coefficients` has the temperature of one heated cell
(one integral over time for every Peclet number), `operators` makes convolutions of it, `krylov` solves, `bodies` says
what of a body matters, `pair` shares the heat between two bodies so that their surfaces are as hot where it is made,
`steady` and `history` are what users call, `notes` what they should not believe. Layers are not included.

Sees grids, materials and transforms, no contact. Verified against finite elements in `bem.verification.heat` and
against the closed forms of `bem.reference_solutions.heat_sources` in tests/heat.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.heat.history import surface_temperature_history
    from bem.heat.solution import TemperatureSolution
    from bem.heat.steady import flash_temperature, surface_temperature

__all__ = ["TemperatureSolution", "flash_temperature", "surface_temperature", "surface_temperature_history"]

__getattr__ = loader(
    __name__,
    {
        "steady": ["flash_temperature", "surface_temperature"],
        "history": ["surface_temperature_history"],
        "solution": ["TemperatureSolution"],
    },
)
