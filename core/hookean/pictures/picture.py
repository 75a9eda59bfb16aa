"""Picture: a result drawn to a PNG file, to be read like a figure: forces in colour, true proportions, a scale."""

from __future__ import annotations

import os
from dataclasses import dataclass

from hookean.atomic_write import put
from hookean.pictures.sheet import Panel, check_picture, drawn, sheet
from hookean.pictures.visible import springs
from hookean.running.result import Result
from hookean.scene.scene import Scene
from hookean.values.colours import ramp as ramp


def legend(result: Result) -> tuple[float, float, str]:
    """Ends of the colour scale: the smallest and largest spring force and their unit; zeros without springs."""
    _, forces = springs(result)
    unit = str(result.units.force)
    return (float(forces.min()), float(forces.max()), unit) if len(forces) else (0.0, 0.0, unit)


def render(
    result: Result,
    path: str | os.PathLike[str],
    *,
    scene: Scene | None = None,
    title: str = "",
    size: tuple[int, int] = (1600, 1200),
    view: str | tuple[float, float] | None = None,
) -> None:
    """Draw `result` to a PNG file of `size` pixels.

    Springs by force (tension +, slack ones grey), carried meshes, held particles, loads and reactions; with its
    `scene` also the floor and the meshes that forces act on. `view` is front, right, top, isometric or the two angles
    (azimuth, elevation) of the eye [degrees]; without one, plane shapes are seen face on and all others at a slant.
    Raises InputError where the view or size makes no sense, or the file cannot be written.
    """
    sheet([Panel(result, scene, view=view)], path, title=title or "Hookean result", size=size)


@dataclass(frozen=True)
class Picture:
    """A picture that notebooks show: the bytes of a PNG file."""

    png: bytes

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to a .png file. Raises InputError where that cannot be written."""
        check_picture(path)
        put(path, self.png, lambda back: None)

    def __repr__(self) -> str:
        return f"Picture(PNG, {len(self.png) / 1000:.0f} kB)"

    def _repr_png_(self) -> bytes:
        return self.png


def picture(
    result: Result,
    *,
    title: str = "",
    size: tuple[int, int] = (1200, 900),
    view: str | tuple[float, float] | None = None,
) -> Picture:
    """`result` as a picture for a notebook; everything as in `render`."""
    return Picture(drawn([Panel(result, result.scene, view=view)], title=title, size=size))
