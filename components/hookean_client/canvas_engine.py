"""The engine's component: reads its inputs, lets a `Player` do the rest in threads, and shows how it stands.

Every solution takes the newest frame and schedules the next one while anything moves; at rest none is scheduled. For
Python 2.7 to 3.13.
"""

import hashlib
import os

from . import canvas_words as words
from . import canvas_draw as drawing
from . import canvas_geometry as geometry
from . import canvas_grab as grabbing
from . import canvas_link as link
from . import canvas_scene as compose
from . import canvas_setup as setup
from .canvas_geometry import listed, missing
from .canvas_items import plain, text
from .canvas_player import Player

FRAME, POLL = 30, 100  # milliseconds to the next solution: while it runs, while it waits
OUTPUTS = ("iterations", "particles", "geometry", "forces", "reactions", "residual", "energy", "status", "report",
           "results")  # fmt: skip
_players, _keys = {}, {}  # by session; the session of a component in an open document


class Outputs(object):
    """What the component puts out; None where nothing is known yet."""

    def __init__(self):
        for name in OUTPUTS:
            setattr(self, name, None)


class Wanted(object):
    """The inputs of one solution, read; `signature` is the same for the same inputs. `reset`: held at the start;
    `paused`: held where it is."""

    def __init__(self, forces, anchors, setting, rides, reset, length, paused=False):
        self.grab = None  # how the mouse may drag particles
        self.forces, self.anchors, self.setting, self.rides, self.reset = forces, anchors, setting, rides, reset
        self.paused = paused and not reset
        self.length, self.fast = length, bool(setting and setting.get("fast"))

    def scene(self, anchors):
        """The scene, with these anchors."""
        carried = [entry for _, items in self.rides for entry, _ in items]
        return compose.compose(self.forces, anchors, self.setting, carried, self.length)


def solve(ghenv, forces, anchors=None, settings=None, rides=None, reset=True, on=True):
    """One solution of the engine: its outputs."""
    player = _player(ghenv)
    wanted = words.told(ghenv, lambda: _wanted(ghenv, player, forces, anchors, settings, rides, (reset, on)))
    if wanted is None:
        return Outputs()
    player.wanted = wanted
    grabbing.follow(ghenv, player, wanted.grab)
    first = player.shown is None
    for _ in range(3):
        player.look()
        trouble = player.trouble
        if player.settled or trouble or not player.wait(link.service.patience(link.WAIT if first else 0.1)):
            break
        if player.kept is wanted and player.frame() and not player.rests:
            break
    _tell(ghenv, player)
    if player.kept is wanted and player.frame() and player.state:
        player.shown = _outputs(player, _asked(ghenv))
        _warn(ghenv, player)
        drawing.draw(ghenv, player)
    return player.shown or Outputs()


def _player(ghenv):
    """The player of a component: one for each component in each file; another one, that goes on from the first, once
    the definition is saved under another name."""
    document, component = ghenv.Component.OnPingDocument(), words.identity(ghenv)
    path = getattr(document, "FilePath", None)
    path = os.path.normcase(os.path.abspath(str(path))) if path else ""
    digest = hashlib.sha1(path.encode("utf-8")).hexdigest()[:16]
    key = "%s:%s:%s" % (getattr(document, "DocumentID", "none"), digest, component)
    here = (component, str(getattr(document, "RuntimeID", id(document))))
    before = _players.get(_keys.get(here)) if _keys.get(here) != key else None
    if key not in _players or _players[key].ended:
        title = "%s in %s" % (words.source(ghenv)["title"], os.path.basename(path) or "a new definition")
        _players[key] = Player(key, title, before)
    _keys[here] = key
    _players[key].component = ghenv.Component
    return _players[key]


# inputs


def _wanted(ghenv, player, forces, anchors, settings, rides, switches):
    texts = [str(item) for item in listed(forces)]
    if not texts:
        raise missing("_forces is missing; connect the outputs of force components")
    held = setup.anchors(ghenv, anchors)
    setting = compose.read(settings, "settings", "settings_")[-1:]
    held_at_start, on = [_switch(flag) for flag in switches]
    carried, prints = _rides(player, rides)
    length = geometry.length_unit()
    signature = [texts, text([held, setting, prints, held_at_start, on, length])]
    old = player.wanted
    if old is not None and old.signature == signature:
        return old
    read = compose.read(texts, None, "_forces")
    grabs, read = [[one for one in read if (one["kind"] == grabbing.KIND) is so] for so in (True, False)]
    made = Wanted(read, held, setting[0] if setting else None, carried, held_at_start, length, not on)
    made.signature, made.prints, made.grab = signature, prints, grabs[-1] if grabs else None
    return made


def _switch(given):
    """A truth value; True where nothing is connected."""
    flags = listed(given)
    return not flags or bool(plain(flags[0]))


def _rides(player, given):
    """Geometry that rides along, by branches, as (entry, what makes geometry of moved points); and its fingerprints.
    What is as it was is not read again."""
    known = player.wanted.prints if player.wanted is not None else []
    found, prints = [], []
    for _b, (path, items) in enumerate(geometry.branches(given)):
        made = []
        for i, item in enumerate(items):
            item = geometry.value(item)
            if item is None:
                continue
            mark = [path, i, int(item.DataCRC(0))] if hasattr(item, "DataCRC") else None
            at = len(prints)
            if mark is not None and at < len(known) and known[at] == mark:
                ride = [one for _, row in player.wanted.rides for one in row][at]
            else:
                ride = compose.ride(item)
            prints.append(mark or [path, i, text(ride[0])])
            made.append(ride)
        found.append((path, made))
    return found, prints


# sentences


def _tell(ghenv, player):
    """Words on how it stands, and the next solution where there will be something new."""
    trouble, task = player.trouble, player.task
    refused = task is not None and task.done and player.refused is player.wanted
    if refused:
        words.note(ghenv, "refused")
        words.error(ghenv, setup.placed(player.wanted.forces, player.wanted.anchors, trouble))
        return
    if trouble:
        patient = task is not None and task.patient
        (words.remark if patient else words.warning)(ghenv, trouble)
        words.note(ghenv, "working" if patient else "no server" if player.kept is None else "waiting")
        words.schedule(ghenv, 2 * POLL)
        return
    if player.kept is not player.wanted or not player.frame():
        words.note(ghenv, "working")
        words.schedule(ghenv, POLL // 2)
        return
    frame = player.frame()
    said = {"running": "iteration %d", "converged": "at rest after %d"}.get(frame["status"], frame["status"])
    if player.kept.reset:
        said = "held at the start"
    elif player.kept.paused and frame["status"] != "converged":
        said = "paused at iteration %d"
    words.note(ghenv, said % frame["iteration"] if "%" in said else said)
    if not player.settled:
        words.schedule(ghenv, FRAME)


def _warn(ghenv, player):
    """What met no particle, by the names of components, and other warnings."""
    said = setup.sentences(player.state["report"], player.kept.forces, player.kept.anchors)
    for sentence in said:
        words.warning(ghenv, sentence)
    frame = player.frame()
    if player.falls:
        words.warning(ghenv, player.falls)
        said.append(player.falls)
    if frame["status"] == "diverged" and player.exact:
        (words.warning if player.falls else words.error)(ghenv, player.state["message"])
    player.shown.report = said + player.shown.report


# outputs


def _asked(ghenv):
    """Whether a wire leaves the output `results`: its texts are long."""
    for port in ghenv.Component.Params.Output:
        if port.Name == "results":
            takers = getattr(port, "Recipients", None)
            return takers is None or any(True for _ in takers)
    return False


def _outputs(player, asked):
    """The newest frame as outputs; with all digits where the state is that of the frame."""
    frame, state, units = player.frame(), player.state, player.topology["units"]
    flat = frame["particles"]
    if player.exact:
        places = state["particles"]
    else:
        places = [flat[i : i + 3] for i in range(0, len(flat), 3)]
    made = Outputs()
    made.iterations, made.residual = frame["iteration"], state["residual"] if player.exact else frame["residual"]
    made.particles = [geometry.to_point(place) for place in places]
    made.geometry = _moved(player, places)
    made.forces = geometry.to_tree(_forces(player, frame))
    made.reactions = geometry.to_tree(_reactions(player, frame))
    made.results = _results(player, places) if asked and player.exact else []
    made.energy = state["energy"]["total"]
    running = "Running: iteration %d, residual %.3g." % (frame["iteration"], frame["residual"])
    made.status = state["message"] if player.exact else running
    unit = "%s %s" % (units["force"], units["length"])
    made.report = ["%d particles, %d points merged." % (len(places), state["report"]["merged"]),
                   "Energy %.6g %s, time %.4g %s, by %s." % (made.energy, unit, frame["time"], units["time"],
                                                             state["solver"])]  # fmt: skip
    return made


def _moved(player, places):
    """The geometry where its particles are now, in the tree it came in."""
    rides = iter(player.topology["geometry"])
    pairs = []
    for path, items in player.kept.rides:
        made = []
        for entry, make in items:
            start = entry["mesh"]["vertices"] if "mesh" in entry else entry.get("points")
            start = [end for line in entry["lines"] for end in line] if start is None else start
            made.append(make([places[p] if p >= 0 else at for p, at in zip(next(rides)["particles"], start)]))
        pairs.append((path, made))
    return geometry.to_tree(pairs)


def _forces(player, frame):
    """A branch for each component of forces, an item for each of its elements."""
    columns = [[] for _ in player.kept.forces]
    for column, found in zip(columns, player.state["forces"]):
        name = next((n for n in ("force", "moment", "area") if n in found), None)
        column.extend(found[name] if name else [])
    if not player.exact and len(frame["scalars"]) == len(player.topology["spring_forces"]):
        fresh = {}
        for number, scalar in zip(player.topology["spring_forces"], frame["scalars"]):
            fresh.setdefault(number, []).append(scalar)
        for number, column in fresh.items():
            columns[number] = column
    order, branches = [], {}
    for one, column in zip(player.kept.forces, columns):
        owner = one["source"]["component"]
        if owner not in branches:
            order.append(owner)
        items = [geometry.to_vector(item) if isinstance(item, (list, tuple)) else item for item in column]
        branches.setdefault(owner, []).extend(items)
    return [("{%d}" % i, branches[owner]) for i, owner in enumerate(order)]


def _results(player, places):
    """All that the elements of each force report, as JSON text for scripts, in the order of the forces. It needs
    the whole state, so it is for rest only. `points` and `start`: where the particles of each element are, and were."""
    turns = player.state.get("rotations") or {"particles": [], "quaternions": []}
    turned = dict(zip(turns["particles"], turns["quaternions"]))
    made = []
    for one, found in zip(player.kept.forces, player.state["forces"]):
        rows = [row if isinstance(row, (list, tuple)) else [row] for row in found.get("particles", [])]
        told = {name: column for name, column in found.items() if name != "particles"}
        told["units"], told["source"] = player.topology["units"], one["source"]
        told["points"] = [[list(places[p]) for p in row] for row in rows]
        told["start"] = [[player.topology["start"][p] for p in row] for row in rows]
        if turned:
            told["rotations"] = [[list(turned.get(p, (1.0, 0.0, 0.0, 0.0))) for p in row] for row in rows]
        made.append(text(told))
    return made


def _reactions(player, frame):
    """The reaction of each anchor, None where it met no particle, in the tree of the anchors."""
    told = player.state["reactions"]
    particles, names, forces = (
        [value for value, exact in zip(told[key], told["exact"]) if exact] for key in ("particles", "names", "force")
    )
    if not player.exact and len(frame["reactions"]) == 3 * len(forces):
        forces = [frame["reactions"][3 * i : 3 * i + 3] for i in range(len(forces))]
    parts = _parts(player, dict(zip(particles, forces)), dict(zip(names, forces)))
    order, branches = [], {}
    for anchor in player.kept.anchors:
        if anchor["branch"] not in branches:
            order.append(anchor["branch"])
        force = parts.get(anchor["name"])
        branches.setdefault(anchor["branch"], []).append(None if force is None else geometry.to_vector(force))
    return [(path, branches[path]) for path in order]


def _parts(player, on, parts):
    """Reactions by the names of anchors: where several hold a particle, each direction is with the last that holds
    it, whose target it is at. `on`: by particle; `parts`: as they are where each particle has one anchor."""
    if not player.shared:
        return parts
    taken, parts = set(), {}
    for name, particle, axes in reversed(player.shared):
        if particle in on:
            mine = [axis for axis in axes if (particle, axis) not in taken]
            parts[name] = [on[particle]["xyz".index(axis)] if axis in mine else 0.0 for axis in "xyz"]
            taken.update((particle, axis) for axis in mine)
    return parts
