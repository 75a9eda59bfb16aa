"""A motion under a load that follows a table of values through time, frame by frame. For Python 2.7 to 3.13."""

import hashlib

from . import canvas_ask as asking
from .canvas_geometry import missing
from .canvas_packed import packed
from .canvas_items import text
from .canvas_packed import unpacked
from . import canvas_words as words
from . import canvas_file
from . import canvas_geometry as geometry
from . import canvas_moments as moments
from .canvas_geometry import Unfit, listed

FRAMES = 20000  # more of them are refused


class Stream(object):
    """A value for each frame: `times` [time], `values` of the table, `largest` force of each force component, and the
    `geometry`, a branch for each frame."""

    times = values = largest = geometry = report = None


def stream(ghenv, forces, anchors, settings, rides, file, column, force, scale, power, every):
    """The motion while a load is `scale` x value ^ `power`; empty until the service has done it."""
    found = Stream()

    def work():
        scene, step, makers, sentences = moments.setup(ghenv, forces, anchors, settings, rides)
        rows = _table(canvas_file.file_of(ghenv, _first(file, "_file")), str(_first(column, "_column")))
        loads = _loads(rows, geometry.point(_first(scale, "_scale")), float((listed(power) or [1.0])[0]))
        number = _number(scene, str(_first(force, "_force")))
        pieces = max(1, int(geometry.number((listed(every) or [0.1])[0]) / step + 0.5))
        scene = dict(scene, settings=dict(scene["settings"], sub_iterations=pieces))
        values, vectors = _frames(rows, loads, pieces * step)
        told = text([scene, number, vectors])
        key = "stream:%s:%s" % (words.identity(ghenv), hashlib.sha1(told.encode("utf-8")).hexdigest()[:16])
        states = asking.ask(ghenv, "stream", key, lambda client: _played(client.session(key), scene, number, vectors))
        if states is None:
            return
        found.times, found.values = [i * pieces * step for i in range(len(values))], values
        pairs = [("{%d}" % k, [_largest(state["forces"][k]) for state in states]) for k in range(len(scene["forces"]))]
        found.largest = geometry.to_tree(pairs)
        shapes = [[make(place) for make, place in zip(makers, state["geometry"])] for state in states]
        found.geometry = geometry.to_tree([("{%d}" % i, row) for i, row in enumerate(shapes)])
        found.report = ["%d frames of %g time, %d rows." % (len(states), pieces * step, len(rows))]
        for sentence in sentences(states[0]["report"]):
            words.warning(ghenv, sentence)

    words.told(ghenv, work)
    return found


def _first(given, name):
    items = listed(given)
    if not items:
        raise missing("%s is missing; connect it" % name)
    return items[0]


def _table(place, column):
    """Rows (time, value) of a CSV file whose first line names its columns, `time [s]` among them."""
    with open(place) as file:
        lines = [line.strip().split(",") for line in file if line.strip()]
    names = [name.strip() for name in lines[0]] if lines else []
    times = [i for i, name in enumerate(names) if name.split("[")[0].strip() == "time"]
    if column not in names or not times:
        said = '_file: its first line has "%s"; a column time and "%s" are needed'
        raise Unfit(said % (", ".join(names)[:80], column))
    rows = []
    for number, line in enumerate(lines[1:], 2):
        try:
            rows.append((float(line[times[0]]), float(line[names.index(column)])))
        except (ValueError, IndexError):
            raise Unfit("_file: line %d is not a row of numbers" % number)
        if len(rows) > 1 and rows[-1][0] <= rows[-2][0]:
            raise Unfit("_file: line %d goes back in time" % number)
    if len(rows) < 2:
        raise Unfit("_file: it has %d rows; at least two are needed" % len(rows))
    return rows


def _loads(rows, scale, power):
    return [[part * value**power for part in scale] for _, value in rows]


def _number(scene, name):
    """The number of the load of this name."""
    names = [one["name"] for one in scene["forces"]]
    if name not in names:
        raise Unfit('_force: no force has the name "%s"; there are %s' % (name, ", ".join(names)))
    number = names.index(name)
    if scene["forces"][number]["kind"] != "unary":
        raise Unfit('_force: "%s" is not a load; connect the name of a load' % name)
    return number


def _frames(rows, loads, every):
    """The value and the vector of each frame: a row stands until the next one."""
    count = int((rows[-1][0] - rows[0][0]) / every + 1e-6) + 1
    if count > FRAMES:
        raise Unfit("_every_: %d frames are more than %d; give a longer time" % (count, FRAMES))
    values, vectors, row = [], [], 0
    for i in range(count):
        while row + 1 < len(rows) and rows[row + 1][0] <= rows[0][0] + i * every + 1e-9 * every:
            row += 1
        values.append(rows[row][1])
        vectors.append(loads[row])
    return values, vectors


def _played(session, scene, number, vectors):
    """The state at each frame; the load is set at the start of a frame, and stands until the next one."""
    session.put(packed(scene))
    states, before = [], None
    try:
        for i, vector in enumerate(vectors):
            if i:
                session.step(frames=1, timeout=600.0)
            if vector != before:
                session.edit({"forces": {str(number): {"vector": vector}}})
                before = vector
            state = unpacked(session.state(arrays="buffer"))
            places = [moments.places(entry) for entry in state["geometry"]]
            kept = {name: state[name] for name in ("forces", "report")}
            states.append(dict(kept, geometry=places))
    finally:
        session.delete()
    return states


def _largest(told):
    """The largest force of a force's elements: tension + of springs, the length of vectors; None without any."""
    found = told.get("force") or []
    sizes = [sum(part * part for part in one) ** 0.5 if isinstance(one, (list, tuple)) else one for one in found]
    return max(sizes) if sizes else None
