"""A report of a scene as one HTML file: its form, loads, cases, maxima and where they are, with pictures; to print."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np

from hookean.analysis.envelope import Envelope, Extremes, first_largest
from hookean.analysis.load_cases import CaseResult, LoadCases, load_cases
from hookean.files import limits as limit_file
from hookean.files import tables
from hookean.forces import KINDS
from hookean.pictures.picture import picture
from hookean.running.result import Result
from hookean.running.run import relax
from hookean.running.utilisation import dimensions, missing
from hookean.scene.scene import Scene
from hookean.system.system import System, a_scene, compile

SIZE = (1000, 750)  # pixels of a picture
MOST = 60  # rows of a table

STYLE = """
body { font: 10.5pt/1.4 Arial, Helvetica, sans-serif; color: #111; }
body { max-width: 190mm; margin: 10mm auto; padding: 0 5mm; }
h1 { font-size: 20pt; margin: 0 0 4mm; } h2 { font-size: 14pt; margin: 9mm 0 2mm; border-bottom: 1px solid #999; }
h3 { font-size: 11.5pt; margin: 5mm 0 1mm; }
table { border-collapse: collapse; width: 100%; margin: 2mm 0; font-size: 9pt; }
th, td { border-bottom: 1px solid #ccc; padding: 1mm 2mm; text-align: right; vertical-align: top; }
th:first-child, td:first-child { text-align: left; } th { background: #f0f0f0; }
img { width: 100%; border: 1px solid #ddd; } .failed { color: #b00000; font-weight: bold; }
figure { margin: 2mm 0; break-inside: avoid; } figcaption { font-size: 9pt; color: #555; }
tr { break-inside: avoid; } h2, h3 { break-after: avoid; }
@page { size: A4; margin: 15mm; } @media print { body { margin: 0; max-width: none; padding: 0; } }
"""


@dataclass(frozen=True)
class Report:
    """A report as the `text` of an HTML file; sentences on limits that are `exceeded` and on what is `unsettled`, not
    in equilibrium, each with its case."""

    text: str
    exceeded: tuple[str, ...]
    unsettled: tuple[str, ...]


def report(scene: Scene, **options: Any) -> str:
    """The text of `reported`, with its options."""
    return reported(scene, **options).text


def reported(
    scene: Scene,
    *,
    title: str = "Report",
    limits: Mapping[str, Any] | None = None,
    pictures: bool = True,
    cases: LoadCases | None = None,
    processes: int = 1,
) -> Report:
    """The report of a scene.

    With load cases the form is found and frozen, and all cases and combinations are solved; else the scene is relaxed.
    `limits`, as `limits.read_limits` gives them, are checked in each case. The same scene gives the same text. `cases`
    of this scene that are solved already are not solved again; else `processes` solve them side by side.
    Raises InputError where the scene cannot be relaxed or frozen, or a limit names what it does not have.
    """
    if cases is None and (a_scene(scene).load_cases or scene.combinations):
        cases = load_cases(scene, processes=processes)
    form = cases.form if cases is not None else relax(scene)
    parts = [f"<h1>{escape(title)}</h1>", *_scene(scene, form), *_form(scene, form, pictures)]
    found, results = list[str](), {"": form}
    if cases is not None:
        parts += [*_cases(scene, cases), *_envelope(cases.envelope, form)]
        some = next(iter(cases.cases.values())).result
        parts += [*_missing(cases.frozen.scene, some), *_reactions(cases.envelope, form)]
        for name, case in cases.cases.items():
            exceeded = None if limits is None else _exceeded_in(case, cases, limits)
            parts += _case(case, exceeded, pictures)
            found += [f"{name}: {sentence}" for sentence in exceeded or ()]
            results[name] = case.result
    elif limits is not None:
        found = _exceeded(limits, compile(scene), form)
        parts += _checks(found)
    body = "\n".join(parts)
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{STYLE}</style>'
    text = f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head><body>\n{body}\n</body></html>\n'
    unsettled = (
        f"{name}: {one.message}" if name else one.message for name, one in results.items() if not one.converged
    )
    return Report(text, tuple(found), tuple(unsettled))


def _scene(scene: Scene, form: Result) -> Iterator[str]:
    units = scene.units
    yield "<h2>Model</h2>"
    used = f"Lengths in {units.length}, forces in {units.force}, times in {units.time}."
    yield f"<p>{used} Digest {scene.digest[:16]}.</p>"
    rows = []
    for force, entry in zip(scene.forces, form.forces, strict=True):
        count = len(np.asarray(entry["particles"])) if "particles" in entry else 0
        role = {"internal": "element", "load": "load", "support": "support"}[KINDS[force.kind_name].role]
        when = "" if count or role != "load" else "in load cases"
        rows.append((force.name or force.kind_name, force.kind_name, role, count or when))
    yield _table(("force", "kind", "role", "elements"), rows)


def _form(scene: Scene, form: Result, pictures: bool) -> Iterator[str]:
    yield "<h2>Form</h2>"
    yield f"<p>{escape(form.message)} Stability: {form.stability}.</p>"
    yield from _warned(form)
    if pictures:
        yield _picture(form, "Form and forces in it")
    yield from _loads(form, "Loads that act on the form")
    yield from _carried(form)
    yield _table(("force", "column", "smallest", "largest", "unit"), _ranges(form))
    if not (scene.load_cases or scene.combinations):
        yield from _missing(scene, form)


def _warned(result: Result) -> Iterator[str]:
    yield from (f"<p>Warning: {escape(sentence)}</p>" for sentence in result.report.warnings)


def _ranges(result: Result) -> Iterator[tuple[Any, ...]]:
    for entry in result.forces:
        for name, dimension in dimensions(entry["kind"]).items():
            values = np.asarray(entry.get(name, ()), dtype=float)
            sizes = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
            if sizes.size:
                unit = result.units.of(dimension) or "-"
                yield entry["name"] or entry["kind"], name, float(sizes.min()), float(sizes.max()), unit


def _missing(scene: Scene, result: Result) -> Iterator[str]:
    """A sentence on each force whose stress or utilisation is not known."""
    for force, columns in zip(scene.forces, result.forces, strict=True):
        if said := missing(force, columns):
            yield f"<p>{escape(said)}</p>"


def _loads(result: Result, title: str) -> Iterator[str]:
    found = result.loads
    if not len(found["force"]):
        return
    units = result.units
    yield f"<h3>{escape(title)}</h3>"
    heads = ["load", "kind", "particles", f"resultant x, y, z [{units.force}]", f"centre x, y, z [{units.length}]"]
    rows = []
    for i, number in enumerate(found["force"].tolist()):
        name, kind = found["name"][i] or found["kind"][i], found["kind"][i]
        count = len(np.unique(result.forces[number].get("particles", ())))
        rows.append([name, kind, count, _vector(found["resultant"][i]), _vector(found["centre"][i])])
    rows.append(["together", "", "", _vector(found["resultant"].sum(axis=0)), ""])
    if len(result.rotations["particles"]):
        heads.append(f"moment about the centre x, y, z [{units.of('force length')}]")
        reach = float(np.ptp(result.particles, axis=0).max(initial=0.0))
        least = 1e-9 * reach * np.linalg.norm(found["resultant"], axis=1)[:, None]  # what is rounding of the forces
        moments = np.where(np.abs(found["moment"]) < least, 0.0, found["moment"])
        for row, moment in zip(rows, [*map(_vector, moments), ""], strict=True):
            row.append(moment)
    yield _table(heads, rows)


def _carried(result: Result) -> Iterator[str]:
    """What each support carries, the largest first, and what floors carry together."""
    found, units = result.reactions, result.units
    force, floor = _sizeable(found["force"]), _sizeable(result.contacts["force"])
    if len(force) or len(floor):
        yield "<h3>Reactions</h3>"
    for title, rows in (("Reactions", force), ("Forces of floors", floor)):
        if len(rows):
            yield f"<p>{title} together: {_vector(_sizeable(rows.sum(axis=0))[0])} {units.force}.</p>"
    if not len(force):
        return
    heads = ["support", "particle", f"x, y, z [{units.length}]", f"reaction x, y, z [{units.force}]"]
    columns = [force]
    if len(result.rotations["particles"]):
        heads.append(f"moment x, y, z [{units.of('force length')}]")
        columns.append(_sizeable(found["moment"]))
    cells = []
    for i in np.argsort(-np.linalg.norm(force, axis=1), kind="stable")[:MOST].tolist():
        at = int(found["particles"][i])
        cells.append((found["names"][i], at, _vector(result.particles[at]), *(_vector(part[i]) for part in columns)))
    yield _table(heads, cells)
    if len(force) > MOST:
        yield f"<p>The {MOST} largest of {len(force)} are shown.</p>"


def _sizeable(vectors: Any) -> np.ndarray:
    """Vectors (n, 3) without parts that are less than a millionth of the largest, which are what is out of balance."""
    rows = np.asarray(vectors, dtype=float).reshape(-1, 3)
    return np.where(np.abs(rows) < 1e-6 * np.abs(rows).max(initial=0.0), 0.0, rows)


def _cases(scene: Scene, cases: LoadCases) -> Iterator[str]:
    yield "<h2>Load cases and combinations</h2>"
    rows = []
    for name, case in scene.load_cases.items():
        warm = (f"{degrees:+g} K on {line}" for line, degrees in case.temperature.items())
        rows.append((name, f"{case.factor:g} x ({', '.join((*case.forces, *warm))})"))
    for name, factors in scene.combinations.items():
        rows.append((name, " + ".join(f"{factor:g} x {key}" for key, factor in factors.items())))
    yield _table(("case", "loads"), rows)
    if cases.frozen.notes:
        yield "".join(f"<p>{escape(note)}</p>" for note in cases.frozen.notes)
    unit = scene.units.length
    heads = ("case", "status", "stability", f"largest displacement [{unit}]", "at particle", "slack elements")
    found = []
    for name, solved in cases.cases.items():
        far = np.linalg.norm(solved.displacements, axis=1)
        at = first_largest(far)
        result = solved.result
        found.append((name, result.status, result.stability, float(far.max(initial=0.0)), at, solved.slack_count))
    yield _table(heads, found)


def _envelope(found: Envelope, form: Result) -> Iterator[str]:
    yield "<h2>Maxima of all cases, and where they are</h2>"
    unit, rows = found.units, list[tuple[Any, ...]]()
    at = first_largest(found.displacement.largest)
    x, y, z = form.particles[at].tolist()
    rows.append(("displacement", "largest", *_extreme(found, found.displacement, at, "largest"), unit.length,
                 f"particle {at}", _vector((x, y, z))))  # fmt: skip
    for entry, columns in zip(form.forces, found.forces, strict=True):
        for name, extremes in columns["columns"].items():
            if KINDS[columns["kind"]].role == "load" or not len(extremes.largest):
                continue
            called = f"{columns['name'] or columns['kind']} {name}"
            dimension = unit.of(dimensions(columns["kind"])[name]) or "-"
            spots = {"largest": first_largest(extremes.largest), "smallest": first_largest(-extremes.smallest)}
            for which, spot in spots.items():
                value = _extreme(found, extremes, spot, which)
                rows.append((called, which, *value, dimension, f"element {spot}", _middle(entry, spot, form)))
    heads = ("quantity", "extreme", "value", "in case", "unit", "at", f"x, y, z of the form [{unit.length}]")
    yield _table(heads, rows)


def _extreme(found: Envelope, extremes: Extremes, at: int, which: str) -> tuple[float, str]:
    values, cases = getattr(extremes, which), getattr(extremes, f"{which}_case")
    return float(values[at]), found.cases[int(cases[at])]


def _middle(entry: Mapping[str, Any], element: int, form: Result) -> str:
    particles = np.asarray(entry.get("particles", ()), dtype=np.int64)
    if element >= len(particles):
        return ""
    return _vector(form.particles[np.atleast_1d(particles[element])].mean(axis=0))


def _reactions(found: Envelope, form: Result) -> Iterator[str]:
    if not len(found.particles):
        return
    units = found.units
    yield "<h2>Largest reactions of all cases</h2>"
    order = np.argsort(-found.reaction.largest, kind="stable")[:MOST]
    heads = ["support", f"x, y, z [{units.length}]", f"largest reaction [{units.force}]", "in case"]
    kinds = [found.reaction]
    if found.moment is not None:
        kinds.append(found.moment)
        heads += [f"largest moment [{units.of('force length')}]", "in case"]
    rows = [
        (
            f"particle {found.particles[i]}", _vector(form.particles[found.particles[i]]),
            *(part for of in kinds for part in (float(of.largest[i]), found.cases[of.largest_case[i]])),
        )
        for i in order.tolist()
    ]  # fmt: skip
    yield _table(heads, rows)
    if len(found.particles) > MOST:
        yield f"<p>The {MOST} largest of {len(found.particles)} are shown.</p>"


def _case(case: CaseResult, exceeded: Sequence[str] | None, pictures: bool) -> Iterator[str]:
    yield f"<h2>Case {escape(case.name)}</h2>"
    given = " + ".join(f"{factor:g} x {name}" for name, factor in case.factors.items())
    yield f"<p>{escape(given)}. {escape(case.result.message)} Stability: {case.result.stability}.</p>"
    yield from _warned(case.result)
    if pictures:
        yield _picture(case.result, f"Shape and forces under {case.name}")
    yield from _loads(case.result, "Loads")
    yield from _carried(case.result)
    yield _table(("force", "column", "smallest", "largest", "unit"), _ranges(case.result))
    if exceeded is not None:
        yield from _checks(exceeded)


def _exceeded_in(case: CaseResult, cases: LoadCases, limits: Mapping[str, Any]) -> list[str]:
    assert case.result.scene is not None
    system, state = cases.frozen.system(case.result.scene)
    system.x = state.x  # displacements are those from the form
    return _exceeded(limits, system, case.result)


def _exceeded(limits: Mapping[str, Any], system: System, result: Result) -> list[str]:
    return limit_file.exceeded(limits, tables.sections(system, result), system, result, source="the scene")


def _checks(exceeded: Sequence[str]) -> Iterator[str]:
    yield "<h3>Checks</h3>"
    if not exceeded:
        yield "<p>All limits are met.</p>"
    for sentence in exceeded:
        yield f'<p class="failed">{escape(sentence)}</p>'


def _picture(result: Result, caption: str) -> str:
    data = base64.b64encode(picture(result, title=caption, size=SIZE).png).decode()
    return f'<figure><img alt="{escape(caption)}" src="data:image/png;base64,{data}"></figure>'


def _table(heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    top = "".join(f"<th>{escape(head)}</th>" for head in heads)
    body = "".join("<tr>" + "".join(f"<td>{escape(_cell(v))}</td>" for v in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def _cell(value: Any) -> str:
    return f"{value + 0.0:.5g}" if isinstance(value, float) else str(value)  # no -0


def _vector(values: Any) -> str:
    size = float(np.abs(np.asarray(values)).max(initial=0.0))
    return ", ".join(f"{0.0 if abs(v) <= 1e-9 * size else v:.5g}" for v in np.asarray(values).tolist())
