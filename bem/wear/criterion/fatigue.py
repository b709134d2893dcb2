"""Low-cycle fatigue: damage of every voxel, pass by pass, until broken voxels reach the surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import parameter, register
from bem.wear.criterion.stresses import VonMises

if TYPE_CHECKING:
    from bem.materials import Material
    from bem.wear.loads import BodyCycle, BodyWear

_UNIFORM = "uniform material law for unalloyed and low-alloy steels (Baumel and Seeger 1990)"


@register
@dataclass(frozen=True)
class LowCycleFatigue(VonMises):
    """A pass uses 1/N of the life of a cell of material, its plastic strain ep = ef (2N)^-c (Coffin, Manson; Miner).

    ep = (von Mises - yield stress) / 3G is what the strain of the elastic surroundings leaves to flow. Broken regions
    that reach the surface come off. Damage lies with the material and moves up as it wears; that of a cycle counts down
    to the first depth at which nothing yields. Stresses may be averaged over a disc along the surface, as by
    `averaged_von_mises`; without that there is no length in it but how far the counterface slides.
    """

    name: ClassVar[str] = "low_cycle_fatigue"
    cites: ClassVar[tuple[str, ...]] = ("baumel1990",)
    length_key: ClassVar[str] = "averaging_length"
    ductility: float = parameter(
        "fatigue ductility: plastic strain that breaks the material in one reversal (Coffin, Manson)",
        default=0.59,
        above=0,
        source=_UNIFORM,
    )
    exponent: float = parameter(
        "fatigue exponent of plastic strain over reversals (Coffin, Manson)",
        default=0.58,
        above=0,
        below=1,
        source=_UNIFORM,
    )
    passes: float = parameter(
        "number of passes of the counterface that a computed cycle stands for",
        default=1000.0,
        above=0,
        source="a choice: steel bears some thousand passes here, so that a hundred cycles show the steady wear",
    )

    averaging_length: float = parameter(
        "diameter of the disc over which stresses are averaged, 0 for none", "m", default=0.0, at_least=0
    )

    @property
    def counts_passes(self) -> bool:
        """True: damage adds up over passes."""
        return True

    @property
    def passes_per_cycle(self) -> float:
        """Passes that one computed cycle stands for, as given."""
        return self.passes

    def damage(self, stress: FloatArray, material: Material) -> FloatArray:
        """Return the damage (at most one) that a von Mises stress [Pa] does in one computed cycle."""
        assert material.yield_stress is not None
        flow = np.maximum(stress - material.yield_stress, 0.0) / (3 * material.shear_modulus)
        return np.asarray(np.minimum(2 * self.passes * (flow / self.ductility) ** (1 / self.exponent), 1.0))

    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return broken pieces that reach the surface, and the damage of the remaining material as memory."""
        from bem.wear.damage import fatigue_removal

        return fatigue_removal(cycle, self.averaging_length, self.damage)
