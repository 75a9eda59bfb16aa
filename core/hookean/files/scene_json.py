"""Scenes as JSON: read strictly (no repeated keys, no NaN, no endless nesting), written canonically."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from hookean.errors import InputError
from hookean.scene import Scene

DEEPEST = 64


def parse(text: str | bytes | bytearray, where: str = "/") -> Any:
    """JSON text to Python values; InputError where it is not strict JSON or nests deeper than 64 levels. Bytes may
    begin with a byte order mark, as programs on Windows write it."""
    try:
        text = text.decode("utf-8-sig") if isinstance(text, bytes | bytearray) else text
    except UnicodeDecodeError:
        raise InputError(where, "the text is not UTF-8; save it as UTF-8 and try again") from None
    try:
        value = json.loads(text, object_pairs_hook=_unique, parse_constant=_not_json)
    except json.JSONDecodeError as error:
        raise InputError(where, f"not valid JSON: {error.msg} in line {error.lineno}, column {error.colno}") from None
    except RecursionError:
        raise InputError(where, f"nested too deeply; a scene needs fewer than {DEEPEST} levels") from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(where, "a whole number with too many digits; write it as a decimal number") from None
    return value


def read(path: str | Path) -> Scene:
    """The scene in a JSON file; InputError with the place and one sentence."""
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise InputError(str(path), f"cannot be read ({error.strerror}); give the path of a JSON file") from None
    return Scene.read(data)


def write(scene: Scene, path: str | Path) -> None:
    """Write the scene in its canonical form."""
    Path(path).write_text(scene.canonical + "\n", encoding="utf-8")


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    value = dict(pairs)
    if len(value) != len(pairs):
        seen: set[str] = set()
        twice = next(key for key, _ in pairs if key in seen or seen.add(key))  # type: ignore[func-returns-value]
        raise InputError(f"/{twice}", "this key is given twice in one object; keep one of them")
    return value


def _not_json(name: str) -> Any:
    raise InputError("/", f"{name} is not a number in JSON; every number of a scene must be finite")
