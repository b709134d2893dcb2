"""Surfaces by how they are made: what `generate_surface` is asked for where a scene names only the process.

Roughness of a process scatters by a factor of three and more; these are starting points for who has no measured map.
Each figure has its source, or is said to be chosen here. No process of these is only random: feed marks, cross-hatch
and scratches have a phase that waves of random phase do not have, which `left_out` says.

Sees only errors. Verified in tests/surfaces/test_surface_processes.py: what is drawn has the statistics stated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

from bem.errors import InputError

ProcessName = Literal["ball", "blasted", "eroded", "ground", "honed", "lapped", "polished", "superfinished", "turned"]
Lay = Literal["x", "y"]

_CHART = "range: chart of ASME B46.1, average application, Ra x 1.25, from memory"
_GAUSSIAN = "the Gaussian autocorrelation that is drawn has fewer short waves than an exponential one"


@dataclass(frozen=True, kw_only=True)
class Process:
    """A manufacturing process.

    title : in a few words.
    rms_height : Sq [m]; usual : from where to where it lies in practice [m].
    across, along : lengths at which the autocorrelation falls to 1/e across and along the lay [m]; equal without one;
        None of a self-affine surface.
    hurst, rolloff_wavelength : of a self-affine surface: exponent, and the wavelength above which it is flat [m].
    skewness, kurtosis : of the heights.
    source : of the figures; chosen : which of them are not from there; left_out : what of the process is not drawn.
    """

    title: str
    rms_height: float
    usual: tuple[float, float]
    across: float | None = None
    along: float | None = None
    hurst: float | None = None
    rolloff_wavelength: float | None = None
    skewness: float = 0.0
    kurtosis: float = 3.0
    source: str
    chosen: str
    left_out: str

    @property
    def directional(self) -> bool:
        """Whether it has a lay."""
        return self.across != self.along

    def lengths(self, lay: Lay = "y") -> tuple[float, float] | None:
        """Correlation lengths along x and y [m], the ridges along `lay`; None of a self-affine surface."""
        if self.across is None or self.along is None:
            return None
        return (self.across, self.along) if lay == "y" else (self.along, self.across)

    def statistics(self, lay: Lay = "y") -> dict[str, Any]:
        """Arguments of `generate_surface`, which takes a grid and a seed besides.

        Raises
        ------
        InputError : a lay that is neither x nor y.
        """
        if lay not in ("x", "y"):
            raise InputError(f'lay {lay!r}: allowed: "x" (ridges along the sliding direction) or "y" (across it)')
        asked = {
            "rms_height": self.rms_height,
            "correlation_length": self.lengths(lay),
            "hurst": self.hurst,
            "rolloff_wavelength": self.rolloff_wavelength,
            "skewness": self.skewness,
            "kurtosis": self.kurtosis,
        }
        return {key: value for key, value in asked.items() if value is not None}

    def keys(self, lay: Lay = "y") -> dict[str, Any]:
        """The keys of a scene's generated surface: mean correlation length and elongation in the pair's place."""
        found = self.statistics(lay)
        pair = found.pop("correlation_length", None)
        if pair is not None:
            found["correlation_length"] = math.sqrt(pair[0] * pair[1])
            if self.directional:
                found["elongation"] = pair[0] / pair[1]
        return found

    def shown(self) -> tuple[str, ...]:
        """Sq, its usual range, lengths across and along the lay, skewness, kurtosis, in words."""
        usual = " to ".join(map(_length, self.usual))
        if self.across is not None and self.along is not None:
            lengths = (_length(self.across), _length(self.along))
        else:
            lengths = (f"H {self.hurst:g}", f"flat above {_length(self.rolloff_wavelength or 0.0)}")
        return _length(self.rms_height), usual, *lengths, f"{self.skewness:g}", f"{self.kurtosis:g}"


def _length(value: float) -> str:
    return f"{1e6 * value:.4g} um" if value >= 1e-6 else f"{1e9 * value:.4g} nm"


PROCESSES: dict[str, Process] = {
    "ball": Process(
        title="bearing ball of grade 10, lapped",
        rms_height=15e-9,
        usual=(10e-9, 25e-9),
        across=5e-6,
        along=5e-6,
        source="Ra 12 nm of grade 10, 8 to 20 nm of grades 3 to 20 (grades of ISO 3290), x 1.25",
        chosen="correlation length, Gaussian heights",
        left_out="single scratches",
    ),
    "blasted": Process(
        title="blasted with beads or sand",
        rms_height=1.4e-6,
        usual=(0.5e-6, 6e-6),
        across=13e-6,
        along=13e-6,
        source="Greenwood & Williamson, Proc. R. Soc. A 295 (1966) 300: bead-blasted aluminium, Sq 1.4 um, Gaussian "
        "heights; from memory",
        chosen="range, correlation length (of the size of their summits' radius)",
        left_out=f"steep flanks; {_GAUSSIAN}",
    ),
    "eroded": Process(
        title="electrical discharge machined",
        rms_height=4e-6,
        usual=(2e-6, 8e-6),
        across=30e-6,
        along=30e-6,
        skewness=0.3,
        kurtosis=3.2,
        source="range: Ra 3.2 to 6.3 um commonly, 1.6 where fine (tables of production methods), x 1.25; craters "
        "overlapping at random: Materials 13 (2020) 3830",
        chosen="Sq, correlation length (of a crater), skewness and kurtosis",
        left_out="rims of the craters",
    ),
    "ground": Process(
        title="ground in one direction",
        rms_height=0.5e-6,
        usual=(0.12e-6, 2e-6),
        across=6.5e-6,
        along=65e-6,
        source="Whitehouse & Archard, Proc. R. Soc. A 316 (1970) 97: ground specimen Aachen 64-13, Sq 0.5 um, Gaussian "
        f"heights, exponential autocorrelation of 6.5 um; from memory. {_CHART}",
        chosen="ten times as long along the grooves as across",
        left_out=f"single deep grooves, which make skewness negative; {_GAUSSIAN}",
    ),
    "honed": Process(
        title="plateau-honed, as cylinder liners",
        rms_height=0.5e-6,
        usual=(0.12e-6, 1e-6),
        across=15e-6,
        along=15e-6,
        skewness=-1.2,
        kurtosis=5.0,
        source=f"negative skewness and high kurtosis: Bhushan (ed.), Modern Tribology Handbook, ch. 2. {_CHART}",
        chosen="Sq, correlation length, the figures of skewness and kurtosis",
        left_out="the two directions of the cross-hatch and its plateaus: it is drawn without a direction",
    ),
    "lapped": Process(
        title="lapped flat",
        rms_height=0.15e-6,
        usual=(0.06e-6, 0.5e-6),
        across=6e-6,
        along=6e-6,
        skewness=-0.3,
        kurtosis=3.3,
        source=_CHART,
        chosen="Sq, correlation length, skewness and kurtosis",
        left_out="single scratches",
    ),
    "polished": Process(
        title="polished, self-affine",
        rms_height=20e-9,
        usual=(5e-9, 100e-9),
        hurst=0.8,
        rolloff_wavelength=20e-6,
        source="H near 0.8 of polished, ground and blasted surfaces: Persson et al., J. Phys.: Condens. Matter 17 "
        "(2005) R1; from memory",
        chosen="Sq and range of metallographic polish, roll-off, Gaussian heights",
        left_out="scratches, pits and raised carbides; waves are drawn down to two cells where no cutoff is given",
    ),
    "superfinished": Process(
        title="superfinished by vibration, as gears and bearings",
        rms_height=75e-9,
        usual=(60e-9, 250e-9),
        across=15e-6,
        along=15e-6,
        skewness=-1.0,
        kurtosis=4.5,
        source="Ra below 76 nm, planarised, without direction: Hansen, Salerno & Winkelmann, AGMA 06FTM02 (2006). "
        f"{_CHART}",
        chosen="correlation length, the figures of skewness and kurtosis: peaks are gone, valleys are left",
        left_out="what is left of the grinding's direction",
    ),
    "turned": Process(
        title="finish-turned: feed 0.1 mm, nose radius 0.8 mm",
        rms_height=0.47e-6,
        usual=(0.2e-6, 3e-6),
        across=17.5e-6,
        along=350e-6,
        skewness=0.4,
        kurtosis=2.6,
        source="cusps of a round nose, derived here: height f^2 / 8 r, Sq = 2 / sqrt(45) of it, autocorrelation at 1/e "
        "after 0.176 f, skewness 0.64, kurtosis 2.14; measured skewness -0.5 to above 0, rising with the feed: Molnar, "
        "Symmetry 14 (2022) 1591",
        chosen="skewness and kurtosis between cusps and measurement, twenty times as long along the grooves as across",
        left_out="the period of the feed: it is drawn as waves of random phase",
    ),
}
"""Manufacturing processes by name."""
