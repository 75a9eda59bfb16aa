"""The form under load cases and combinations, which travel as text (see `canvas_case_items`).

The service finds the form, freezes it and solves each case from there; the same question is asked once. For Python 2.7
to 3.13.
"""

import json

from . import canvas_geometry as geometry
from . import canvas_link as link
from . import canvas_scene as compose
from . import canvas_setup as setup
from . import canvas_words as words
from .canvas_ask import ask, digest
from .canvas_geometry import Unfit, listed, missing
from .canvas_items import text
from .canvas_packed import packed
from .canvas_values import flag

PATH = "/v1/analysis/load-cases"


class Outputs(object):
    """What the component puts out; None where nothing is known yet."""

    names = statuses = form = particles = displacements = forces = utilisation = reactions = slack = None
    extremes = largest = largest_cases = smallest = scene = report = None


def cases(ghenv, forces, anchors, settings, rides, given, combinations, stages, chosen, run):
    """One solution of the component: its outputs."""
    made = Outputs()
    read = words.told(
        ghenv, lambda: _wanted(ghenv, forces, anchors, settings, rides, given, combinations, stages, chosen)
    )
    if read is None:
        words.note(ghenv, "")
        return made
    made.scene = text(read.body["scene"])
    if not flag(run, True):
        words.note(ghenv, "off")
        return made
    signature = digest(made.scene + text(read.body["cases"]))
    answer = ask(ghenv, ("cases",), signature, read.ask)
    if answer is not None:
        words.told(ghenv, lambda: _show(ghenv, made, read, answer))
    return made


class Wanted(object):
    """The inputs, read: the request, what makes carried geometry again, and words in the place of pointers."""

    def __init__(self, body, makers, placed):
        self.body, self.makers, self.placed = body, makers, placed

    def ask(self, client):
        """The answer of the service; a refusal has the names of components in it."""
        try:
            return client.post(PATH, self.body, timeout=600.0)
        except link.Problem as problem:
            raise link.Problem(
                problem.slug, self.placed(problem.detail.replace("/scene/", "/")), problem.status, problem.errors
            )


def _wanted(ghenv, forces, anchors, settings, rides, given, combinations, stages, chosen):
    texts = [str(item) for item in listed(forces)]
    if not texts:
        raise missing("_forces is missing; connect the outputs of force components")
    mixed = compose.read(listed(combinations), "combination", "combinations")
    case_texts = [str(item) for item in listed(given)] + [part for one in mixed for part in one["parts"]]
    found = compose.read(_once(case_texts), "load_case", "_cases")
    if not found:
        raise missing("_cases is missing; connect the outputs of Load Case")
    texts = _once(texts + [part for one in found for part in one["parts"]])
    read = compose.read(texts, None, "_forces")
    held = [dict(one, home=one["point"], target=one["target"] or one["point"]) for one in setup.anchors(ghenv, anchors)]
    setting = compose.read(settings, "settings", "settings_")[-1:]
    carried = [compose.ride(item) for _, items in geometry.branches(rides) for item in items if item is not None]
    unit = geometry.length_unit()
    scene = compose.compose(read, held, setting[0] if setting else None, [entry for entry, _ in carried], unit)
    scene["load_cases"] = _by_name(found, "load case")
    scene["combinations"] = {n: one["factors"] for n, one in _by_name(mixed, "combination").items()}
    if listed(stages):
        scene["stages"] = _stages(listed(stages)[0])
    names = [str(item).strip() for item in listed(chosen)] or None
    body = {"scene": packed(scene), "cases": names}
    return Wanted(body, [make for _, make in carried], lambda said: setup.placed(read, held, said))


def _once(texts):
    """Texts without those that were there before."""
    return [one for i, one in enumerate(texts) if one not in texts[:i]]


def _by_name(entries, what):
    found = {}
    for one in entries:
        if one["name"] in found:
            raise Unfit("two %ss have the name %s; give each its own" % (what, one["name"]))
        found[one["name"]] = one["value"]
    return found


def _stages(given):
    try:
        found = json.loads(given)
    except (TypeError, ValueError):
        found = None
    if not isinstance(found, dict):
        example = '{"freeze": {"Springs": {"axial_stiffness": 100}}}'
        raise Unfit("stages: it is not the JSON text of stages, such as %s" % example)
    return found


# outputs


def _show(ghenv, made, wanted, answer):
    """Results by branches, one for each case, and of each force where there are several."""
    ones = answer["cases"]
    made.names = [one["name"] for one in ones]
    made.statuses = [one["result"]["status"] for one in ones]
    made.particles = _rows([[geometry.to_point(p) for p in one["result"]["particles"]] for one in ones])
    made.displacements = _rows([[geometry.to_vector(d) for d in one["displacements"]] for one in ones])
    made.reactions = _rows([_shown(one["result"]["reactions"]["force"]) for one in ones])
    made.slack = [sum(len(part["elements"]) for part in one["slack"]) for one in ones]
    made.forces = _columns(ones, ("force", "moment", "largest"))
    made.utilisation = _columns(ones, ("utilisation",))
    form = answer["form"]
    if len(form["geometry"]) == len(wanted.makers):
        from .canvas_moments import places

        made.form = [make(places(one)) for one, make in zip(form["geometry"], wanted.makers)]
    made.form = made.form or [geometry.to_point(place) for place in form["particles"]]
    _envelope(made, answer["envelope"])
    made.report = list(answer["notes"])
    for one in ones:
        made.report.append("%s: %s" % (one["name"], one["result"]["message"]))
        if one["result"]["status"] != "converged":
            words.warning(ghenv, "%s: %s" % (one["name"], one["result"]["message"]))
    for sentence in form["report"]["warnings"] + [entry["message"] + "." for entry in form["report"]["missed"]]:
        words.warning(ghenv, link.plainly(wanted.placed(sentence)))
    words.note(ghenv, "%d of %d" % (sum(one == "converged" for one in made.statuses), len(ones)))


def _shown(column):
    return [geometry.to_vector(value) if isinstance(value, list) else value for value in column]


def _rows(rows):
    return geometry.to_tree([("{%d}" % i, row) for i, row in enumerate(rows)])


def _columns(ones, names):
    """The first of some columns that each force has, by branches {case; force}; none where a force has none of them."""
    rows = []
    for i, one in enumerate(ones):
        for k, entry in enumerate(one["result"]["forces"]):
            values = next((entry[name] for name in names if entry.get(name)), [])
            rows.append(("{%d;%d}" % (i, k), _shown(values)))
    return geometry.to_tree(rows)


def _envelope(made, envelope):
    """Of the displacement, of each column of forces and of the reactions: the largest and smallest value of every
    element, and in which case the largest is."""
    found = [("displacement", envelope["displacement"])]
    for entry in envelope["forces"]:
        title = entry["name"] or entry["kind"]
        found += [("%s.%s" % (title, name), entry["columns"][name]) for name in sorted(entry["columns"])]
    found.append(("reaction", envelope["reactions"]["force"]))
    if "moment" in envelope["reactions"]:
        found.append(("reaction.moment", envelope["reactions"]["moment"]))
    made.extremes = [title for title, _ in found]
    made.largest, made.smallest = (_rows([one[name] for _, one in found]) for name in ("largest", "smallest"))
    made.largest_cases = _rows([one["largest_case"] for _, one in found])
