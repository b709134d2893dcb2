"""Laws in scenes: a key that names one, alone or with its parameters, from the registry of `bem.laws`.

`viscosity_law = "barus"`, `viscosity_law = { kind = "mine", exponent = 16, pole = "0.2 GPa" }`, or, in a `LawTable`,
the parameters beside the key: `shear_law = "eyring"` with `shear_stress_limit = "5 MPa"`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, TypeAdapter, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import InitErrorDetails, PydanticCustomError, core_schema

from bem.errors import InputError
from bem.laws import REMOVED_LAWS, Law, Parameter, laws_of
from bem.scenes import units
from bem.scenes.common import Table, problem
from bem.scenes.units import Dimension

_DIMENSIONS = {
    one.unit: one
    for item in vars(units).values()
    for one in getattr(item, "__metadata__", ())
    if isinstance(one, Dimension)
}


def annotation_of(about: Parameter) -> Any:
    """The type of a parameter as a key of a scene."""
    dimension = _DIMENSIONS.get(about.unit) or Dimension(about.unit, "a quantity", f"1 {about.unit}")
    bounds = {"gt": about.above, "ge": about.at_least, "lt": about.below, "le": about.at_most}
    number = Annotated[
        float, dimension, Field(allow_inf_nan=False, **{k: v for k, v in bounds.items() if v is not None})
    ]
    return Annotated[list[number], Field(min_length=1, max_length=1000)] if about.several else number


def fields_of(law: type[Law]) -> dict[str, FieldInfo]:
    """The parameters of a law as fields of a table."""
    made = {}
    for key, about in law.parameters().items():
        field = made[key] = FieldInfo.from_annotation(annotation_of(about))
        field.description = sentence(about.meaning)
        level = "basic" if key in law.required() else "advanced"
        extra: dict[str, Any] = {"level": level} | ({"reason": about.source} if about.source else {})
        field.json_schema_extra = extra
        if key not in law.required():
            made[key].default = _default_of(law, key)
    return made


def sentence(text: str) -> str:
    """Return a text that begins with a capital letter and ends in a full stop."""
    return f"{text[:1].upper()}{text[1:].rstrip('.')}." if text else ""


def fields_of_family(family: str) -> dict[str, FieldInfo]:
    """`kind` and the parameters of all laws of a family."""
    laws = laws_of(family)
    kinds: Any = Literal[tuple(laws)]
    found = {"kind": FieldInfo.from_annotation(kinds)}
    found["kind"].description = "Name of the law."
    for law in laws.values():
        found = fields_of(law) | found
    return found


def plain(law: Law) -> str | dict[str, Any]:
    """A law as a scene writes it: its name, with its parameters where it has any."""
    given = {key: value for key, value in law.values().items() if value is not None}
    values = {key: list(value) if isinstance(value, tuple) else value for key, value in given.items()}
    return {"kind": law.name, **values} if values else law.name


def _any(law: type[Law]) -> bool:
    return True


@dataclass(frozen=True)
class LawKey:
    """Annotation of a law's class: the key takes a name, a table with `kind` and parameters, or a law.

    beside : whether a `LawTable` takes the parameters beside the key, too.
    usual : name of the law that a table without `kind` means; such a table is refused where it is empty.
    takes : takes(law) is False for laws of the family that the key's table refuses; they are not offered.
    """

    family: str
    beside: bool = False
    usual: str = ""
    takes: Callable[[type[Law]], bool] = _any

    def read(self, value: Any) -> Law:
        """The law.

        Raises
        ------
        ValidationError, PydanticCustomError : an unknown name, unknown or missing parameters, values out of bounds.
        """
        if isinstance(value, Law) and value.family == self.family:
            return value
        if isinstance(value, str):
            value = {"kind": value}
        if not isinstance(value, dict):
            raise problem("not a law", f"a name, or a table with kind and parameters; kinds: {', '.join(self.names())}")
        named = "kind" in value
        if not named and self.usual:
            value = {"kind": self.usual, **value}
        if "kind" not in value:
            raise problem("kind is missing", "kind = " + ", ".join(f'"{name}"' for name in self.names()))
        law = self.law_class(value)
        instead = REMOVED_LAWS.get((self.family, str(value["kind"])))
        if law is None and instead is not None:
            raise problem(f'the law "{value["kind"]}" was removed', " or ".join(f'"{name}"' for name in instead))
        if law is None:
            raise _errors(
                [_mistake("literal_error", "not allowed", value["kind"], ("kind",) if len(value) > 1 else ())]
            )
        given = {key: item for key, item in value.items() if key != "kind" and item is not None}
        mistakes, own = checked(given, law.parameters())
        mistakes += [
            _mistake("extra_forbidden", "unknown key", given[key], (key,))
            for key in given
            if key not in law.parameters()
        ]
        if mistakes:
            raise _errors(mistakes)
        missing = [key for key in law.required() if key not in own]
        if missing:
            example = ", ".join([f'kind = "{law.name}"', *(f"{key} = ..." for key in missing)])
            raise problem(
                f"the {law.name} law{'' if named else ', taken as no kind is given,'} without {' and '.join(missing)}",
                f"{' and '.join(missing)} with it, as in {{ {example} }}",
            )
        try:
            return law(**own)
        except InputError as error:
            text = "; ".join(message.partition(": ")[2] for message in error.messages)
            raise problem(text, f"other parameters of the {law.name} law") from None

    def laws(self) -> dict[str, type[Law]]:
        """Laws that the key takes, by name."""
        return {name: law for name, law in laws_of(self.family).items() if self.takes(law)}

    def names(self) -> list[str]:
        """Names of the laws."""
        return list(self.laws())

    def any_law(self) -> Law:
        """One that needs no parameters."""
        return next(law() for law in self.laws().values() if not law.required())

    def law_class(self, value: Any) -> type[Law] | None:
        """The class that a value of the key names, None if it names none."""
        if isinstance(value, Law):
            return type(value)
        name = value.get("kind", self.usual) if isinstance(value, dict) else value
        return laws_of(self.family).get(name) if isinstance(name, str) else None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """A function, so that laws may be registered at any time."""
        return core_schema.no_info_plain_validator_function(
            self.read,
            serialization=core_schema.plain_serializer_function_ser_schema(plain),
        )

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Names, or a table per law."""
        laws = self.laws()
        alone = [name for name, law in laws.items() if self.beside or not law.required()]
        tables = [
            {
                "type": "object",
                "description": (law.__doc__ or "").strip(),
                "properties": {"kind": {"const": name}, **_json_properties(fields_of(law))},
                "required": [
                    *(() if name == self.usual else ("kind",)),
                    *(() if self.beside else law.required()),
                ],
                "additionalProperties": False,
            }
            for name, law in laws.items()
        ]
        return {"anyOf": [*([{"enum": alone}] if alone else []), *tables]}


@dataclass(frozen=True)
class LawOrNumber(LawKey):
    """Annotation of a number or a law: a number as `number` allows it, or what a `LawKey` takes."""

    number: Any = None

    def read(self, value: Any) -> Any:
        """The number or the law; errors as `LawKey.read`, or those of the number."""
        if isinstance(value, Law | dict) or (isinstance(value, str) and value.isidentifier()):
            return super().read(value)
        return TypeAdapter(self.number).validate_python(value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        """As `LawKey`."""
        write = core_schema.plain_serializer_function_ser_schema(
            lambda value: plain(value) if isinstance(value, Law) else value
        )
        return core_schema.no_info_plain_validator_function(self.read, serialization=write)

    def __get_pydantic_json_schema__(
        self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """The number, or as `LawKey`."""
        laws = super().__get_pydantic_json_schema__(schema, handler)
        return {"anyOf": [TypeAdapter(self.number).json_schema(), *laws["anyOf"]]}


class LawTable(Table):
    """A table that takes parameters of its laws beside the laws' keys.

    A parameter that only other laws of a key's family have is checked and left out, so that the law can be changed by
    its name alone; one in the law's own table gives way to the one beside it.
    """

    @classmethod
    def law_keys(cls) -> dict[str, LawKey]:
        """Keys of laws whose parameters may stand beside them."""
        found = {
            name: next((m for m in f.metadata if isinstance(m, LawKey)), None) for name, f in cls.model_fields.items()
        }
        return {name: key for name, key in found.items() if key is not None and key.beside}

    @classmethod
    def fields_beside(cls) -> dict[str, FieldInfo]:
        """Parameters that may stand beside the laws' keys, as fields that need not be given."""
        found: dict[str, FieldInfo] = {}
        for key in cls.law_keys().values():
            for name, field in fields_of_family(key.family).items():
                if name != "kind" and name not in cls.model_fields:
                    if field.is_required():
                        field.default = None
                    field.json_schema_extra = {**_extra(field), "level": "advanced"}
                    found[name] = field
        return found

    @model_validator(mode="wrap")
    @classmethod
    def _parameters_beside(cls, data: Any, handler: Callable[[Any], Any]) -> Any:
        if not isinstance(data, dict):
            return handler(data)
        known: dict[str, Parameter] = {}
        for key in cls.law_keys().values():
            for law in laws_of(key.family).values():
                known |= law.parameters()
        given = {k: v for k, v in data.items() if k in known and k not in cls.model_fields and v is not None}
        rest = {k: v for k, v in data.items() if k not in known or k in cls.model_fields}
        mistakes, own = checked(given, known)
        for name, key in cls.law_keys().items():
            value = rest.get(name, cls.model_fields[name].default)
            chosen = key.law_class(value)
            beside = {k: own[k] for k in own if chosen is not None and k in chosen.parameters()}
            if chosen is not None and any(k in chosen.parameters() and k not in own for k in given):
                rest[name] = key.any_law()  # the parameter's own message says it all
            elif chosen is not None and beside:
                table = plain(value) if isinstance(value, Law) else value
                rest[name] = (table if isinstance(table, dict) else {"kind": table}) | beside
        try:
            made = handler(rest)
        except ValidationError as error:
            mistakes = [
                _mistake(m["type"], m["msg"], m["input"], m["loc"], m.get("ctx")) for m in error.errors()
            ] + mistakes
        if mistakes:
            raise _errors(mistakes)
        return made

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """The parameters beside the laws' keys are properties like any other."""
        table.setdefault("properties", {}).update(_json_properties(cls.fields_beside()))
        super().short_forms(table)


def checked(
    given: Mapping[str, Any], parameters: Mapping[str, Parameter]
) -> tuple[list[InitErrorDetails], dict[str, Any]]:
    """Mistakes in the values of parameters, and the values in SI units."""
    mistakes: list[InitErrorDetails] = []
    values = {}
    for key, value in given.items():
        if key not in parameters:
            continue
        try:
            values[key] = TypeAdapter(annotation_of(parameters[key])).validate_python(value)
        except ValidationError as error:
            mistakes += [
                _mistake(m["type"], m["msg"], m["input"], (key, *m["loc"]), m.get("ctx")) for m in error.errors()
            ]
    return mistakes, values


def _extra(field: FieldInfo) -> dict[str, Any]:
    extra = field.json_schema_extra
    return dict(extra) if isinstance(extra, dict) else {}


def _default_of(law: type[Law], key: str) -> Any:
    value = law.__dataclass_fields__[key].default
    return list(value) if isinstance(value, tuple) else value


def _mistake(
    kind: str, text: str, value: Any, place: tuple[int | str, ...], context: dict[str, Any] | None = None
) -> InitErrorDetails:
    # braces would be read as places for values
    safe = text.replace("{", "(").replace("}", ")")
    return InitErrorDetails(type=PydanticCustomError(kind, safe, context), loc=place, input=value)


def _errors(mistakes: list[InitErrorDetails]) -> ValidationError:
    return ValidationError.from_exception_data("scene", mistakes)


def _json_properties(fields: Mapping[str, FieldInfo]) -> dict[str, Any]:
    made = {}
    for name, field in fields.items():
        whole: Any = Annotated[field.annotation, *field.metadata]
        made[name] = TypeAdapter(whole).json_schema() | _extra(field)
        if field.description:
            made[name]["description"] = field.description
        if not field.is_required() and field.default is not None:
            made[name]["default"] = field.default
    return made
