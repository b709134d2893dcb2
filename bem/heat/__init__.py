"""Flash temperature: surface temperature under heat sources on one or two moving half-spaces, steady or over time.

The heat source is at rest on the grid; the bodies move under it along x (Jaeger 1942; Carslaw & Jaeger 1959, sections
10.2 and 10.7). Layers are not included.

1. `bodies` checks the arguments and reduces each body to a `Conductor`: conductivity, diffusivity, speed and bulk
   temperature.
2. `coefficients` tabulates the temperature of one uniformly heated cell: one integral over time for all Peclet numbers,
   by Gauss points. Cost: one product of a column and a row per Gauss point; once per grid and body.
3. `operators` makes a convolution of the table, split into a part even and a part odd along x, on free axes or periodic
   along y; on doubly periodic grids it takes the exact transfer function of each wave. `band_temperatures` is the
   matrix of a line contact, in closed form. Cost: one convolution per application.
4. `partition` splits the heat of each cell between two bodies so that their surfaces are equally hot where heat is
   generated (Blok's partition, cell by cell). The linear system (K1 + K2) q1 = K2 q + b2 - b1 is solved by GMRES
   (`bem.numerics.gmres`), preconditioned by the inverse of the periodic transfer function. Cost: two convolutions and
   one for the preconditioner per iteration, ten to thirty iterations.
5. `steady` has `surface_temperature` and `flash_temperature`, which take steps 1 to 4.
6. `history` has `surface_temperature_history`: the heat is constant in each step, and the temperature of a step is the
   sum over all earlier steps, in the spectrum. Cost: proportional to the square of the number of steps; memory of one
   padded spectrum per step and body.

The result is a `TemperatureSolution` (`partition`); its residual is recomputed from the returned heat.

The package knows grids, materials and transforms, no contact. Verified against finite elements in
`bem.verification.heat` and against the closed forms of `bem.reference_solutions.heat_sources` in tests/heat.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.heat.history import surface_temperature_history
    from bem.heat.partition import TemperatureSolution
    from bem.heat.steady import flash_temperature, surface_temperature

__all__ = ["TemperatureSolution", "flash_temperature", "surface_temperature", "surface_temperature_history"]

__getattr__ = loader(
    __name__,
    {
        "steady": ["flash_temperature", "surface_temperature"],
        "history": ["surface_temperature_history"],
        "partition": ["TemperatureSolution"],
    },
)
