"""The bench's own parts: its measure, its solvers on a small net, its pages."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

HERE = Path(__file__).parents[1] / "benchmarks"
NAMES = ("problems", "peers", "page", "stepping", "startup", "bench", "design_problems", "design")


@pytest.fixture(scope="module")
def parts() -> Iterator[dict[str, ModuleType]]:
    """The bench's modules, which are a program's and no package's."""
    sys.path.insert(0, str(HERE))
    try:
        yield {name: importlib.import_module(name) for name in NAMES}
    finally:
        sys.path.remove(str(HERE))
        for name in NAMES:
            sys.modules.pop(name, None)


def test_the_measure_is_the_force_left_over(parts: dict[str, ModuleType]) -> None:
    """Two springs of k = 50 and rest length 1, stretched to 2 along x, pull their middle by 50 - 50; a load of 3 on it
    is left, by the mean spring force of 50, which is larger than the mean load of 1."""
    problems = parts["problems"]
    x = np.array([[-2.0, 0, 0], [0, 0, 0], [2, 0, 0]])
    load = np.array([[0, 0, 0], [0, 0, -3.0], [0, 0, 0]])
    springs = np.array([[0, 1], [1, 2]])
    p = problems.Problem("pair", x, springs, np.full(2, 50.0), np.ones(2), load, np.array([0, 2]))
    assert problems.residual(p, x) == pytest.approx(3.0 / 50.0, rel=1e-15)
    assert problems.residual(p, x * np.nan) == np.inf


@pytest.mark.soak
@pytest.mark.parametrize("name", ["cable", "membrane", "soapfilm", "sheet", "tent"])
def test_every_solver_finds_the_same_shape(parts: dict[str, ModuleType], name: str) -> None:
    """At a residual of 1e-6 shapes differ by no more than 1e-3 of the model, the bar of the table."""
    problems, peers, bench = parts["problems"], parts["peers"], parts["bench"]
    p = problems.make(name, 12)
    solves = {"numba-dr": peers.numba_dr, "numba-k2": peers.numba_k2, "L-BFGS-B": peers.lbfgsb}
    if name == "soapfilm":
        solves["scipy FDM"] = peers.scipy_fdm
    timed = {what: bench.Timed([run(p, bench.TARGET, 600.0)]) for what, run in solves.items()}
    timed[bench.OURS] = bench.Timed([bench.hookean(p, 20.0)()])
    for row in bench.rows(p, 12, timed, 20.0):
        assert not row.missed and row.error <= 1e-3, row
        assert row.work >= 1 or row.iterations == 0


def test_what_a_peer_cannot_do_is_said_and_what_is_slow_is_left_out(parts: dict[str, ModuleType]) -> None:
    """Force density refuses a membrane; a peer named slow is not asked, and one that fails is told of."""
    peers, problems, bench = parts["peers"], parts["problems"], parts["bench"]

    def broken(*_: object) -> None:
        raise ZeroDivisionError("by zero")

    given = {"scipy FDM": peers.scipy_fdm, "slow": broken, "broken": broken}
    timed = bench.compare(problems.make("membrane", 4), given, 1, 5.0, {"slow": "took 9 s at 4"})
    assert len(timed[bench.OURS].runs) == 1
    said = {name: entry.said for name, entry in timed.items() if not entry.runs}
    assert said == {
        "scipy FDM": "force density supports rest length 0 only",
        "slow": "took 9 s at 4",
        "broken": "by zero",
    }


def test_the_table_has_the_sizes_it_promises(parts: dict[str, ModuleType]) -> None:
    cases = parts["bench"].cases
    assert {s for n, s in cases([], []) if n == "cable"} == {50, 1_000, 10_000, 100_000}
    assert {n for n, s in cases([], []) if s == 1_000_000} == {"membrane", "soapfilm"}
    assert cases(["tent"], [1_000]) == [("tent", 1_000)]


@pytest.mark.soak
def test_hookean_and_c_step_and_a_shell_falls(parts: dict[str, ModuleType]) -> None:
    """Rates are positive; the net of C moves, and no number is lost; the sphere is closed: V - E + F = 2."""
    stepping, problems = parts["stepping"], parts["problems"]
    rates = stepping.stepping((5,), 1)
    assert rates["hookean verlet", 5] > 0 and all(np.isfinite(rate) for rate in rates.values())
    p = problems.make("membrane", 5)
    stepping.verlet(p)(3)
    scene = stepping.sphere(6, 4)
    faces = scene["meshes"]["sphere"]["faces"]
    edges = {frozenset((f[i], f[(i + 1) % len(f)])) for f in faces for i in range(len(f))}
    assert len(scene["meshes"]["sphere"]["vertices"]) - len(edges) + len(faces) == 2
    assert list(stepping.frames(((6, 4),), 0.0)) == [20]


def test_the_readme_gets_the_pages_figures_between_its_marks(parts: dict[str, ModuleType], tmp_path: Path) -> None:
    page = parts["page"]
    row = page.Row("cable", 50, "hookean", 0.0123, 0.01, 3, 5, 5.0, 1e-7, 1e-6, 1e-9, 1e-12, 2.0, 0.0)
    base = page.Row("cable", 50, "numba-dr", 0.0246, 0.02, 3, 99, 99.0, 1e-3, 1e-6, 1e-9, 1e-12, 1.0, 0.0)
    text = page.short([row, base], {("hookean verlet", 1000): 41e6}, [("hookean relax FILE", [0.5, 0.7, 0.6])], "M")
    assert "0.0123" in text and "0.0123" in page.solved([row, base]) and "41 at 1000" in text and "0.600 s" in text
    assert "0.0246" not in text and "(missed)" in page.solved([row, base])  # one that missed is no rival
    readme = tmp_path / "README.md"
    readme.write_text(f"before\n{page.BEGIN}\nold\n{page.END}\nafter\n", encoding="utf-8")
    page.put(readme, text)
    assert readme.read_text(encoding="utf-8") == f"before\n{page.BEGIN}\n{text}\n{page.END}\nafter\n"
    readme.write_text("nothing", encoding="utf-8")
    with pytest.raises(ValueError, match="no place"):
        page.put(readme, text)
    assert page.BEGIN in (HERE.parent / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["arch", "pringle"])
def test_design_problems_are_the_same_for_both_programs(parts: dict[str, ModuleType], name: str) -> None:
    """The bench's own evaluation of force densities and hookean's search give one objective at the start, and the
    search's is lower."""
    import hookean

    problem = parts["design_problems"].PROBLEMS[name]()
    given = parts["design"].given(problem) | {"settings": {"max_iterations": 5}}
    found = hookean.design(given)
    value = problem.objective(np.asarray(found.variables[0]["value"]))
    assert value == pytest.approx(found.objective, rel=1e-9)
    assert value < 0.5 * problem.objective(problem.start)
