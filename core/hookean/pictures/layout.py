"""Layout: where the panels of a sheet stand on its page, and how large a length and a force are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.pictures import chart, legends
from hookean.pictures.page import LARGE, MEDIUM, ROW, SMALL, WIDTH, Box, Entry, Page, fitted, flow, measured, wrapped
from hookean.pictures.painter import ARROWS, Drawing
from hookean.pictures.visible import collect, eye_of
from hookean.running.result import Result
from hookean.scene.scene import Scene
from hookean.values.colours import INK, MUTED, Scale, number
from hookean.values.units import METRES, NEWTONS

Floats = NDArray[np.float64]

MARGIN, GAP = 0.42, 0.45
COLUMNS = {1: 1, 2: 2, 4: 2}
"""Panels in a row by the number of panels; 3 for all others."""
WIDE = 7.0
"""Inches from which on the legend of a panel stands between its directions and its bar, not under them."""
Heading = tuple[str, float, str, str, float]  # words, size, weight, colour, height in inches


class SpaceCell:
    """A panel in space."""

    def __init__(
        self,
        result: Result | None,
        scene: Scene | None,
        title: str,
        view: Any,
        frames: Mapping[str, Floats],
        curves: Mapping[str, Floats],
        unit: str,
    ) -> None:
        things = collect(result, scene, frames, curves)
        self.result, self.title, self.unit = result, title, unit
        self.drawing = Drawing(things, eye_of(view, things))
        self.metres = METRES[unit]
        forces = things.forces
        self.force_unit = str(result.units.force) if result else "N"
        self.ends = (float(forces.min()), float(forces.max())) if len(forces) else None
        self.scale = Scale(*(self.ends or (0.0, 0.0)), self.force_unit)
        self.bar = legends.BAR if self.ends else 0.0  # inches of width for a legend of its own

    def headings(self, width: float) -> list[Heading]:
        """Title, forces where the legend stands elsewhere, and how the run ended."""
        found = [(t, MEDIUM, "bold", INK, 0.31) for t in wrapped(self.title, width, MEDIUM, "bold")]
        if self.ends and not self.bar:
            low, high = self.ends
            words = f"{number(low)} to {number(high)}" if high > low else number(low)
            found.append((fitted(f"force {words} {self.force_unit}", width), SMALL, "normal", INK, 0.25))
        if self.result:
            found.append((_status(self.result, width), SMALL, "normal", MUTED, 0.25))
        return found

    def entries(self) -> list[Entry]:
        return self.drawing.entries(self.force_unit)

    def foot(self, width: float) -> float:
        """Inches of height under the drawing."""
        width -= self.bar if width < WIDE else 0.0
        rows = len(flow(self.entries(), self._legend_width(width)))
        return max(legends.FOOT, rows * ROW + 0.1) if width >= WIDE else legends.FOOT + rows * ROW

    @staticmethod
    def _legend_width(width: float) -> float:
        return width - 3.6 if width >= WIDE else width

    @property
    def seen(self) -> Floats:
        """Width and height of all that is seen [m]."""
        low, high = self.drawing.bounds()
        return (high - low) * self.metres

    def paint(self, page: Page, box: Box, foot: float, per_inch: float) -> None:
        """The drawing in a box, what belongs to it under it, in `foot` inches; `per_inch` in metres."""
        inner = Box(box.x, box.y, box.width - self.bar, box.height)
        axes = page.axes(inner)
        axes.set_axis_off()
        per_inch /= self.metres
        centre = np.mean(self.drawing.bounds(), axis=0)
        reach = 0.5 * per_inch * np.array([inner.width, inner.height])
        axes.set_xlim(centre[0] - reach[0], centre[0] + reach[0])
        axes.set_ylim(centre[1] - reach[1], centre[1] + reach[1])
        boldness = float(np.clip(np.sqrt(min(inner.width, 1.4 * inner.height) / 11.0), 0.5, 1.0))
        self.drawing.paint(axes, self.scale, boldness, per_inch / 72.0)
        right = box.x + box.width if box.width >= WIDE else inner.x + inner.width
        legends.triad(page, box.x - 0.1, box.y - legends.FOOT, self.drawing.eye)
        room = min(2.2, 0.4 * inner.width)
        legends.scale_bar(page, right, box.y - legends.FOOT + 0.25, room, per_inch, self.unit)
        width = right - box.x
        rows = flow(self.entries(), self._legend_width(width))
        if box.width >= WIDE:
            top = box.y - 0.5 * (legends.FOOT - min(len(rows) * ROW, legends.FOOT)) - 0.1
            page.legend(rows, Box(box.x + 1.2, box.y - foot, width - 3.6, top - box.y + foot))
        else:
            page.legend(rows, Box(box.x, box.y - foot, width, foot - legends.FOOT))
        if self.bar:
            height = min(box.height, 7.6)
            bar = Box(box.x + box.width - self.bar + 0.14, box.y + 0.5 * (box.height - height), self.bar, height)
            legends.colour_bar(page, bar, self.scale)


class GraphCell:
    """A graph among the panels."""

    def __init__(self, given: chart.Graph) -> None:
        chart.check(given)
        self.graph = given

    def headings(self, width: float) -> list[Heading]:
        return [(t, MEDIUM, "bold", INK, 0.31) for t in wrapped(self.graph.title, width, MEDIUM, "bold")]

    def foot(self, width: float) -> float:
        return 0.1 + len(flow(chart.entries(self.graph), width)) * ROW

    def paint(self, page: Page, box: Box, foot: float) -> None:
        """The axes down to the legend, which ends the `foot` inches under the box."""
        rows = flow(chart.entries(self.graph), box.width)
        down = foot - len(rows) * ROW
        chart.paint(page, Box(box.x, box.y - down, box.width, box.height + down), self.graph)
        page.legend(rows, Box(box.x, box.y - foot, box.width, foot - down))


Cell = SpaceCell | GraphCell


def compose(
    cells: list[Cell], title: str, size: tuple[int, int] | None, columns: int | None, same_scale: bool
) -> bytes:
    """The sheet as the bytes of a PNG file."""
    columns = min(columns or COLUMNS.get(len(cells), 3), len(cells))
    spaces = [cell for cell in cells if isinstance(cell, SpaceCell)]
    if len(cells) == 1 and not title and spaces:
        title, spaces[0].title = spaces[0].title, ""
    for cell in spaces if columns > 1 else []:
        cell.drawing.reach = {kind: 1.35 * reach for kind, reach in cell.drawing.reach.items()}  # small panels
    common = _share(spaces) if same_scale else None
    grid = _Grid(cells, columns, title, common is not None, same_scale)
    if size is None:
        plan = grid.plan(WIDTH, None)
        dpi = (2000 if columns > 1 else 1600) / WIDTH
        size = (round(WIDTH * dpi), round(plan.height * dpi))
    else:
        dpi = min(size[0] / WIDTH, size[1] / grid.plan(WIDTH, 0.0).height)
    plan = grid.plan(size[0] / dpi, size[1] / dpi)
    page = Page(size[0] / dpi, size[1] / dpi, dpi)
    grid.paint(page, plan, common)
    return page.png()


def _share(spaces: list[SpaceCell]) -> Scale | None:
    """One measure of arrows for all panels; and one scale of forces, returned, where two or more have springs."""
    for kind in ARROWS:
        largest = [cell.drawing.most(kind)[0] * NEWTONS[cell.force_unit] for cell in spaces]
        loaded = [size for size in largest if size > 0.0]
        # where they differ much, the small ones would vanish: then each panel has its own measure
        if len(loaded) > 1 and max(loaded) <= 8.0 * min(loaded):
            extent = max(cell.drawing.extent * cell.metres for cell in spaces)
            count = max(cell.drawing.most(kind)[1] for cell in spaces)
            reach = 1.35 * Drawing.reach_of(kind, extent, max(loaded), count)
            for cell in spaces:
                cell.drawing.reach[kind] = reach * NEWTONS[cell.force_unit] / cell.metres
    ends = [cell.ends for cell in spaces if cell.ends]
    if len(ends) < 2 or len({cell.force_unit for cell in spaces if cell.ends}) > 1:
        return None
    common = Scale(min(e[0] for e in ends), max(e[1] for e in ends), next(c.force_unit for c in spaces if c.ends))
    for cell in spaces:
        cell.scale, cell.bar = common, 0.0
    return common


@dataclass
class Plan:
    """Inches: of the page's height, of each row's parts; and metres per inch by the number of the cell."""

    height: float
    cell: float
    heads: list[float]
    rows: list[float]
    feet: list[float]
    per_inch: dict[int, float]


class _Grid:
    """Panels in rows and columns under a title."""

    def __init__(self, cells: list[Cell], columns: int, title: str, shared_bar: bool, same_scale: bool) -> None:
        self.cells, self.columns, self.title, self.same_scale = cells, columns, title, same_scale
        self.side = legends.BAR + 0.1 if shared_bar else 0.0
        self.rows = [range(i, min(i + columns, len(cells))) for i in range(0, len(cells), columns)]

    def _titles(self, width: float) -> list[str]:
        return wrapped(self.title, width - 2 * MARGIN, LARGE, "bold")

    @property
    def _space(self) -> float:
        """Inches between the title of the page and those of the panels."""
        return 0.2 if self.title and len(self.cells) > 1 else 0.0

    def plan(self, width: float, height: float | None) -> Plan:
        """Where everything stands on a page of this width; of a height as fits, or given (0: the least)."""
        cell = (width - 2 * MARGIN - self.side - GAP * (self.columns - 1)) / self.columns
        heads = [max(sum(h[4] for h in self.cells[i].headings(cell)) for i in row) + 0.1 for row in self.rows]
        feet = [max(self.cells[i].foot(cell) for i in row) for row in self.rows]
        titles = 0.4 * len(self._titles(width)) + self._space
        fixed = 2 * 0.34 + titles + sum(heads) + sum(feet) + GAP * (len(self.rows) - 1)
        per_inch = self._per_inch(cell, [cell * (0.66 if cell > WIDE else 1.0)] * len(self.rows))
        rows = [self._row(row, cell, per_inch) for row in self.rows]
        if height == 0.0:
            rows = [0.36 * cell] * len(rows)
        elif height is not None:
            rows = [r * (height - fixed) / sum(rows) for r in rows]
            per_inch = self._per_inch(cell, rows)
        return Plan(fixed + sum(rows), cell, heads, rows, feet, per_inch)

    def _row(self, row: range, width: float, per_inch: dict[int, float]) -> float:
        """Height of the drawings of a row."""
        tall = [cell.seen[1] / per_inch[i] for i in row if isinstance(cell := self.cells[i], SpaceCell)]
        graphs = [(0.5 if width > WIDE else 0.62) * width] if len(tall) < len(row) else []
        return float(max(*tall, *graphs, 0.3 * width))

    def _per_inch(self, width: float, rows: list[float]) -> dict[int, float]:
        """Metres per inch of each panel in space, so that all of it is seen."""
        found = {}
        for row, height in zip(self.rows, rows, strict=True):
            for i in row:
                if isinstance(cell := self.cells[i], SpaceCell):
                    found[i] = float(max(cell.seen / (width - cell.bar, height)))
        return dict.fromkeys(found, max(found.values())) if self.same_scale and found else found

    def paint(self, page: Page, plan: Plan, common: Scale | None) -> None:
        """Everything on the page."""
        y = page.height - 0.34
        for words in self._titles(page.width):
            page.text(MARGIN, y, words, LARGE, weight="bold", va="top")
            y -= 0.4
        y -= self._space
        top = y
        for row, head, height, foot in zip(self.rows, plan.heads, plan.rows, plan.feet, strict=True):
            for column, i in enumerate(row):
                box = Box(MARGIN + column * (plan.cell + GAP), y - head - height, plan.cell, height)
                at = y
                for words, size, weight, colour, step in self.cells[i].headings(plan.cell):
                    page.text(box.x, at, words, size, colour, weight=weight, va="top")
                    at -= step
                cell = self.cells[i]
                if isinstance(cell, SpaceCell):
                    cell.paint(page, box, foot, plan.per_inch[i])
                else:
                    cell.paint(page, box, foot)
            y -= head + height + foot + GAP
        if common:
            height = min(top - MARGIN, 7.0)
            box = Box(page.width - MARGIN - legends.BAR + 0.14, top - height, legends.BAR, height)
            legends.colour_bar(page, box, common, "all panels")


def _status(result: Result, width: float) -> str:
    """How the run ended, as much as has room."""
    count = f"{result.iterations} iteration{'s' * (result.iterations != 1)}"
    residual = number(float(f"{result.residual:.2g}"))
    parts = [str(result.status).replace("_", " "), f"residual {residual}", count, result.solver]
    if result.time > 0.0:
        parts.insert(1, f"time {number(result.time)} {result.units.time}")
    while len(parts) > 1 and measured(" · ".join(parts)) > width:
        parts.pop()
    return fitted(" · ".join(parts), width)
