"""Flash temperature: surface temperature under heat sources on one or two moving half-spaces, steady or over time.

The heat source is at rest on the grid; the bodies move under it along x (Jaeger 1942; Carslaw & Jaeger 1959, sections
10.2 and 10.7). `layers` adds the response of layers to the steady temperature; over time they are refused.

1. `bodies` checks the arguments and reduces each body to a `Conductor`: conductivity, diffusivity, speed and bulk
   temperature.
2. `coefficients` tabulates the temperature around one uniformly heated cell: one integral over time for all Peclet
   numbers, by Gauss points. Cost: one product of a column and a row per Gauss point; once per call and body.
3. `operators` makes a convolution of the table, split into a part even and a part odd along x, where the grid is free
   along x. On doubly periodic grids it takes the exact transfer function of each wave. Cost: one convolution per
   application.
4. `partition` splits the heat of each cell between two bodies so that their surfaces are equally hot where heat is
   generated (Blok 1937, cell by cell), by GMRES. Cost: two convolutions and one for the preconditioner per iteration,
   ten to thirty iterations. A single body takes one convolution in place of this step.
5. `solution` builds the `TemperatureSolution`. Its residual is recomputed from the returned heat.

`steady` has `surface_temperature` and `flash_temperature`, which take steps 1 to 5. `history` has
`surface_temperature_history`, which repeats steps 4 and 5 with the heat of all earlier steps. Cost: proportional to the
square of the number of steps; memory of one padded spectrum per step and body.

`line_contact` is the closed form under bands without end, for `bem.lubrication`; steps 1 to 5 do not use it.

The package knows grids, materials and transforms, no contact. Verified against finite elements in
`bem.verification.heat` and against the closed forms of `bem.reference_solutions.heat_sources` in tests/heat.
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
