"""Faults of what is given to a model: errors of pydantic as pointers and sentences."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterator
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from hookean.errors import InputError, several
from hookean.values.by_kind import ByKind

SUGGESTED = 100  # faults with a nearest known name: to look for it takes as long as to read a force


def first_fault(error: ValidationError) -> InputError:
    """The faults of a validation error as one; its sentence is the first one and has how many more there are."""
    return several(faults(error))


def faults(error: ValidationError) -> list[InputError]:
    """Every fault of a validation error as pointer and sentence."""
    found = []
    kinds = {model.called for model in _models() if "kind" in model.model_fields}
    root = next((model for model in _models() if model.__name__ == error.title), None)
    for number, entry in enumerate(_of_unions(error.errors(include_url=False))):
        context = entry.get("ctx", {})
        steps = [_cut(str(step)) for step in _pointed(entry["loc"], kinds)]
        pointer = "".join(f"/{step.replace('~', '~0').replace('/', '~1')}" for step in steps)
        pointer += str(context.get("at", ""))
        sentence = str(context.get("sentence") or _sentence(entry, root if number < SUGGESTED else None))
        found.append(InputError(pointer or "/", sentence))
    return found


def _of_unions(entries: Any) -> list[Any]:
    """Faults with one for each value that may be of several types, where pydantic has one for each type: of a text or a
    number one; where names or a list are allowed that of the names for a text, and those of the list for all else."""
    found: list[Any] = []
    for entry in entries:
        place, kind = entry["loc"], entry["type"]
        last = found[-1] if found else None
        if kind == "int_type" and place[-1] == "int" and last is not None and last["loc"] == (*place[:-1], "str"):
            found[-1] = {**last, "loc": place[:-1], "type": "text_or_number"}
            continue
        cut = next((i for i, step in enumerate(place) if str(step).startswith("tuple[")), None)
        names = [e for e in found if e["type"] == "literal_error" and e["loc"][:-1] == place[:cut]] if cut else []
        if names and isinstance(names[0]["input"], str):
            names[0]["ctx"] = {**names[0]["ctx"], "or_a_list": True}
            continue
        found = [e for e in found if e not in names]
        found.append(entry)
    return found


def _cut(name: str) -> str:
    """A name without its end where it is longer than any of ours."""
    return name if len(name) <= 200 else f"{name[:200]}..."


def _pointed(place: tuple[int | str, ...], kinds: set[str]) -> Iterator[int | str]:
    """The steps of a location that a pointer has: not the class of a union that pydantic names, nor the quantity of a
    goal, whose fields are given beside those of the goal."""
    for i, step in enumerate(place):
        chosen = step in kinds and i >= 2 and (place[i - 2] in ("forces", "add") or place[i - 1] == "quantity")
        if not (chosen or step == "quantity" or str(step).startswith(("literal[", "tuple["))):
            yield step


def _sentence(entry: Any, root: Any) -> str:
    """An error of pydantic as a sentence: what was given, what is allowed."""
    kind, context, given = entry["type"], entry.get("ctx", {}), _shown(entry["input"])
    if kind in ("extra_forbidden", "missing"):
        name, options = str(entry["loc"][-1]), _options(root, entry["loc"][:-1])
        if len(options) != 1:
            return f"unknown field {_shown(name)}" if kind == "extra_forbidden" else f"{name} is required"
        owner = options[0]
        if kind == "missing":
            field = owner.model_fields.get(name)
            return f"{name} is required: {field.description}" if field and field.description else f"{name} is required"
        return f"{owner.called} has no field {_shown(name)}; {_meant(name, list(owner.model_fields), 'its fields:')}"
    if kind == "union_tag_invalid":
        known = re.findall(r"'([^']*)'", context["expected_tags"])
        return f"unknown kind {_shown(context['tag'])}; {_meant(context['tag'], known, 'known:', always=True)}"
    if kind == "union_tag_not_found":
        return f"kind is required; known: {', '.join(option.called for option in _options(root, entry['loc']))}"
    if kind == "literal_error":
        allowed = [option or '""' for option in re.findall(r"'([^']*)'", context["expected"])]
        if not isinstance(entry["input"], str):
            return f"{given} given; a text expected, one of {', '.join(allowed)}"
        more = ", or a list" if context.get("or_a_list") else ""
        return f"{given} given; {_meant(str(entry['input']), allowed, 'allowed:', always=True)}{more}"
    for rule, key, words in _LIMITS:
        if kind == rule:
            return f"{given} given; {words} {context[key]:g} allowed"
    expected = next((words for start, words in _EXPECTED.items() if kind.startswith(start)), "")
    if isinstance(entry["input"], str):
        given = "a text"  # it may be anything, and long
    return f"{given} given; {expected} expected" if expected else str(entry["msg"])


_LIMITS = (
    ("greater_than", "gt", "more than"),
    ("greater_than_equal", "ge", "at least"),
    ("less_than", "lt", "less than"),
    ("less_than_equal", "le", "at most"),
)
_EXPECTED = {
    "tuple_type": "a list",
    "list_type": "a list",
    "dict_type": "an object of names and values",
    "model_": "an object of names and values",
    "string_type": "a text",
    "text_or_number": "a text or a whole number",
    "bool_": "true or false",
    "int_": "a whole number",
    "float_": "a number",
    "finite_number": "a finite number",
}


def _meant(given: Any, known: list[str], introduction: str, *, always: bool = False) -> str:
    """The nearest known name as a question, or all of them; with `always` both."""
    near = difflib.get_close_matches(str(given)[:60].lower(), {n.lower(): n for n in known}, 1)
    nearest = next((n for n in known if near and n.lower() == near[0]), None)
    listed = f"{introduction} {', '.join(known)}"
    if nearest is None:
        return listed
    return f"did you mean {nearest}? ({listed})" if always else f"did you mean {nearest}?"


def _shown(value: Any) -> str:
    """A given value as JSON, if it is short; else its type."""
    if isinstance(value, int) and abs(value) >= 10**80:
        return "a number of more than 80 digits"
    if isinstance(value, str | int | float) or value is None:
        text = json.dumps(value if not isinstance(value, str) else value[:60])
        return text if len(text) <= 80 else f"{text[:60]}..."
    if isinstance(value, dict):
        return "an object"
    return "a list" if isinstance(value, list | tuple) else type(value).__name__


def _models() -> Iterator[Any]:
    """All classes of ours: those with a name for sentences, `called`."""
    waiting: list[Any] = [BaseModel]
    for model in waiting:
        waiting += model.__subclasses__()
        if hasattr(model, "called"):
            yield model


def _options(root: Any, place: tuple[Any, ...]) -> list[Any]:
    """The models that may be at a location within `root`, found by the annotations of fields."""
    hints: list[Any] = [root]
    for step in place:
        hints = [inner for hint in hints for inner in _inside(hint, step)]
    return [h for hint in hints for h in _alternatives(hint) if _is_model(h)]


def _is_model(hint: Any) -> bool:
    return isinstance(hint, type) and issubclass(hint, BaseModel)


def _alternatives(hint: Any) -> list[Any]:
    """A hint without `Annotated`, and the members of a union."""
    if get_origin(hint) is Annotated:
        plain, *notes = get_args(hint)
        kinds = [model for note in notes if isinstance(note, ByKind) for model in note.models.values()]
        return kinds or _alternatives(plain)
    if get_origin(hint) in (Union, UnionType):
        return [a for member in get_args(hint) for a in _alternatives(member)]
    return [hint]


def _inside(hint: Any, step: Any) -> list[Any]:
    """The hints one step of a location further in."""
    found: list[Any] = []
    for option in _alternatives(hint):
        origin, inner = get_origin(option), get_args(option)
        if origin in (tuple, list):
            found += [a for a in inner if a is not Ellipsis]
        elif origin is dict:
            found.append(inner[1])
        elif _is_model(option):
            if step in option.model_fields:
                field = option.model_fields[step]  # pydantic takes the notes of its annotation apart
                found.append(Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation)
            elif "kind" in option.model_fields and step == option.called:
                found.append(option)
    return found
