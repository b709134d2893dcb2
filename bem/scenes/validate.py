"""From a table of plain values to a validated scene, or every mistake in it at once, each in one line."""

from __future__ import annotations

import re
import typing
from collections.abc import Iterable, Sequence
from typing import Any, Literal, TypeVar, get_args, get_origin

from pydantic import BaseModel, ValidationError

from bem.arguments import did_you_mean
from bem.errors import InputError
from bem.laws import Law, laws_of
from bem.materials import CATALOGUE
from bem.plausibility import range_of_key
from bem.scenes.laws import LawOrNumber
from bem.scenes.units import Dimension, Number
from bem.scenes.walk import fields_of_table, literals, members_of, unwrap, without_none

_BARE = re.compile(r"[A-Za-z0-9_-]{1,64}")
MOST_MESSAGES = 20
REMOVED_KEYS = {
    "sharing.striated_exit": "removed; leave it out: the film's friction ends at its exit, without the 2 to 8 % of oil "
    "streamers behind it",
    "oil.name": "unknown key; write grade, a name that `bem oils` lists, such as grade = "
    '"ISO VG 32", "water-glycol 46" or "water", or viscosity of a liquid of your own',
}
"""Keys that scenes of earlier versions had or that users expect, and what to write in their place."""
_INSTEAD = {
    "coating": (
        "layer",
        'layer = { material = "dlc", thickness = "1 um" }, or layers = [{ ... }, { ... }], outermost first',
    ),
    "diameter": ("radius", "radius, half of the diameter"),
}
"""Keys that users expect: a key of the same table that stands in their place, and what to write."""
_PULLED = (
    "; an adhesive contact is pulled by negative loads in contact.load_path, or by contact.approach_path and approach"
)
Model = TypeVar("Model", bound=BaseModel)


def validate(data: Any, model: type[Model]) -> Model:
    """`data` as `model`.

    Raises
    ------
    InputError : one message per mistake, naming key, value, what is allowed and the nearest right spelling.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        mistakes = error.errors(include_url=False)
    except RecursionError:
        raise InputError("scene: tables are nested too deeply; allowed: the few levels that scenes have") from None
    found = [_message(mistake, data, model) for mistake in mistakes[:MOST_MESSAGES]]
    more = len(mistakes) - len(found)
    raise InputError([*dict.fromkeys(found), *([f"and {more} more mistakes"] if more else [])])


def capped(messages: Sequence[str]) -> list[str]:
    """The first messages, and how many more there are."""
    more = len(messages) - MOST_MESSAGES
    return [*messages[:MOST_MESSAGES], *([f"and {more} more mistakes"] if more > 0 else [])]


def nearest(word: str, names: Iterable[str]) -> str:
    """` - did you mean "..."?` for the nearest of `names`, or nothing; see `bem.arguments.did_you_mean`."""
    return did_you_mean(word, names)


def show(value: Any) -> str:
    """A value as a user would have written it, shortened."""
    if isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, str):
        text = '"' + value.encode("unicode_escape").decode() + '"'
    elif isinstance(value, int) and abs(value) > 10**20:
        text = "an integer of more than 20 digits"
    else:
        try:
            text = repr(value)
        except (RecursionError, ValueError):
            text = type(value).__name__
    return text if len(text) <= 60 else text[:57] + "..."


def _message(mistake: Any, data: Any, model: type[BaseModel]) -> str:
    """One line for one of pydantic's errors."""
    kind, context = mistake["type"], mistake.get("ctx", {})
    key, annotation, metadata = _locate(mistake["loc"], data, model)
    value = mistake.get("input")
    where = f"{key} = {show(value)}" if key else "scene"
    dimension = next((item for item in _spread(metadata) if isinstance(item, Dimension)), None)
    allowed = f"; allowed: {dimension.allowed}" if dimension else ""
    if kind == "extra_forbidden" and key in REMOVED_KEYS:
        return f"{key}: {REMOVED_KEYS[key]}"
    if kind == "extra_forbidden":
        parent, _, last = key.rpartition(".")
        names = _names_at(mistake["loc"][:-1], data, model)
        names = sorted({*names, *(getattr(model, "OTHER_KEYS", ()) if not parent else ())})
        place = f"in {parent}" if parent else "at the top of the scene"
        if (written := _INSTEAD.get(last)) is not None and written[0] in names:
            return f"{key}: unknown key; write {written[1]}"
        hint = nearest(last, names) or _elsewhere(last, parent, model)
        return f"{key}: unknown key{hint}; allowed {place}: {', '.join(names)}"
    if kind == "missing":
        meaning = _meaning(mistake["loc"], data, model)
        return f"{key}: missing{f' ({meaning})' if meaning else ''}{allowed or _choices(annotation)}"
    if kind == "literal_error":
        either = f", or {dimension.allowed}" if dimension else ""
        if numbers := _literal_numbers(annotation):
            quoted = " (a number without quotes)" if isinstance(value, str) else ""
            return f"{where}: not allowed; allowed: {', '.join(map(str, numbers))}{quoted}{either}"
        return f"{where}: not allowed{nearest(value, literals(annotation))}{_choices(annotation)}{either}"
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        names = [name.strip().strip("'") for name in str(context.get("expected_tags", "")).split(",") if name.strip()]
        names = names or sorted(_tags(annotation))
        found = value.get("kind") if isinstance(value, dict) else None
        listed = ", ".join(f'"{name}"' for name in names)
        if found is None:
            return f"{key}.kind: missing; allowed: {listed}"
        return f"{key}.kind = {show(found)}: not allowed{nearest(str(found), names)}; allowed: {listed}"
    if kind == "unknown_name":
        found, names = context["found"], context["names"]
        meant = CATALOGUE.meant(found)
        hint = f' - did you mean "{meant}"?' if meant in names else nearest(found, names)
        own = ""
        if "catalogue of materials" in str(mistake["msg"]):
            own = "a table with youngs_modulus, poissons_ratio and other constants, or one of "
        return f'{key} = "{found}": {mistake["msg"]}{hint}; allowed: {own}{", ".join(names)}'
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return f"{where}: not a table; allowed: a table with {', '.join(sorted(fields_of_table(annotation)))}"
    if kind == "quantity":
        return f"{where}: {mistake['msg']}"
    if kind == "scene":
        out = [f"--set {key + '.' if key else ''}{name}=" for name in context.get("given", ())]
        take = f"; take the other out with {' or '.join(out)}" if out else ""
        bare = _numbers_without_unit(mistake["msg"], value, annotation)
        return f"{key or 'scene'}{_scalar(value)}: {mistake['msg']}{take}{bare}"
    if kind in ("too_long", "too_short") and "actual_length" in context:
        most, least = context.get("max_length"), context.get("min_length")
        many = f"{least} or more" if most is None else f"{most} or fewer"
        if str(context.get("field_type")) == "Tuple":
            meaning = _meaning(mistake["loc"], data, model)
            many = str(least if most is None else most) + (f" ({meaning})" if meaning else "")
        return f"{where}: {context['actual_length']} values; allowed: {many}{allowed.replace('; allowed:', ', each')}"
    if kind == "tuple_type":
        return f"{where}: not a list; allowed: {_listed(annotation)}"
    text = str(mistake["msg"]).replace("Input should be", "must be").replace("Input should have", "must have")
    if kind.startswith(("greater_than", "less_than")) and dimension and dimension.unit:
        text += f" {dimension.unit}"
    if kind.startswith("less_than") and dimension and dimension.unit and _is_number(value):
        text += f" (a number without a unit is in {dimension.unit})"
    if kind.startswith("greater_than") and key in ("contact.load", "contact.mean_pressure"):
        allowed += _PULLED * ("load_path" in _names_at(mistake["loc"][:-1], data, model))
    return f"{where}: {text}{allowed}"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _numbers_without_unit(message: str, table: Any, annotation: Any) -> str:
    """Return which numbers of a table have no unit, and in which they are read: those of keys that a message names, and
    those outside their usual range."""
    if not isinstance(table, dict):
        return ""
    fields, found = fields_of_table(without_none(annotation)), []
    for name, value in table.items():
        if not _is_number(value):
            continue
        metadata = () if name not in fields else _metadata_of(fields[name])
        dimension = next((item for item in _spread(metadata) if isinstance(item, Dimension)), None)
        if name in fields and (dimension is None or not dimension.unit):
            continue
        usual = None if dimension is None else range_of_key(str(name), dimension.unit)
        unusual = usual is not None and not usual.low <= abs(value) <= usual.high
        spelled = re.escape(str(name)).replace("_", "[_ ]")
        if not unusual and not re.search(rf"\b{spelled}\b", message):
            continue
        read = f"as {value:g} {dimension.unit}" if dimension is not None else "in SI units"
        found.append(f"{name} = {value:g} has no unit and is read {read}")
    return "".join(f"; {words}" for words in found)


def _metadata_of(field: Any) -> list[Any]:
    """Return the metadata of a field, those within a union with None included."""
    return [*field.metadata, *unwrap(without_none(field.annotation))[1]]


def _listed(annotation: Any) -> str:
    """Return how many values a list of fixed length has, with an example where they are quantities."""
    each = get_args(without_none(annotation))
    found = (item for item in _spread(unwrap(each[0])[1]) if isinstance(item, Dimension)) if each else iter(())
    dimension = next(found, None)
    if dimension is None or Ellipsis in each:
        return f"a list of {len(each)} values" if each and Ellipsis not in each else "a list"
    example = dimension.example if isinstance(dimension, Number) or not dimension.unit else f'"{dimension.example}"'
    return f"a list of {len(each)} values, such as [{', '.join([example] * len(each))}]"


def _meaning(loc: Sequence[Any], data: Any, model: type[BaseModel]) -> str:
    """Description of the key there, without its full stop; empty where the key has none."""
    annotation = without_none(_locate(loc[:-1], data, model)[1])
    field = fields_of_table(annotation).get(loc[-1])
    return str(getattr(field, "description", None) or "").rstrip(".")


def _elsewhere(word: str, parent: str, model: type[BaseModel]) -> str:
    """Return the places where a key that is not allowed in a table would be: at the top, or in other tables of the
    top; or nothing."""
    top = fields_of_table(model)
    if parent and word in top:
        return f" - it is a key at the top of the scene: [{word}]"
    tables = [
        name
        for name, field in top.items()
        if name != parent and word in fields_of_table(unwrap(without_none(field.annotation))[0])
    ]
    return f" - it is a key of {' and of '.join(f'[{name}]' for name in tables)}" if tables else ""


def _spread(metadata: Sequence[Any]) -> Iterable[Any]:
    """The metadata with those of numbers in whose place a law may stand."""
    for item in metadata:
        yield from unwrap(item.number)[1] if isinstance(item, LawOrNumber) else (item,)


def _names_at(loc: Sequence[Any], data: Any, model: type[BaseModel]) -> Iterable[str]:
    """Keys of the table there."""
    annotation = _locate(loc, data, model)[1]
    raw = data
    for part in loc:
        raw = raw[part] if isinstance(raw, dict | list) and (isinstance(part, int) or part in raw) else None
    law = law_at(without_none(annotation), raw)
    return fields_of_table(annotation) if law is None else ["kind", *fields_of_table(law)]


def _scalar(value: Any) -> str:
    return f" = {show(value)}" if isinstance(value, bool | int | float | str) else ""


def _locate(loc: Sequence[Any], data: Any, model: type[BaseModel]) -> tuple[str, Any, Sequence[Any]]:
    """The key as the user wrote it, without tags of unions, and the annotation and metadata of the field there."""
    key = ""
    annotation: Any = model
    metadata: Sequence[Any] = ()
    raw = data
    for part in loc:
        annotation = without_none(annotation)
        if isinstance(part, int):
            arguments = typing.get_args(annotation)
            if arguments:
                annotation, inner = unwrap(arguments[min(part, len(arguments) - 1)])
                metadata = inner or metadata
            if isinstance(raw, list | tuple):
                key += f"[{part}]"
                raw = raw[part] if part < len(raw) else None
            continue
        member = member_of(annotation, part)
        if member is not None:
            annotation = member
            continue
        shown = part if _BARE.fullmatch(str(part)) else show(part)
        key = f"{key}.{shown}" if key else str(shown)
        law = law_at(annotation, raw)
        field = fields_of_table(law or annotation).get(part)
        if field is not None:
            annotation, metadata = field.annotation, tuple(field.metadata)
            bare, inner = unwrap(without_none(annotation))
            annotation, metadata = bare, (*metadata, *inner)
        else:
            annotation, metadata = None, ()
        raw = raw.get(part) if isinstance(raw, dict) else None
    return key, annotation, metadata


def law_at(annotation: Any, raw: Any) -> type[Law] | None:
    """The law that a table of a scene means, where laws of that family may stand."""
    if not (isinstance(annotation, type) and issubclass(annotation, Law) and isinstance(raw, dict)):
        return None
    return laws_of(annotation.family).get(str(raw.get("kind")))


def is_pair(loc: Sequence[Any], data: Any, model: type[BaseModel]) -> bool:
    """Return True if the field at these keys holds two values, one for each axis."""
    arguments = typing.get_args(without_none(_locate(loc, data, model)[1]))
    return len(arguments) == 2 and Ellipsis not in arguments


def member_of(annotation: Any, tag: Any) -> Any:
    """The member of a union of tables whose `kind` is `tag`."""
    for item in members_of(annotation):
        kind = fields_of_table(item).get("kind")
        if kind is not None and tag in typing.get_args(kind.annotation):
            return item
    return None


def _tags(annotation: Any) -> list[str]:
    return [
        tag
        for item in members_of(annotation)
        if "kind" in fields_of_table(item)
        for tag in typing.get_args(fields_of_table(item)["kind"].annotation)
    ]


def _literal_numbers(annotation: Any) -> list[int]:
    """Return the values of a literal whose values all are numbers; none of other annotations."""
    annotation = without_none(annotation)
    values = list(get_args(annotation)) if get_origin(annotation) is Literal else []
    return values if all(isinstance(item, int) and not isinstance(item, bool) for item in values) else []


def _choices(annotation: Any) -> str:
    names = literals(annotation)
    if names:
        return "; allowed: " + ", ".join(f'"{name}"' for name in names)
    names = sorted(fields_of_table(annotation))
    return f"; allowed: a table with {', '.join(names)}" if names else ""
