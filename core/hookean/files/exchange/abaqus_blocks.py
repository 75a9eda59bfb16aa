"""Blocks of elements and materials of Abaqus input files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.files.exchange.structure import plain_names
from hookean.values.materials import Material

Ints = NDArray[np.int64]

LONGEST = 20  # characters of a number


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements of a `kind`, such as T3D2: their `nodes` (m, arity), and `sets` of some of them by name."""

    kind: str
    nodes: Ints
    sets: tuple[tuple[str, Ints], ...]


def number(value: float) -> str:
    """A number in at most 20 characters, which is all that a field may have: every digit, or as many as have room."""
    whole = repr(float(value))
    return next(text for text in (whole, *(f"{value:.{n}g}" for n in range(16, 0, -1))) if len(text) <= LONGEST)


def row(values: Iterable[float]) -> str:
    """Numbers of a data line."""
    return ", ".join(map(number, values))


def numbered(name: str, members: Iterable[int], keyword: str) -> list[str]:
    """A set of elements (ELSET) or points (NSET), 16 to a line."""
    every = list(map(str, members))
    return [f"*{keyword}, {keyword}={name}", *(", ".join(every[i : i + 16]) for i in range(0, len(every), 16))]


def of_elements(blocks: Sequence[Elements]) -> list[str]:
    """All elements, numbered from 1, and their sets; one name may have some of several blocks."""
    lines, sets, first = list[str](), dict[str, list[int]](), 1
    for block in blocks:
        lines.append(f"*ELEMENT, TYPE={block.kind}")
        lines += [f"{first + i}, {', '.join(map(str, nodes))}" for i, nodes in enumerate((block.nodes + 1).tolist())]
        for name, rows in block.sets:
            sets.setdefault(name, []).extend((rows + first).tolist())
        first += len(block.nodes)
    return [*lines, *(line for name, members in sets.items() for line in numbered(name, members, "ELSET"))]


class Materials:
    """The materials of a file, each once: those that the scene has by its names, others by numbers."""

    def __init__(self, known: Mapping[str, Material]) -> None:
        self.known, self.plain = known, dict(zip(known, plain_names(list(known)), strict=True))
        self.found: dict[tuple[Any, ...], str] = {}

    def elastic(self, name: str | None, numbers: tuple[float, ...], way: str = "") -> str:
        """The name of a material with these elastic numbers: E and Poisson's ratio, or E1, E2, nu12, G12, G13 and G23
        of a lamina; `way` without compression or tension. `name` is that in the scene, if it has one."""
        key = (name, numbers, way)
        if key not in self.found:
            called = f"MATERIAL_{len(self.found) + 1}" if name is None else self.plain[name]
            called += f"_NO_{way.upper()}" if name is not None and way else ""
            same = sum(other == called or other.startswith(f"{called}_V") for other in self.found.values())
            self.found[key] = f"{called}_V{same + 1}" if same else called
        return self.found[key]

    def lines(self) -> list[str]:
        """Elasticity of each, and density [mass/length^3] and expansion [1/K] where they are known."""
        lines = []
        for (name, numbers, way), called in self.found.items():
            kind = ", TYPE=LAMINA" if len(numbers) > 2 else ""
            lines += [f"*MATERIAL, NAME={called}", f"*ELASTIC{kind}", row(numbers)]
            lines += [f"*NO {way.upper()}"] if way else []
            own = None if name is None else self.known[name]
            if own is not None and own.density is not None:
                lines += ["*DENSITY", number(own.density)]
            if own is not None and own.expansion is not None:
                lines += ["*EXPANSION", number(own.expansion)]
        return lines
