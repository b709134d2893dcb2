"""Constants of unfilled polymer bushes by material of the catalogue, each with its source.

All sources are second hand: excerpts and abstracts that a search showed. No page was read in the original, so that
figures should be checked against the maker's data sheet. Verified in tests/elements/test_plain_bush.py.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SourcedValue:
    """A number of the literature.

    Attributes
    ----------
    value : in `unit`.
    unit : of SI, "1" of a ratio.
    source : where the number is from and how far it spreads, for a reader of the answer.
    """

    value: float
    unit: str
    source: str


DRY_FRICTION = {
    "peek": SourcedValue(
        0.35,
        "1",
        "between 0.3, the highest of Lind et al. (Tribologia) at 120 °C, and 0.4 of data of PEEK 450G, both against "
        "steel",
    ),
    "ptfe": SourcedValue(
        0.1, "1", "unfilled on steel, about 0.1 in a catalogue of PBC Linear; 0.05 to 0.2, more at higher speed"
    ),
    "pom": SourcedValue(
        0.25, "1", "0.15 to 0.25 in a supplier's table; 0.1 to 0.3 at rest on steel (CRC Materials Science Handbook)"
    ),
    "pa66": SourcedValue(
        0.3, "1", "0.2 to 0.3 in a supplier's table; 0.32 of cast PA 6 (CRC Materials Science Handbook)"
    ),
}
"""Friction coefficient of dry, unfilled bushes on steel, near the upper end.

0.05 of PTFE is in the abstract of doi 10.1108/eb052334; the supplier is Kintek, the handbook Shackelford's (table 399).
Lind et al.: Friction and wear studies of some PEEK materials, abstract. The datum of PEEK 450G is quoted in a thread of
eng-tips.
"""
SERVICE_TEMPERATURE = {
    "peek": SourcedValue(
        523.15, "K", "continuous use of PEEK: W. Hufenbach, K. Kunze and J. Bijwe (2003), introduction"
    ),
    "ptfe": SourcedValue(
        533.15, "K", "working temperature of PTFE: Mechanical Engineer's Data Handbook; it melts at 327 °C"
    ),
    "pom": SourcedValue(
        373.15,
        "K",
        "POM-C in air: 100 °C of a supplier's data sheet (UL 746B), 85 to 90 °C of R. J. Crawford, Plastics "
        "Engineering; it melts at 162 to 175 °C",
    ),
    "pa66": SourcedValue(
        373.15,
        "K",
        "PA 66, between 90 °C of R. J. Crawford, Plastics Engineering, and 120 °C of a data sheet; it melts at 260 °C",
    ),
}
"""Highest temperature of a bush in continuous use.

260 °C of PTFE is on page 243 of the handbook, 327 °C in the abstract of doi 10.1108/eb052334, 162 to 175 °C of POM from
Craftech, 120 °C of PA 66 and a melting point of 264 °C in the data sheet of Nylatron 66 SA FR. Table 1.8 of Crawford
has 85 and 90 °C of acetal homopolymer and copolymer, 90 °C of PA 66, 204 °C of PEEK and 250 °C of PTFE. A chart of
Ensinger has POM and PA 66 between 100 and 150 °C.
"""
LEAST_EXPANSION = SourcedValue(5e-5, "1/K", "PEEK: 4.8e-5 1/K in R. J. Crawford, Plastics Engineering, table 1.8")
"""Linear expansion coefficient of unfilled polymers, the usual least."""
LARGEST_EXPANSION = SourcedValue(
    1.5e-4,
    "1/K",
    "PTFE: 1.4e-4 1/K in R. J. Crawford, Plastics Engineering, table 1.8; 1.2e-4 at 20 °C to 1.7e-4 at 100 °C in "
    "W. Martienssen and H. Warlimont, Springer Handbook of Condensed Matter and Materials Data, table 3.3-13",
)
"""Linear expansion coefficient of unfilled polymers, the usual largest; POM and PA 66 have 8e-5 to 1e-4 (Crawford)."""
