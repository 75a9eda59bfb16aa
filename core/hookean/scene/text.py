"""Texts as values: JSON read strictly (no repeated keys, no NaN, no endless nesting), and TOML."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

from hookean.errors import InputError

DEEPEST = 64


def parse(text: str | bytes | bytearray, where: str = "/") -> Any:
    """JSON text to Python values; InputError where it is not strict JSON or nests deeper than 64 levels. Bytes may
    begin with a byte order mark, as programs on Windows write it."""
    try:
        text = text.decode("utf-8-sig") if isinstance(text, bytes | bytearray) else text
    except UnicodeDecodeError:
        raise InputError(where, "the text is not UTF-8; save it as UTF-8 and try again") from None
    if not text.strip():
        raise InputError(where, "the text is empty; give JSON")
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
    if re.search(r"\\u[dD][89a-fA-F]", text) and (half := _half_a_character(value)):
        raise InputError(where, f"{half} is half of a character, which no file can hold; write both halves or neither")
    return value


def parse_tables(text: str, name: str = "recipe") -> dict[str, Any]:
    """Tables from TOML, or from JSON where the text starts with a brace; InputError naming line and column."""
    if text.lstrip("\ufeff \t\r\n").startswith("{"):
        return dict(parse(text.lstrip("\ufeff"), name))
    plain = text.lstrip("\ufeff").replace("\r\n", "\n")
    try:
        return tomllib.loads(plain)
    except tomllib.TOMLDecodeError as error:
        raise _not_toml(plain, name, str(error)) from None
    except RecursionError:
        raise InputError(name, f"nested too deeply; a scene needs fewer than {DEEPEST} levels") from None
    except ValueError:  # of int(), which reads at most some thousand digits
        raise InputError(name, "a whole number with too many digits; write it as a decimal number") from None


def _half_a_character(value: Any) -> str:
    """The first surrogate of a text in a value that is not one of a pair, as JSON writes it; else nothing."""
    try:
        json.dumps(value, ensure_ascii=False).encode()
    except UnicodeEncodeError as error:
        return f"\\u{ord(error.object[error.start]):04x}"
    return ""


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    value = dict(pairs)
    if len(value) != len(pairs):
        seen: set[str] = set()
        twice = next(key for key, _ in pairs if key in seen or seen.add(key))  # type: ignore[func-returns-value]
        raise InputError(f"/{twice}", "this key is given twice in one object; keep one of them")
    return value


def _not_json(name: str) -> Any:
    raise InputError("/", f"{name} is not a number in JSON; every number of a scene must be finite")


def _not_toml(text: str, name: str, said: str) -> InputError:
    """What is wrong with a text that is no TOML: the line it names, and a decimal comma there."""
    suffix = Path(name).suffix.lower()
    if suffix not in (".toml", ".json", ""):
        return InputError(name, "is not TOML or JSON; give a file that ends in .toml or .json")
    place = re.search(r"at line (\d+)", said)
    lines = text.splitlines()
    line = lines[int(place[1]) - 1].strip() if place and int(place[1]) <= len(lines) else ""
    comma = re.search(r"=\s*([-+]?\d+),(\d+)\s*(?:#.*)?$", line)
    hint = f"; write decimals with a point: {comma[1]}.{comma[2]}" if comma else ""
    quoted = f": {line[:80]}" if line else ""
    return InputError(name, f"not valid TOML: {said}{quoted}{hint}")
