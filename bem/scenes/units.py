"""Quantities in scenes: `"10 N"`, `"45 nm"`, `"25 1/GPa"`, or a number in SI units."""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation, localcontext
from functools import cache, lru_cache
from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from bem.scenes.usual_units import usual_unit

_NUMBER_AND_UNIT = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*?)\s*", re.DOTALL)
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d+,\d+\s*(?=[A-Za-zµμÅ°%]|1/|$)")
# No names with long exponents and nothing but unit algebra reaches pint's parser.
_UNIT_TEXT = re.compile(r"[A-Za-zµμÅ°Ω%][A-Za-z0-9µμÅ°Ω%*/^ ().-]{0,39}|1\s*/[A-Za-z0-9µμÅ°Ω%*/^ ().-]{1,39}")
_BLANK_PRODUCT = re.compile(r"(?<=[\w)])\s+(?=[A-Za-zµμÅ(])")
_LONG_EXPONENT = re.compile(r"\d{2,}|\*\*\s*\S*\*\*|\^\s*\S*\^")
# How tribologists write specific wear rates: "mm3/Nm". "Nm" is a torque or work, no nanometre.
_BARE_POWER = re.compile(r"(?<![A-Za-zµμ])([kcmuµμn]?m)([23])(?![0-9])")
_NEWTON_METRE = re.compile(r"(?<![A-Za-zµμ])Nm(?![A-Za-z0-9])")
_ANGLE_IN_UNIT = re.compile("rpm|rps|rad|deg|°|rev|turn|cycle", re.IGNORECASE)
_TURNS = re.compile(r"\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?)\s*(?:1\s*/\s*min|/\s*min|min\s*(?:\^|\*\*)?\s*-1|min⁻¹)\s*")
"""Speeds of rotation per minute whose unit says no angle."""
_VICKERS = re.compile(r"HV\s*[0-9.]*")
"""Vickers hardness, with or without the force of the test, as in HV10 or HV0.05 (ISO 6507-1)."""
_VICKERS_UNIT = Decimal("9.80665e6")
"""One HV [Pa]: a kilogram-force per square millimetre of the indentation's surface (ISO 6507-1)."""
_OTHER_HARDNESS = re.compile(r"H(R[A-Z]*|B[A-Z]*|K|S)\s*[0-9.]*")
"""Rockwell, Brinell, Knoop and Shore hardness, which no factor makes a pressure."""
_COMMON_UNITS = (
    *("m", "mm", "um", "nm", "angstrom", "m^2", "um^2", "mm^2", "m^3", "nm^3", "angstrom^3", "1/m"),
    *("N", "mN", "uN", "nN", "kN", "N/m", "Pa", "kPa", "MPa", "GPa", "1/Pa", "1/MPa", "1/GPa", "Pa*s", "mPa*s", "cP"),
    *(
        "s",
        "ms",
        "min",
        "hour",
        "1/s",
        "m/s",
        "mm/s",
        "um/s",
        "nm/s",
        "K",
        "degC",
        "J",
        "eV",
        "J/K",
        "kg/m^3",
        "W/(m*K)",
        "J/(kg*K)",
    ),
    *("%", "deg", "rad", "rpm", "rad/s"),
)


@dataclass(frozen=True)
class Dimension:
    """Dimension of a key; as annotation of a float it parses, converts and refuses.

    Attributes
    ----------
    unit : the SI unit the value is kept in; "" for a plain ratio.
    noun : what to call it in messages, such as "a length".
    example : a value as a user would write it.
    """

    unit: str
    noun: str
    example: str

    @property
    def allowed(self) -> str:
        """Allowed values as a phrase for messages."""
        if not self.unit:
            return f'{self.noun} such as {self.example} or "10 %"'
        return f'{self.noun} such as "{self.example}", or a number in {self.unit}'

    def parse(self, value: Any) -> float:
        """The value in SI units.

        Raises
        ------
        PydanticCustomError : not a number, an unknown unit, a unit of another dimension, not finite.
        """
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            raise self._error("is not a number or a number with a unit")
        if not isinstance(value, str):
            try:
                number = float(value)
            except OverflowError:
                number = math.inf
        else:
            number = self._parse_text(value)
        if not math.isfinite(number):
            raise self._error("is not finite")
        return number

    def _parse_text(self, text: str) -> float:
        if (comma := _DECIMAL_COMMA.match(text[:100])) is not None:
            point = text.strip().replace(",", ".", 1)
            missing = " and its unit" if self.unit and comma.end() == len(text) else ""
            raise self._error(f'has a comma; write a decimal point, "{point}"{missing}')
        match = _NUMBER_AND_UNIT.fullmatch(text[:100])
        if match is None or len(text) > 100:
            raise self._error("is not a number followed by a unit")
        digits, unit = match.groups()
        if not unit:
            if self.unit:
                raise self._error("has no unit; without quotes it would be a number in SI units")
            return float(digits)
        return convert(digits, unit, self)

    def _error(self, problem: str) -> PydanticCustomError:
        return PydanticCustomError(
            "quantity", "{problem}; allowed: {allowed}", {"problem": problem, "allowed": self.allowed}
        )

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """Parse before pydantic's own checks of the float."""
        return core_schema.no_info_before_validator_function(self.parse, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """A number or a string."""
        number = dict(handler(schema))
        text = {"type": "string", "description": self.allowed}
        return {"anyOf": [number, text], "examples": [self.example]} | ({"unit": self.unit} if self.unit else {})


@dataclass(frozen=True)
class Number(Dimension):
    """A number without a unit that nobody writes in per cent."""

    @property
    def allowed(self) -> str:
        """Allowed values as a phrase for messages."""
        return f"{self.noun}, such as {self.example}"


@dataclass(frozen=True)
class Rotation(Dimension):
    """A speed of rotation, whose unit must say the angle; "1500 1/min" are turns, as drawings and catalogues write n.

    A rate per second is refused: turns to some and radians to SI.
    """

    def _parse_text(self, text: str) -> float:
        if (turns := _TURNS.fullmatch(text[:100])) is not None:
            text = f"{turns[1]} rpm"
        found = super()._parse_text(text)
        if _ANGLE_IN_UNIT.search(text) is None:
            raise self._error("says no angle, of which turns and radians differ by 6.28")
        return found


def turns_without_angle(value: Any) -> bool:
    """Return True for a speed of rotation as text per minute that says no angle, such as "900 1/min"."""
    return isinstance(value, str) and _TURNS.fullmatch(value[:100]) is not None


def convert(digits: str, unit: str, dimension: Dimension) -> float:
    """`digits` of `unit` in the SI unit of `dimension`, rounded once: "45 nm" is exactly 45e-9."""
    if dimension.unit == "K" and unit.strip() == "C":  # what a temperature is written in; a charge elsewhere
        unit = "degC"
    try:
        if dimension.unit == "Pa" and _VICKERS.fullmatch(unit):
            found, factor = _unit("Pa")[0], _VICKERS_UNIT
        else:
            found, factor = _unit(unit)
    except LookupError:
        if dimension.unit == "Pa" and _OTHER_HARDNESS.fullmatch(unit):
            raise dimension._error(f'has the hardness scale "{unit[:40]}": convert to HV first, as "800 HV"') from None
        close = difflib.get_close_matches(unit, _COMMON_UNITS, n=1, cutoff=0.5)
        hint = f' (did you mean "{close[0]}"?)' if close else ""
        raise dimension._error(f'has the unknown unit "{unit[:40]}"{hint}') from None
    wanted, _ = _unit(dimension.unit) if dimension.unit else ((), Decimal(1))
    if found != wanted:
        raise dimension._error(f"is not {dimension.noun}")
    with localcontext() as context:
        context.prec = 40
        try:
            number = Decimal(digits) * factor
        except InvalidOperation:
            return math.inf
        if _is_celsius(unit):
            number += Decimal("273.15")
        return float(number)


def _is_celsius(unit: str) -> bool:
    return unit.replace(" ", "").lower() in ("degc", "°c", "celsius", "degreec", "degree_celsius")


@lru_cache(maxsize=512)
def _unit(text: str) -> tuple[tuple[tuple[str, float], ...], Decimal]:
    """Dimensionality and factor to SI of a unit expression; LookupError if it is none."""
    if _is_celsius(text):
        text = "kelvin"
    if _UNIT_TEXT.fullmatch(text) is None or _LONG_EXPONENT.search(text):
        raise LookupError(text)
    text = _NEWTON_METRE.sub("(N*m)", _BARE_POWER.sub(r"\1^\2", text))
    known = usual_unit(_BLANK_PRODUCT.sub("*", text.strip()))
    if known is not None:
        return known
    registry = _registry()
    product = _BLANK_PRODUCT.sub("*", text.replace("%", "percent"))
    try:
        quantity = registry.parse_expression(product)
        if quantity.magnitude != 1 or (0 * quantity).to_base_units().magnitude != 0:  # factors, offset scales
            raise LookupError(text)
        quantity = quantity.to_base_units()
        dimensionality = tuple(sorted((str(k), float(v)) for k, v in quantity.dimensionality.items()))
        # Fifteen digits hold every exact factor and drop the last-bit noise of products of floats.
        return dimensionality, Decimal(f"{quantity.magnitude:.15g}")
    except Exception:  # pint's parser raises a dozen unrelated types on nonsense
        raise LookupError(text) from None


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


LENGTH = Dimension("m", "a length", "45 nm")
Length = Annotated[float, LENGTH]
Area = Annotated[float, Dimension("m^2", "an area", "25 um^2")]
Volume = Annotated[float, Dimension("m^3", "a volume", "85 angstrom^3")]
Force = Annotated[float, Dimension("N", "a force", "10 N")]
Pressure = Annotated[float, Dimension("Pa", "a pressure", "1.8 GPa")]
SurfaceTension = Annotated[float, Dimension("N/m", "a surface tension", "30 mN/m")]
Speed = Annotated[float, Dimension("m/s", "a speed", "0.1 m/s")]
Time = Annotated[float, Dimension("s", "a time", "45 min")]
Rate = Annotated[float, Dimension("1/s", "a rate", "6.9e-4 1/s")]
RotationSpeed = Annotated[float, Rotation("rad/s", "a speed of rotation", "1500 rpm")]
NumberPerArea = Annotated[float, Dimension("1/m^2", "a number per area", "1e12 1/m^2")]
InverseLength = Annotated[float, Dimension("1/m", "an inverse length", "1.24e7 1/m")]
Viscosity = Annotated[float, Dimension("Pa*s", "a dynamic viscosity", "0.36 Pa*s")]
KinematicViscosity = Annotated[float, Dimension("m^2/s", "a kinematic viscosity", "68 mm^2/s")]
Softening = Annotated[float, Dimension("1/K", "a rate over temperature", "0.04 1/K")]
PressureViscosity = Annotated[float, Dimension("1/Pa", "a pressure-viscosity coefficient", "25 1/GPa")]
TEMPERATURE = Dimension("K", "a temperature", "60 degC")
Temperature = Annotated[float, TEMPERATURE]
Energy = Annotated[float, Dimension("J", "an energy", "0.8 eV")]
Density = Annotated[float, Dimension("kg/m^3", "a density", "870 kg/m^3")]
ThermalConductivity = Annotated[float, Dimension("W/(m*K)", "a thermal conductivity", "46 W/(m*K)")]
HeatCapacity = Annotated[float, Dimension("J/(kg*K)", "a heat capacity per mass", "470 J/(kg*K)")]
Angle = Annotated[float, Dimension("rad", "an angle", "30 deg")]
WearCoefficient = Annotated[float, Dimension("m^2/N", "a specific wear rate", "350e-7 mm^3/(N*m)")]
Ratio = Annotated[float, Dimension("", "a number", "0.3")]
