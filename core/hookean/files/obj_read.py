"""Wavefront OBJ read: vertices, faces, lines and points by the names of their objects and groups. Faults name the line.

Read by own means: bytes of strangers meet nothing but a split into words. Faces of more than four corners are cut into
triangles. Normals, textures, materials and free-form shapes are not read, with a warning.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hookean.discretize.meshes import as_mesh
from hookean.discretize.triangulate import newell, plane_coordinates, triangulate
from hookean.errors import InputError
from hookean.files.drawn import Drawn
from hookean.files.recipe.select import count
from hookean.values.columns import LARGEST
from hookean.values.units import METRES

NOT_TAKEN = {
    **dict.fromkeys(("vn",), "normals"),
    **dict.fromkeys(("vt",), "texture coordinates"),
    **dict.fromkeys(("usemtl", "mtllib", "usemap", "maplib"), "materials"),
    **dict.fromkeys(("s", "mg"), "smoothing groups"),
    **dict.fromkeys(("vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
                     "sp", "end", "con"), "free-form curves and surfaces"),
    **dict.fromkeys(("bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech", "stech"), "display"),
}  # fmt: skip
UNIT = re.compile(rf"lengths in ({'|'.join(METRES)})$")
LONGEST_NAME = 80


def read(data: bytes) -> Drawn:
    """What an OBJ file holds, in m unless a comment states otherwise, as those that hookean writes do. InputError with
    the number of the line."""
    reading = _Reading()
    for number, line in _lines(data):
        reading.take(number, line)
    return reading.drawn()


def _lines(data: bytes) -> Iterator[tuple[int, str]]:
    """Lines with their numbers; one that ends in a backslash goes on in the next."""
    begun, first = "", 0
    for number, line in enumerate(io.StringIO(data.decode("utf-8-sig", "replace"), newline=None), 1):
        line = line.rstrip()
        first = first or number
        if line.endswith("\\"):
            begun += line[:-1] + " "
            continue
        yield first, begun + line
        begun, first = "", 0
    if begun:
        yield first, begun


@dataclass(slots=True)
class _Element:
    """A face, a line or a point: `corners` are vertices counted from 0."""

    line: int
    name: str
    corners: list[int]


@dataclass
class _Reading:
    points: list[list[float]] = field(default_factory=list)
    elements: dict[str, list[_Element]] = field(default_factory=lambda: {"f": [], "l": [], "p": []})
    name: str = ""
    unit: str = ""
    left: dict[str, None] = field(default_factory=dict)
    cut: int = 0
    flat: int = 0

    def take(self, number: int, line: str) -> None:
        """One statement."""
        said, _, comment = line.partition("#")
        words = said.split()
        if not words:
            if found := UNIT.search(comment):
                self.unit = found[1]
            return
        kind = words[0]
        if kind == "v":
            self.points.append(_position(words[1:], number))
        elif kind in self.elements:
            fewest, name = _FEWEST[kind]
            if len(words) <= fewest:
                least = count(fewest, "vertex", "vertices")
                raise _fault(number, f"{name} of {len(words) - 1} vertices given; it needs at least {least}")
            corners = [self._vertex(word, number) for word in words[1:]]
            self.elements[kind].append(_Element(number, self.name, corners))
        elif kind in ("o", "g"):
            self.name = " ".join(words[1:])[:LONGEST_NAME]
        else:
            self.left[NOT_TAKEN.get(kind, f'"{kind[:20]}"')] = None

    def _vertex(self, word: str, number: int) -> int:
        """The vertex that a word such as 7, 7/1/2 or -1 names, counted from 0; that it exists is looked at last."""
        try:
            index = int(word.partition("/")[0])
        except ValueError:
            index = 0
        if index == 0 or "_" in word:
            raise _fault(number, f'"{word[:20]}" is not a vertex number; vertices are counted from 1, or back from -1')
        if index < -len(self.points):
            raise _fault(number, f"vertex {index} does not exist; there are {len(self.points)} before this line")
        return index - 1 if index > 0 else len(self.points) + index

    def drawn(self) -> Drawn:
        """What was read, taken together by names."""
        if not self.points:
            raise InputError("", "has no vertices; it is not an OBJ file, or it is empty")
        points = np.array(self.points)
        for element in (e for kind in self.elements.values() for e in kind):
            if max(element.corners) >= len(points):
                said = f"vertex {max(element.corners) + 1} does not exist; there are {len(points)}, counted from 1"
                raise _fault(element.line, said)
        found = Drawn(unit=self.unit or "m", stated=bool(self.unit))
        for name, elements in _by_name(self.elements["f"]):
            faces = [face for element in elements for face in self._faces(element, points)]
            if faces:
                used, renumbered = np.unique(np.array(faces), return_inverse=True)
                found.meshes.append((name, as_mesh((points[used], renumbered.reshape(-1, 4)))))
        for name, elements in _by_name(self.elements["l"]):
            pairs = [pair for e in elements for pair in zip(e.corners, e.corners[1:], strict=False)]
            ends = points[np.array(pairs)]
            whole = (ends[:, 0] != ends[:, 1]).any(axis=1)
            self.flat += int((~whole).sum())
            if whole.any():
                found.lines.append((name, ends[whole]))
        for name, elements in _by_name(self.elements["p"]):
            found.points.append((name, points[[corner for e in elements for corner in e.corners]]))
        found.warnings = self._warnings()
        return found

    def _faces(self, element: _Element, points: NDArray[np.float64]) -> list[list[int]]:
        """A face as quads, a triangle with its last corner twice; none where it has no area."""
        corners = [c for i, c in enumerate(element.corners) if c != element.corners[i - 1]]
        different = len(set(corners))
        if different < 3 or different < len(corners) <= 4:
            self.flat += 1
            return []
        if len(corners) <= 4:
            return [(corners + corners[-1:])[:4]]
        loop = points[corners]
        area = newell(loop)
        if not area.any():
            self.flat += 1
            return []
        self.cut += 1
        try:
            cut = triangulate(plane_coordinates(loop, area), [np.arange(len(loop))])
        except InputError:
            raise _fault(element.line, "this face crosses itself; draw it as triangles") from None
        return [[corners[a], corners[b], corners[c], corners[c]] for a, b, c in cut.tolist()]

    def _warnings(self) -> list[str]:
        said = [f"not read from the file: {', '.join(list(self.left)[:8])}"] if self.left else []
        if self.cut:
            said.append(f"{count(self.cut, 'face')} of more than four corners cut into triangles")
        if self.flat:
            said.append(f"{count(self.flat, 'face or line', 'faces or lines')} of zero size left out")
        return said


_FEWEST = {"f": (3, "a face"), "l": (2, "a line"), "p": (1, "a point")}


def _position(words: list[str], number: int) -> list[float]:
    """Coordinates; what follows them, weights or colours, is not taken."""
    try:
        found = [float(word) for word in words[:3]]
    except ValueError:
        found = []
    if len(found) != 3 or any("_" in word for word in words[:3]):
        raise _fault(number, "a vertex needs three coordinates")
    if not all(math.isfinite(c) and abs(c) <= LARGEST for c in found):
        raise _fault(number, f"a coordinate is not finite, or larger than {LARGEST:g}")
    return found


def _by_name(elements: list[_Element]) -> list[tuple[str, list[_Element]]]:
    found: dict[str, list[_Element]] = {}
    for element in elements:
        found.setdefault(element.name, []).append(element)
    return list(found.items())


def _fault(number: int, said: str) -> InputError:
    return InputError("", f"line {number}: {said}")
