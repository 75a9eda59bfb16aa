"""Forces, anchors and settings as components give them to the engine. A component's code is little more than one call:

    force = canvas.force(ghenv, "springs", lines=_connection, stiffness=_stiffness_)

Everything here runs inside one run of a component in script mode; no service is asked. Bad input is never raised: it
becomes one sentence on the component, and what is returned is None. For Python 2.7 to 3.13.
"""

from . import canvas_geometry as geometry
from . import canvas_items as items
from . import canvas_words as words
from .canvas_geometry import Unfit, listed, matched
from .canvas_words import error, remark, warning

# for scripts on a canvas
__all__ = ["Unfit", "anchors", "error", "force", "geometry", "listed", "matched", "remark", "settings", "warning"]


def force(ghenv, kind, **fields):
    """A force as text for the engine, by the names of its fields (docs/forces.md); None where its place is missing."""
    return words.told(ghenv, lambda: items.force(words.source(ghenv), kind, fields))


def anchors(ghenv, points, targets=None, x=True, y=True, z=True):
    """Anchors as text for the engine: points, where to hold them (none: there) and in which directions."""
    return words.told(ghenv, lambda: items.anchors(words.source(ghenv), points, targets, (x, y, z)))


def settings(ghenv, **fields):
    """Settings as text for the engine: those of a scene, its `weld_tolerance`, the units `length`, `force` and `time`,
    `fast`, whether it runs as quickly as it can, and `all_particles`, whether points of any force become particles."""
    return words.told(ghenv, lambda: items.settings(fields))
