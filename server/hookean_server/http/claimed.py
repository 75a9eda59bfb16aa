"""The fields of a result as headers of an answer, so that clients know how a run ended without the body."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from hookean.running.claims import CLAIMS, WARNINGS, claims

if TYPE_CHECKING:
    from hookean.running.result import Result

LONGEST = 1024  # characters of one header
LONGEST_WARNINGS = 4096  # of all warnings
LONGEST_WARNING = 300


def header(field: str) -> str:
    """The header of a claim, such as `hookean-out-of-balance`."""
    return f"hookean-{field.replace('_', '-')}"


NAMES = (*(header(claim.field) for claim in CLAIMS), header("warnings"))
"""All headers that `headers` may give."""


def headers(result: Result, warnings: Sequence[str] = ()) -> dict[str, str]:
    """One header for each claim of a result, and one for the warnings, in printable ASCII."""
    said = {header(field): _printable(text)[:LONGEST] for field, text in claims(result).items()}
    return {**said, **warned(warnings)}


def warned(warnings: Sequence[str]) -> dict[str, str]:
    """The header of warnings: a JSON list of sentences in ASCII; the last counts those that do not fit."""
    every = [w if len(w) <= LONGEST_WARNING else w[: LONGEST_WARNING - 3] + "..." for w in dict.fromkeys(warnings)]
    if not every:
        return {}
    sizes, kept = 40, 0  # of the brackets and the last sentence
    while kept < len(every) and (sizes := sizes + len(json.dumps(every[kept])) + 2) <= LONGEST_WARNINGS:
        kept += 1
    more = [f"and {len(every) - kept} more"] if kept < len(every) else []
    return {header("warnings"): json.dumps(every[:kept] + more)}


def described() -> dict[str, Any]:
    """The headers in the API's description."""
    told = {header(claim.field): (claim.meaning, LONGEST) for claim in CLAIMS}
    told[header("warnings")] = (f"{WARNINGS}: a JSON list of sentences in ASCII", LONGEST_WARNINGS)
    return {
        name: {"description": meaning, "schema": {"type": "string", "maxLength": longest}}
        for name, (meaning, longest) in told.items()
    }


def _printable(text: str) -> str:
    """One line of ASCII: other characters as backslash escapes, what ends a line or is no character as a space."""
    return re.sub(r"[^ -~]+", " ", text.encode("ascii", "backslashreplace").decode()).strip()
