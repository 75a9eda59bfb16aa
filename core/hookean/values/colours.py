"""Colours and numbers of pictures: one visual family for panels in space and graphs."""

from __future__ import annotations

from typing import Any

INK, MUTED, PALE, SLACK = "#22303c", "#52606d", "#8b98a5", "#b9c0c7"
LOAD, REACTION, FLOOR = "#2a9d5c", "#8e44ad", "#e9ecef"
COLD = ["#06306e", "#1f66b0", "#5ea2d6", "#a9c9e2"]
WARM = ["#f3b58e", "#e27a4c", "#c2352b", "#6f0a1e"]
LINES = ["#0b6e8a", "#c8553d", "#4f7f2b", "#8a5a9e", "#b8860b", "#3f4f9f"]
"""Lines that are no springs, in this order; none is a load's green or a reaction's violet."""


def ramp(low: float, high: float) -> tuple[list[str], float, float]:
    """Colours at even steps and the forces at their two ends: about 0 where both signs occur, else over the extremes
    `low` and `high`; where there are no forces, not finite, as for zeros."""
    low, high = (low, high) if low <= high else (0.0, 0.0)
    largest = max(abs(low), abs(high))
    if low < -1e-9 * largest and high > 1e-9 * largest:
        return [*COLD, "#d3d3d3", *WARM], -largest, largest
    colours = COLD if high <= 1e-9 * largest and largest > 0 else WARM
    margin = 0.0 if high > low else max(abs(high), 1.0) * 1e-3
    return colours, low - margin, high + margin


class Scale:
    """Forces from `low` to `high` in `unit` as colours; how pictures and their legends colour a spring."""

    def __init__(self, low: float, high: float, unit: str) -> None:
        from matplotlib.colors import LinearSegmentedColormap, Normalize

        self.low, self.high, self.unit = low, high, unit
        colours, self.first, self.last = ramp(low, high)
        self._map = LinearSegmentedColormap.from_list("forces", colours)
        self._norm = Normalize(self.first, self.last)

    def colours(self, forces: Any) -> Any:
        """Rows of red, green, blue and opacity."""
        return self._map(self._norm(forces)).reshape(-1, 4)


def number(value: float) -> str:
    """Four digits, with a true minus sign."""
    return f"{value:.4g}".replace("e+0", "e").replace("e-0", "e-").replace("-", "\N{MINUS SIGN}")


def ticks(low: float, high: float, room: float = 0.06, most: int = 6) -> list[float]:
    """The two ends and at most so many round numbers between them, that keep clear of the ends by `room`, a part."""
    from matplotlib.ticker import MaxNLocator

    if not high > low:
        return [low]
    clear = room * (high - low)
    between = [float(t) for t in MaxNLocator(most).tick_values(low, high)]
    return [low, *(t for t in between if low + clear < t < high - clear), high]
