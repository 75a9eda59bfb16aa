"""Room on the canvas of a definition that is already laid out: sizes of components, and places that are free."""

from __future__ import annotations

from collections.abc import Sequence

from hookean_canvas.archive import Chunk
from hookean_canvas.archive.parts import Rectangle, bounds_of, parts
from hookean_canvas.definitions import containers
from hookean_canvas.definitions.write import CHARACTER, ROW

GAP = 8.0
"""Room around a box, in pixels of the canvas."""


class Space:
    """The rectangles that are taken on a canvas."""

    def __init__(self, root: Chunk) -> None:
        self.taken: dict[int, Rectangle] = {}
        for part in parts(root):
            bounds = bounds_of(part.container)
            if bounds is not None and part.container is not None:
                self.taken[id(part.container)] = bounds

    def free(self, x: float, y: float, width: float, height: float) -> Rectangle:
        """The first place from (x, y) downwards where a box meets no other one."""
        while met := [box for box in self.taken.values() if _meet((x, y, width, height), box)]:
            y = max(box[1] + box[3] for box in met) + GAP
        return x, y, width, height

    def put(self, container: Chunk, bounds: Rectangle) -> None:
        """Place an object with its inputs and outputs, and remember where it stands."""
        self.taken[id(container)] = bounds
        containers.place(container, bounds)
        x, y, width, height = bounds
        data = container.chunk("ParameterData")
        ports = [*container.chunks, *(data.chunks if data is not None else ())]
        for names, left in ((("InputParam", "param_input"), True), (("OutputParam", "param_output"), False)):
            side = [port for port in ports if port.name in names]
            for i, port in enumerate(side):
                row = (height - 4.0) / len(side)
                wide = CHARACTER * len(port.value("NickName", default="")) + 8.0
                containers.place(port, (x + 2.0 if left else x + width - 2.0 - wide, y + 2.0 + i * row, wide, row))

    def corner(self) -> tuple[float, float]:
        """The upper left corner of all there is."""
        boxes = list(self.taken.values()) or [(0.0, 0.0, 0.0, 0.0)]
        return min(box[0] for box in boxes), min(box[1] for box in boxes)


def size(inputs: Sequence[str], outputs: Sequence[str]) -> tuple[float, float]:
    """Width and height of a component with inputs and outputs of these names."""
    wide = sum(CHARACTER * max((len(name) for name in side), default=0) + 8.0 for side in (inputs, outputs))
    return wide + 32.0, ROW * max(len(inputs), len(outputs), 1) + 4.0


def _meet(one: Rectangle, other: Rectangle) -> bool:
    return all(one[i] < other[i] + other[i + 2] + GAP and other[i] < one[i] + one[i + 2] + GAP for i in (0, 1))
