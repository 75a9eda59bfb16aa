"""Shapes of a motion at given moments, in physical time, as Rhino's geometry. For Python 2.7 to 3.13."""

import hashlib

from . import canvas_ask as asking
from .canvas_geometry import missing
from .canvas_items import text
from .canvas_packed import unpacked
from . import canvas_words as words
from . import canvas_setup
from . import canvas_geometry as geometry
from . import canvas_scene as compose
from .canvas_geometry import Unfit, listed

STEP = 0.01  # seconds, where Settings say nothing
PHYSICAL = ("auto", "verlet", "yoshida")


class Moments(object):
    """A branch for each moment: `geometry`, `particles`; and the moments as they are, in whole steps [time]."""

    geometry = particles = times = report = None


def moments(ghenv, forces, anchors, settings, rides, times):
    """The shapes after so much time from the start; empty until the service has answered."""
    found = Moments()

    def work():
        made, steps, step, makers, sentences = _asked(ghenv, forces, anchors, settings, rides, times)

        def relax(client):
            return [client.relax(one, query={"arrays": "buffer"}, timeout=600.0) for one in made]

        signature = hashlib.sha1(text(made).encode("utf-8")).hexdigest()
        answers = asking.ask(ghenv, (words.run_of(ghenv), "moments"), signature, relax)
        if answers is None:
            return
        answers = [unpacked(one) for one in answers]
        rows = [[geometry.to_point(place) for place in one["particles"]] for one in answers]
        found.particles = geometry.to_tree(_branches(rows))
        rows = [[make(places(entry)) for entry, make in zip(one["geometry"], makers)] for one in answers]
        found.geometry = geometry.to_tree(_branches(rows))
        found.times = [count * step for count in steps]
        found.report = _report(ghenv, answers, sentences)

    words.told(ghenv, work)
    return found


def _asked(ghenv, forces, anchors, settings, rides, times):
    """A scene for each moment, its number of steps, the step [time], what makes geometry of moved points, and what
    makes sentences, as `setup` gives them."""
    scene, step, makers, sentences = setup(ghenv, forces, anchors, settings, rides)
    try:
        wanted = [geometry.number(one) for one in listed(times)]
    except Unfit as unfit:
        raise Unfit("_times: %s" % unfit)
    if not wanted:
        raise missing("_times is missing; connect one moment or more [time]")
    if min(wanted) < 0:
        raise Unfit("_times: %g is before the start; give moments from 0 on" % min(wanted))
    steps = [int(one / step + 0.5) for one in wanted]
    made = [dict(scene, settings=dict(scene["settings"], max_iterations=count)) for count in steps]
    return made, steps, step, makers, sentences


def setup(ghenv, forces, anchors, settings, rides):
    """The scene of a motion in physical time that never counts as at rest, its step [time], what makes geometry of
    moved points, and what makes sentences for people of a report on it."""
    read = compose.read(forces, None, "_forces")
    if not read:
        raise missing("_forces is missing; connect the outputs of force components")
    held = [dict(one, home=one["point"], target=one["target"] or one["point"])
            for one in canvas_setup.anchors(ghenv, anchors)]  # fmt: skip
    setting = (compose.read(settings, "settings", "settings_")[-1:] or [None])[0]
    carried = [compose.ride(item) for _, items in geometry.branches(rides) for item in items if item is not None]
    scene = compose.compose(read, held, setting, [entry for entry, _ in carried], geometry.length_unit())
    solver, step = scene["settings"].get("solver", "auto"), float(scene["settings"].get("time_step", STEP))
    if solver not in PHYSICAL:
        raise Unfit("settings_: %s has no physical time; moments need verlet or yoshida" % solver)
    fixed = {"solver": "yoshida" if solver == "yoshida" else "verlet", "tolerance": 0.0}
    made = dict(scene, settings=dict(scene["settings"], **fixed))
    return made, step, [make for _, make in carried], lambda report: canvas_setup.sentences(report, read, held)


def places(entry):
    """Moved points of a geometry in a result, one after the other."""
    if "lines" in entry:
        return [end for line in entry["lines"] for end in line]
    return entry["vertices"] if "vertices" in entry else entry["points"]


def _branches(rows):
    return [("{%d}" % i, row) for i, row in enumerate(rows)]


def _report(ghenv, answers, sentences):
    """What a person should know: what met no particle, warnings, a motion that flew apart."""
    said = sentences(answers[0]["report"])
    for sentence in said:
        words.warning(ghenv, sentence)
    for one in answers:
        if one["status"] == "diverged":
            words.warning(ghenv, one["message"])
            said.append(one["message"])
    return said + ["%d particles, at rest or in motion at %d moments." % (len(answers[0]["particles"]), len(answers))]
