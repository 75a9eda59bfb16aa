"""The components of load cases: loads of a case, factors of a combination, and the form under all of them.

Cases and combinations travel as text. The service finds the form, freezes it and solves each case from there; the same
question is asked once. For Python 2.7 to 3.13.
"""

import json

from . import canvas, canvas_engine, canvas_sweep
from . import canvas_geometry as geometry
from . import canvas_link as link
from . import canvas_scene as compose
from . import canvas_tools as tools
from .canvas_design import _name, _number, _text
from .canvas_geometry import TEXT, Unfit, listed, matched

PRESTRESS, PERMANENT = "prestress", "permanent"
PATH = "/v1/analysis/load-cases"


class Outputs(object):
    """What the component puts out; None where nothing is known yet."""

    names = statuses = form = particles = displacements = forces = utilisation = reactions = slack = None
    extremes = largest = largest_cases = smallest = scene = report = None


# texts


def load_case(ghenv, loads, factor, heated, degrees, name):
    """A load case as text: its loads and changes of temperature, by the names of their forces."""

    def work():
        given = listed(loads)
        warm = [str(_name(item)) for item in listed(heated)]
        changes = [geometry.number(item) for item in listed(degrees)]
        if not given and not warm:
            raise compose.missing("_loads is missing; connect the outputs of load components, or give their names")
        if bool(warm) != bool(changes):
            raise Unfit("heated and degrees belong together; connect both")
        own = {"forces": [str(_name(item)) for item in given]}
        if warm:
            own["temperature"] = dict(zip(*matched(warm, changes)))
        if listed(factor):
            own["factor"] = _number(factor, "factor")
        return _item(ghenv, "load_case", name, own, given)

    return canvas._told(ghenv, work)


def combination(ghenv, cases, factors, prestress, permanent, name):
    """A combination as text: factors on cases, on the prestress of the form and on loads in no case."""

    def work():
        names, numbers = [_called(item) for item in listed(cases)], [geometry.number(n) for n in listed(factors)]
        if not names and not listed(prestress) and not listed(permanent):
            raise compose.missing("_cases is missing; connect the outputs of Load Case, or give their names")
        if len(numbers) not in (0, 1, len(names)):
            said = "factors: %d for %d cases; give one for all, or one for each"
            raise Unfit(said % (len(numbers), len(names)))
        own = dict(zip(names, (numbers or [1.0]) * (len(names) if len(numbers) < 2 else 1)))
        for title, given in ((PRESTRESS, prestress), (PERMANENT, permanent)):
            if listed(given):
                own[title] = _number(given, title)
        carried = [item for item in listed(cases) if _is_text(item)]
        return _item(ghenv, "combination", name, {"factors": own}, carried)

    return canvas._told(ghenv, work)


def _item(ghenv, kind, name, own, carried):
    """The text of a case or combination; `carried` are texts of what it names, so that they need no other wire."""
    source = canvas.source(ghenv)
    title = _text(name) or source["title"]
    parts = [str(item) for item in carried if _is_text(item)]
    return compose.text({"kind": kind, "source": source, "name": title, "value": own, "parts": parts})


def _is_text(item):
    return isinstance(item, TEXT) and '"kind"' in item


def _called(item):
    """The name of a case: of its text, or the name itself."""
    if _is_text(item):
        return compose.read([item], "load_case", "cases")[0]["name"]
    return str(item).strip()


# the form under its cases


def cases(ghenv, forces, anchors, settings, rides, given, combinations, stages, chosen, run):
    """One solution of the component: its outputs."""
    made = Outputs()
    read = canvas._told(
        ghenv, lambda: _wanted(ghenv, forces, anchors, settings, rides, given, combinations, stages, chosen)
    )
    if read is None:
        canvas.note(ghenv, "")
        return made
    made.scene = compose.text(read.body["scene"])
    if not tools.flag(run, True):
        canvas.note(ghenv, "off")
        return made
    signature = canvas._digest(made.scene + compose.text(read.body["cases"]))
    answer = canvas.ask(ghenv, ("cases",), signature, read.ask)
    if answer is not None:
        canvas._told(ghenv, lambda: _show(ghenv, made, read, answer))
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
        raise compose.missing("_forces is missing; connect the outputs of force components")
    mixed = compose.read(listed(combinations), "combination", "combinations")
    case_texts = [str(item) for item in listed(given)] + [part for one in mixed for part in one["parts"]]
    found = compose.read(_once(case_texts), "load_case", "_cases")
    if not found:
        raise compose.missing("_cases is missing; connect the outputs of Load Case")
    texts = _once(texts + [part for one in found for part in one["parts"]])
    read = compose.read(texts, None, "_forces")
    held = [
        dict(one, home=one["point"], target=one["target"] or one["point"])
        for one in canvas_engine._anchors(ghenv, anchors)
    ]
    setting = compose.read(settings, "settings", "settings_")[-1:]
    carried = [compose.ride(item) for _, items in geometry.branches(rides) for item in items if item is not None]
    unit = canvas_engine._length_unit()
    scene = compose.compose(read, held, setting[0] if setting else None, [entry for entry, _ in carried], unit)
    scene["load_cases"] = _by_name(found, "load case")
    scene["combinations"] = {n: one["factors"] for n, one in _by_name(mixed, "combination").items()}
    if listed(stages):
        scene["stages"] = _stages(listed(stages)[0])
    names = [_text([item]) for item in listed(chosen)] or None
    body = {"scene": link.packed(scene), "cases": names}
    return Wanted(body, [make for _, make in carried], lambda said: canvas_engine.placed(read, held, said))


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
    made.reactions = _rows([canvas_sweep._shown(one["result"]["reactions"]["force"]) for one in ones])
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
            canvas.warning(ghenv, "%s: %s" % (one["name"], one["result"]["message"]))
    for sentence in form["report"]["warnings"] + [entry["message"] + "." for entry in form["report"]["missed"]]:
        canvas.warning(ghenv, link.plainly(wanted.placed(sentence)))
    canvas.note(ghenv, "%d of %d" % (sum(one == "converged" for one in made.statuses), len(ones)))


def _rows(rows):
    return geometry.to_tree([("{%d}" % i, row) for i, row in enumerate(rows)])


def _columns(ones, names):
    """The first of some columns that each force has, by branches {case; force}; none where a force has none of them."""
    rows = []
    for i, one in enumerate(ones):
        for k, entry in enumerate(one["result"]["forces"]):
            values = next((entry[name] for name in names if entry.get(name)), [])
            rows.append(("{%d;%d}" % (i, k), canvas_sweep._shown(values)))
    return geometry.to_tree(rows)


def _envelope(made, envelope):
    """Of the displacement, of each column of forces and of the reactions: the largest and smallest value of every
    element, and in which case the largest is."""
    found = [("displacement", envelope["displacement"])]
    for entry in envelope["forces"]:
        title = entry["name"] or entry["kind"]
        found += [("%s.%s" % (title, name), entry["columns"][name]) for name in sorted(entry["columns"])]
    found.append(("reaction", envelope["reactions"]["force"]))
    made.extremes = [title for title, _ in found]
    made.largest, made.smallest = (_rows([one[name] for _, one in found]) for name in ("largest", "smallest"))
    made.largest_cases = _rows([one["largest_case"] for _, one in found])
