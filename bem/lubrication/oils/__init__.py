"""Oils by name or grade: viscosity over temperature and pressure, density, heat capacity and conductivity, each figure
with its source. Knows no film; `Oil.at` makes the `Lubricant` that films are solved with. Names are loaded when they
are first used. Verified in tests/lubrication/test_oils.py."""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.lubrication.oils.catalogue import find_oil, oil_names
    from bem.lubrication.oils.index import viscosity_index
    from bem.lubrication.oils.oil import Oil

__all__ = ["Oil", "find_oil", "oil_names", "viscosity_index"]

__getattr__ = loader(
    __name__,
    {
        "catalogue": ["find_oil", "oil_names"],
        "oil": ["Oil"],
        "index": ["viscosity_index"],
    },
)
