"""How far a list of neighbours ranges: as far as takes the least time, by how long it was of use and its pairs.

A list of an element with p pairs takes `MAKE` + `FIND` p to make, and p whenever it is used, in uses of one pair. It is
of use T times, which grows with its range R, and p grows with (2 r + R)^3, r being the mean radius: (MAKE + FIND p) / T
+ p is least where p g (T + FIND) = MAKE + FIND p, with g = 3 R / (2 r + R). What suits a list leaves some room, so that
not every list has another range.
"""

from __future__ import annotations

from typing import Any

from hookean.compiled.marks import device

SKIN_PART = 0.15  # of the mean radius: how far beyond their reach neighbours are listed at least
ROUND = 2.0 / SKIN_PART  # mean diameter in skins
LEAST, FIRST, MOST = 1.25, 2.0, 16.0  # the range of a list in skins
STEP = 1.5  # by which it changes
ROOM = 1.75  # how much of the best product there may be too much or too little
MAKE, FIND = 40.0, 12.0  # measured with spheres at 0.01 to 0.6 of the volume


@device
def much(beyond: Any, skin: Any, uses: Any, each: Any) -> Any:
    """How much farther than is best a list ranges that was of use so often: above 1, a shorter one takes less time;
    `each`: pairs of an element."""
    growth = 3.0 * beyond / (ROUND * skin + beyond)
    return each * growth * (uses + FIND) / (MAKE + FIND * each)


@device
def changed(beyond: Any, skin: Any, uses: Any, each: Any) -> Any:
    """The range that suits a motion in which a list was of use so often."""
    found = much(beyond, skin, uses, each)
    return beyond / STEP if found > ROOM else beyond * STEP if found * ROOM < 1.0 else beyond


@device
def for_two(twice: Any, beyond: Any, skin: Any, each: Any) -> Any:
    """The range for spheres so fast that a list is of use twice only if it ranges `twice`: that, or `beyond` if it is
    more; 0 where it takes less time to make one for each use."""
    each /= (ROUND * skin + beyond) ** 3
    wide, least = each * (ROUND * skin + twice) ** 3, each * (ROUND * skin + LEAST * skin) ** 3
    if twice > MOST * skin or (FIND + 2.0) * wide > MAKE + 2.0 * (FIND + 1.0) * least:
        return 0.0
    return max(beyond, twice)
