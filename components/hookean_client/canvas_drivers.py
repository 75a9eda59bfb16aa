"""Components that count solutions of the canvas: Counter, Sequence and Trail. No service is asked. For Python 2.7 to
3.13."""

from .canvas_geometry import missing
from . import canvas_words as words
from . import canvas_geometry as geometry
from .canvas_branches import below
from .canvas_values import flag, whole

_counts = {}  # how many solutions a component has counted, by component and run
_trails = {}  # the places of each point so far, by component and run


def _key(ghenv):
    return words.identity(ghenv), words.run_of(ghenv)


def counter(ghenv, reset, interval):
    """How many solutions there were since `reset` was True; every so many milliseconds one is scheduled."""

    def work():
        pause = whole(interval, 0, "interval", 0)[0]
        key = _key(ghenv)
        held = flag(reset, False)
        _counts[key] = 0 if held or key not in _counts else _counts[key] + 1
        if pause and not held:
            words.schedule(ghenv, pause)
        return _counts[key]

    return words.told(ghenv, work)


def sequence(ghenv, frames, restart, interval):
    """True in the first solution of a sequence and False in the others, and the number of the solution; after the last
    one nothing is scheduled."""

    def work():
        last, pause = whole(frames, 10, "frames")[0], whole(interval, 40, "interval")[0]
        key = _key(ghenv)
        held = flag(restart, False)
        frame = 0 if held or key not in _counts else min(_counts[key] + 1, last)
        _counts[key] = frame
        if frame < last and not held:
            words.schedule(ghenv, pause)
        return frame == 0, frame

    return words.told(ghenv, work) or (None, None)


def trail(ghenv, points, reset, record):
    """The path of each point over the solutions in which it moved, as a polyline and as points in branches."""

    def work():
        rows = geometry.points(points)
        if not rows:
            raise missing("points are missing; connect them")
        key = _key(ghenv)
        known = _trails.get(key)
        if known is None or flag(reset, False) or len(known) != len(rows):
            _trails[key] = known = [[row] for row in rows]
        elif flag(record, True):
            for path, row in zip(known, rows):
                if path[-1] != row:
                    path.append(row)
        curves = [geometry.to_polyline(path) if len(path) > 1 else None for path in known]
        return curves, below(ghenv, [[geometry.to_point(row) for row in path] for path in known])

    return words.told(ghenv, work) or (None, None)
