"""What a small script of the import is made of."""

from __future__ import annotations

from dataclasses import dataclass

from hookean_canvas.definitions.containers import Slot


@dataclass(frozen=True)
class Recipe:
    """What a component needs to be made: words, code, and its inputs and outputs."""

    name: str
    nickname: str
    description: str
    code: str
    inputs: tuple[Slot, ...]
    outputs: tuple[Slot, ...]
