"""The fields that describe a result: one list, for the headers of HTTP, the document text of files and their comments.

A field of `Result` becomes part of all of them by one line in `CLAIMS`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hookean.running.result import Result


@dataclass(frozen=True)
class Claim:
    """A field of `Result`, the dimension of its unit ("" for none, see `Units.of`) and what it means."""

    field: str
    dimension: str
    meaning: str


CLAIMS = (
    Claim("status", "", "How the run ended: converged, stalled, diverged, max_iterations or time_limit"),
    Claim("message", "", "One sentence about it"),
    Claim("residual", "", "Largest out-of-balance force divided by the scale of the forces [-]"),
    Claim("rounding_floor", "", "The residual due to rounding alone [-]"),
    Claim("out_of_balance", "force", "The largest out-of-balance force, with its unit"),
    Claim("stability", "", "Whether small disturbances decay: stable, unstable, mechanism or unknown"),
    Claim("position_error", "length", "The largest movement that one more exact step would make, with its unit"),
    Claim("iterations", "", "Iterations of the solver"),
    Claim("time", "time", "Physical time at the end, with its unit"),
    Claim("solver", "", "The solver that was used"),
)
WARNINGS = "Warnings about the input and the result"
MOST = 100  # warnings in the text of a document


def claims(result: Result) -> dict[str, str]:
    """Each claim of a result as text, by its field; what is None or not finite is left out."""
    said = {}
    for claim in CLAIMS:
        if (text := _text(getattr(result, claim.field))) is not None:
            said[claim.field] = f"{text} {result.units.of(claim.dimension)}".strip()
    return said


def document_text(result: Result, warnings: Iterable[str] = ()) -> dict[str, str]:
    """The claims of a result and its warnings, a line each, as user text of a document: keys such as
    `hookean:status`."""
    lines = list(dict.fromkeys(warnings))
    if len(lines) > MOST:
        lines[MOST:] = [f"and {len(lines) - MOST} more warnings"]
    said = claims(result) | {"warnings": "\n".join(lines)}
    return {f"hookean:{name}": clean for name, text in said.items() if (clean := _clean(text))}


def _text(value: Any) -> str | None:
    if isinstance(value, float):
        return f"{value:.9g}" if math.isfinite(value) else None
    if value is None or isinstance(value, str):
        return None if value is None else str(value)
    return json.dumps(value, ensure_ascii=False)


def _clean(text: str) -> str:
    """Text as files take it: no null characters, no halves of surrogate pairs."""
    return text.replace("\0", "").encode("utf-8", "replace").decode()
