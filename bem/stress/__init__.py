"""Stresses below a loaded surface: six components, von Mises stress, and where von Mises stress can exceed a limit.

The stress at a depth is the convolution of the surface load with the stress kernels of that depth: the Boussinesq and
Cerruti solutions integrated over a cell (Johnson, *Contact Mechanics* (1985), sections 3.2 and 3.6), or the response of
a layered body to each wave (`bem.kernels`). Signs: tension is positive.

Stresses at given depths (`subsurface_stress`, `von_mises_field`, `von_mises_planes`):

1. `request` checks the arguments and transforms the pressure, and each direction of a prescribed traction. The traction
   friction x pressure is part of the kernel. Cost: one forward transform each, for all depths.
2. `spectra` takes the spectra of a depth's kernels from a bounded cache, or computes them: six quarter arrays under
   pressure, twelve with friction. Wavenumbers below rounding error are dropped. Cost: 25 to 40 transforms at first use.
3. `fields` multiplies and transforms back. Cost: six inverse transforms a depth for the six components, five for von
   Mises stress.

Figures of one contact (`stress_summary.summarise_stress`): steps 1 to 3 at every given depth, then the maximum von
Mises stress between points and depths, its depth, and the yielded area and volume. No depth is omitted. Cost: a few
passes over each plane.

Highest stresses of coatings (`layer_stresses`): of each layer and interface, at depths of `with_layer_depths`, with
those at the edge of the contact and beyond free edges of the grid (`coating_maxima`).

Two shorter ways to von Mises stress above a limit, which `bem.wear` uses:

- `von_mises_bound.von_mises_upper_bound` proves that nothing yields at a depth, from the largest pressure and the load.
  Cost: one pass over a depth's kernel at first use, then a few operations; no transform.
- `connected_regions.connected_stress` computes only the rows that regions connected to the first depth can reach. Cost:
  one forward transform, five passes along x for each depth that is reached, and passes along y for about half of the
  rows.

The package knows kernels, transforms and bodies, but no contact. Verified in tests/test_stress.py and tests/stress
against the closed forms of Hamilton and McEwen, in tests/frugality for memory, and by the gates of `bem verify` against
finite elements.
"""

from bem.stress.coating_maxima import CoatingMaxima, coating_maxima
from bem.stress.connected_regions import ConnectedStress, clear_other_rows, connected_stress
from bem.stress.edge_tension import EdgeTension, edge_tension
from bem.stress.fields import subsurface_stress, von_mises, von_mises_field, von_mises_planes
from bem.stress.layer_places import LayerPlaces, layer_places
from bem.stress.layer_stresses import (
    DepthMaxima,
    LayerStresses,
    depth_maxima,
    highest_principal,
    layer_stresses,
    with_layer_depths,
    with_tension_beyond,
)
from bem.stress.spectra import COUNT, set_stress_memory, stress_memory
from bem.stress.stress_summary import StressSummary, summarise_stress
from bem.stress.von_mises_bound import von_mises_upper_bound

__all__ = [
    "COUNT",
    "CoatingMaxima",
    "ConnectedStress",
    "DepthMaxima",
    "EdgeTension",
    "LayerPlaces",
    "LayerStresses",
    "StressSummary",
    "clear_other_rows",
    "coating_maxima",
    "connected_stress",
    "depth_maxima",
    "edge_tension",
    "highest_principal",
    "layer_places",
    "layer_stresses",
    "set_stress_memory",
    "stress_memory",
    "subsurface_stress",
    "summarise_stress",
    "von_mises",
    "von_mises_field",
    "von_mises_planes",
    "von_mises_upper_bound",
    "with_layer_depths",
    "with_tension_beyond",
]
