"""Cells of CSV files as text that no spreadsheet takes for a formula.

A name in a drawing can be `=HYPERLINK(...)`: a spreadsheet that opens the table would run it. Such text gets an
apostrophe in front, as OWASP advises (CSV Injection); numbers stay numbers, negative ones too.
"""

from __future__ import annotations

import re
from typing import Any

_FORMULA = re.compile(r"[=+\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(inf|nan)", re.ASCII)


def cell(value: Any) -> Any:
    """What stands for a value in a row of a CSV file: text that begins like a formula (=, +, -, @, tab, line end, or
    their wide forms) with an apostrophe in front; everything else, text that is a number included, as it is."""
    if isinstance(value, str) and _FORMULA.match(value) and not _NUMBER.fullmatch(value):
        return f"'{value}"
    return value


def row(values: Any) -> list[Any]:
    """The cells of a row."""
    return [cell(value) for value in values]
