"""How the tables of the import say what stands for a component of Kangaroo: pieces, and swaps made of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Piece:
    """One of our components: `inputs` ours by Kangaroo's, `outputs` Kangaroo's by ours (`|`: either), `values` set.

    `feeds`: by an output, the input it is wired to, as the number of a piece and a name; several with `|` between.
    """

    bundle: str
    inputs: Mapping[str, str]
    outputs: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)
    feeds: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Swap:
    """What a component of Kangaroo is swapped for.

    `pieces`: the first stands in its place. `differs`: a sentence. `without`: why an input has no counterpart.
    `usual`: what Kangaroo types into such an input, which says nothing. `needs`: inputs that identify the version.
    `unless`: inputs that must be empty or as usual, each with the reason. `other`: for versions that do not fit this.
    `idle`: those of `without` that say nothing more than what is known here: wires into them are no loss.
    """

    pieces: tuple[Piece, ...]
    differs: str = ""
    without: Mapping[str, str] = field(default_factory=dict)
    usual: Mapping[str, Any] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    unless: Mapping[str, str] = field(default_factory=dict)
    other: Swap | None = None
    idle: tuple[str, ...] = ()


def force(bundle: str, output: str, differs: str = "", needs: str = "", **inputs: str) -> Swap:
    """One component for another: ours by Kangaroo's names of inputs."""
    return Swap((Piece(bundle, inputs, {"force": output}),), differs, needs=tuple(needs.split()))


HALF = "half of the strength, which is what it pulls with in Kangaroo"


def halved(bundle: str, output: str, column: str, *more: Piece, **inputs: str) -> Swap:
    """For a goal that pulls with half of its strength."""
    half = Piece("*half", {"strength": "numbers"}, feeds={"halves": f"0.{column}"})
    return Swap((Piece(bundle, inputs, {"force": output}), half, *more), HALF)


def corners(piece: int) -> dict[str, str]:
    """Feeds of three points of corners to a piece."""
    return {f"point_{i}": f"{piece}.point_{i}" for i in (1, 2, 3)}


def fed(bundle: str, output: str, *helpers: Piece, differs: str = "", values: Mapping[str, Any] | None = None,
        **inputs: str) -> Swap:  # fmt: skip
    """A component of ours, and helpers that feed it."""
    return Swap((Piece(bundle, inputs, {"force": output}, values or {}), *helpers), differs)


def pairs(bundle: str, output: str, helper: str, differs: str, *more: Piece, **inputs: str) -> Swap:
    """For a goal of pairs of lines: a helper gives their ends, and, where it makes them, strengths."""
    feeds = {f"point_{i}": f"0.point_{i}" for i in (1, 2, 3, 4)}
    given = {"linea": "lines", "lineb": "others"}
    if helper != "*ends":
        feeds["strengths"] = "0.strength"
        given["strength"] = "strength"
    if helper == "*clamp":
        given |= {"lower": "lower", "upper": "upper"}
    return Swap((Piece(bundle, inputs, {"force": output}), Piece(helper, given, feeds=feeds), *more), differs)
