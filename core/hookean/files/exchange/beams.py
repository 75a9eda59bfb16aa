"""What other programs take of beams: where they lie without stress, their sections, axes, eccentric ends, hinges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hookean.forces.beam import Beam
from hookean.forces.beam_frames import drawn_frames
from hookean.forces.elastic import section_columns
from hookean.system.system import System

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COLUMNS = ("E", "G", "A", "Iy", "Iz", "J", "shear_y", "shear_z")


@dataclass(frozen=True)
class Beams:
    """The beams of one force: `pairs` (m, 2) of particles; `sections` (m, 8) with `COLUMNS`, shear areas 0 where
    shear does not count; `axes` (m, 3, 3) by rows x, y, z at the start; `offsets` (m, 2, 3) [length] of both ends;
    `releases` (m, 2), the axes about which the start and the end of each are hinged; `left`, what a
    file does not hold of them."""

    name: str
    pairs: Ints
    sections: Floats
    axes: Floats
    offsets: Floats
    releases: NDArray[np.str_]
    left: tuple[str, ...]

    @classmethod
    def of(cls, force: Beam, pairs: Ints, system: System) -> Beams:
        """The beams of a force between `pairs` of particles of a system."""
        own = force.replaced(**section_columns(force, system.places))
        count = len(pairs)
        sections = np.column_stack([np.broadcast_to(getattr(own, name), count) for name in COLUMNS])
        given = (force.offset_start, force.offset_end)
        offsets = np.stack([np.broadcast_to(offset, (count, 3)) for offset in given], axis=1)
        chords = np.diff(system.x[pairs] + offsets, axis=1)[:, 0]
        left = [] if force.curvature == "drawn" else ["the bending of rods that are straight without stress"]
        left += [] if force.temperature is None else ["the temperature of beams"]
        ends = (force.release_start, force.release_end)
        releases = np.stack([np.broadcast_to(np.asarray(axes), count) for axes in ends], axis=1)
        name = force.name or force.kind_name
        return cls(name, pairs, sections, drawn_frames(chords, force.normal), offsets, releases, tuple(left))
