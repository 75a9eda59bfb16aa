"""Natives of the tab Sets that read, cut and change texts."""

from __future__ import annotations

import fnmatch
import re
from typing import Any

from hookean_canvas.run.natives.declare import Unfit, native

_TEXT = "Text (T): text"
_CULTURE = "Culture (C): any optional"
LONGEST = 5_000  # characters of which all pairs are compared


def text_of(value: Any) -> str:
    """A value as Grasshopper writes it in a text: numbers in the fewest digits, points in braces."""
    if isinstance(value, float):
        return f"{value:.15g}"
    if hasattr(value, "Z") and hasattr(value, "X"):
        return "{" + ", ".join(f"{one:.15g}" for one in (value.X, value.Y, value.Z)) + "}"
    return "" if value is None else str(value)


@native("dca05f6f-e3d9-42e3-b3bb-eb20363fb335", "Text Length", "Len", _TEXT, "Length (L)")
def text_length(text: str) -> int:
    """How many characters a text has."""
    return len(text)


@native("86503240-d884-43f9-9323-efe30488a6e1", "Characters", "Chars", _TEXT, "Characters (C): list; Unicode (U): list")
def characters(text: str) -> tuple[list[str], list[int]]:
    """The characters of a text, and their Unicode values."""
    return list(text), [ord(letter) for letter in text]


@native("b1991128-8bf1-4dea-8497-4b7188a64e9d", "Text Case", "Case", f"{_TEXT}; {_CULTURE}",
        "Upper Case (U); Lower Case (L)")  # fmt: skip
def text_case(text: str, culture: Any) -> tuple[str, str]:
    """A text in upper case and in lower case."""
    return text.upper(), text.lower()


@native("07e0811f-034a-4504-bca0-2d03b2c46217", "Text Fragment", "Fragment",
        f"{_TEXT}; Start (i): integer; Count (N): integer optional", "Fragment (F)")  # fmt: skip
def text_fragment(text: str, start: int, count: int | None) -> str:
    """So many characters of a text from a number on; the rest where there is no count."""
    if start < 0 or (count is not None and count < 0):
        raise Unfit("Start and Count must not be negative")
    return text[start:] if count is None else text[start : start + count]


@native("e4cb7168-5e32-4c54-b425-5a31c6fd685a", "Text Trim", "Trim",
        f"{_TEXT}; Start (S): boolean = True; End (E): boolean = True", "Result (R)")  # fmt: skip
def text_trim(text: str, start: bool, end: bool) -> str:
    """A text without spaces at its start and its end."""
    return (text.lstrip() if start else text).rstrip() if end else text.lstrip() if start else text


@native("4df8df00-3635-45bd-95e6-f9206296c110", "Replace Text", "Rep",
        f"{_TEXT}; Find (F): text; Replace (R): text optional", "Result (R)")  # fmt: skip
def replace_text(text: str, find: str, instead: str | None) -> str:
    """A text with another fragment in the place of each occurrence of one."""
    if not find:
        raise Unfit("Find is empty")
    return text.replace(find, instead or "")


@native("f7608c4d-836c-4adf-9d1f-3b04e6a2647d", "Text Distance", "TDist",
        "Text A (A): text; Text B (B): text; Case (C): boolean = False", "Distance (D)")  # fmt: skip
def text_distance(a: str, b: str, case: bool) -> int:
    """The least number of letters put in, taken out or changed that makes one text of the other (Levenshtein, 1966)."""
    if max(len(a), len(b)) > LONGEST:
        raise Unfit(f"texts of more than {LONGEST} characters are not compared")
    a, b = (a, b) if case else (a.lower(), b.lower())
    row = list(range(len(b) + 1))
    for i, letter in enumerate(a, 1):
        before, row[0] = row[0], i
        for j, other in enumerate(b, 1):
            before, row[j] = row[j], min(row[j] + 1, row[j - 1] + 1, before + (letter != other))
    return row[-1]


@native("3756c55f-95c3-442c-a027-6b3ab0455a94", "Match Text", "TMatch",
        f"{_TEXT}; Pattern (P): text optional; RegEx (R): text optional; Case (C): boolean = False",
        "Match (M)", remark="patterns of RegEx are Python's; longer than 200 characters they are refused")  # fmt: skip
def match_text(text: str, pattern: str | None, expression: str | None, case: bool) -> bool:
    """Whether a text has a pattern with * and ?, and a regular expression, each where one is given."""
    fits = True
    if pattern is not None:
        one, other = (text, pattern) if case else (text.lower(), pattern.lower())
        fits = fnmatch.fnmatchcase(one, other)
    if expression is not None:
        if len(expression) > 200 or len(text) > LONGEST or re.search(r"[*+})][*+{]", expression):
            raise Unfit("this expression may take too long; write it without repeated groups")
        try:
            fits &= re.search(expression, text, 0 if case else re.IGNORECASE) is not None
        except re.error as error:
            raise Unfit(f"RegEx: {error}") from None
    return fits


@native("cec16c67-7b8b-41f7-a5a5-f675177e524b", "Sort Text", "TSort",
        f"Keys (K): text list; Values (V): any list optional; {_CULTURE}",
        "Keys (K): list; Values (V): list")  # fmt: skip
def sort_text(keys: list[str], values: list[Any] | None, culture: Any) -> tuple[list[str], list[Any]]:
    """Texts in alphabetical order, capital letters beside small ones, and other values in the same order."""
    order = sorted(range(len(keys)), key=lambda i: (keys[i].casefold(), keys[i].swapcase()))
    others = values or []
    return [keys[i] for i in order], [others[i] for i in order if i < len(others)]


_FIELD = re.compile(r"\{(\d+)(?::([^{}]*))?\}")


@native("758d91a0-4aec-47f8-9671-16739a8a2c5d", "Format", "Format",
        "Format (F): text; Culture (C): any optional; Data 0 (0): any optional; Data 1 (1): any optional ...",
        "Text (T)", remark="of formats of numbers 0, 0.00, F2, N2, D3, E2, P1 and the like are known")  # fmt: skip
def format_text(text: str, culture: Any, *values: Any) -> str:
    """A text with values in the places {0}, {1} ..., numbers by a format as {0:0.00}."""

    def filled(found: re.Match[str]) -> str:
        number = int(found[1])
        if number >= len(values):
            raise Unfit(f"there is no Data {number}")
        return formatted(values[number], found[2] or "")

    return _FIELD.sub(filled, text.replace("{{", "\0").replace("}}", "\1")).replace("\0", "{").replace("\1", "}")


_STANDARD = re.compile(r"([FfNnDdEePpRrGg])(\d{0,2})")
_CUSTOM = re.compile(r"(#,##)?(#|0+)?(?:\.(0*)(#*))?(%?)")


def formatted(value: Any, form: str) -> str:
    """A value by a .NET format; Unfit for one that is not known here."""
    if not form or isinstance(value, (bool, str)) or not isinstance(value, (int, float)):
        return text_of(value)
    standard = _STANDARD.fullmatch(form)
    if standard is not None:
        kind, digits = standard[1].upper(), int(standard[2] or (0 if standard[1].upper() == "D" else 2))
        if kind in "RG":
            return text_of(value)
        if kind == "D":
            return f"{round(value):0{digits + (value < 0)}d}"
        if kind == "P":
            return f"{100.0 * value:,.{digits}f} %"
        return f"{value:{',' if kind == 'N' else ''}.{digits}{'E' if kind == 'E' else 'f'}}"
    custom = _CUSTOM.fullmatch(form)
    if custom is None:
        raise Unfit(f"the format {form} is not known here")
    thousands, whole, fixed, loose, percent = custom.groups()
    number = 100.0 * value if percent else value
    found = f"{abs(number):{',' if thousands else ''}.{len(fixed or '') + len(loose or '')}f}"
    for _ in loose or "":
        found = found.removesuffix("0")
    before, dot, after = found.removesuffix(".").partition(".")
    width = len(whole) if whole and "#" not in whole else 0
    sign = "-" if number < 0.0 and float(found.replace(",", "")) != 0.0 else ""
    return f"{sign}{before.zfill(width)}{dot}{after}{percent or ''}"
