"""Welding: coordinates become particles, deterministically, and what meets none is told."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hookean import InputError, Scene, relax
from hookean.discretize import grid
from hookean.system.system import compile
from hookean.system.weld import weld
from soak import examples


def lines(*ends: tuple[float, float]) -> list[list[list[float]]]:
    return [[[a, 0, 0], [b, 0, 0]] for a, b in ends]


def test_particles_come_in_order_of_first_appearance():
    """Given particles first, unmerged; then the ends of lines as they come, within the tolerance the first wins."""
    scene = Scene(
        particles=[[5, 0, 0], [5, 0, 0]],
        forces=[
            {"kind": "springs", "lines": lines((1, 0), (0.0005, 5))},
            {"kind": "springs", "lines": lines((2, 1.0009))},
        ],
    )
    system = compile(scene)
    assert system.x[:, 0].tolist() == [5, 5, 1, 0, 2]
    assert system.groups[0].block.indices.tolist() == [[2, 3], [3, 0], [4, 2]]
    assert system.report.merged == 3


@settings(derandomize=True, deadline=None, max_examples=examples(60))
@given(st.lists(st.tuples(*[st.integers(0, 6)] * 3), min_size=1, max_size=40), st.sampled_from([0.0, 0.5, 1.1, 2.0]))
def test_welding_is_the_plain_greedy_rule(points: list[tuple[int, int, int]], tolerance: float):
    """Each point joins the first kept point within the tolerance, else it is kept: checked against two loops."""
    array = np.array(points, dtype=float)
    kept: list[np.ndarray] = []
    which = []
    for point in array:
        near = [i for i, other in enumerate(kept) if np.linalg.norm(point - other) <= tolerance]
        which.append(near[0] if near else len(kept))
        if not near:
            kept.append(point)
    found, index = weld(np.zeros((0, 3)), array, tolerance)
    assert found.tolist() == np.array(kept).tolist()
    assert index.tolist() == which


def test_loads_and_anchors_create_no_particles_and_are_told_when_they_miss():
    """An error by default; with strict false the report has each point, with the nearest particle and its distance."""
    scene = {
        "strict": False,
        "forces": [
            {"kind": "springs", "lines": lines((0, 1))},
            {"kind": "unary", "name": "wind", "points": [[1, 0, 0], [3, 4, 0]], "vector": [0, 0, 1]},
        ],
        "anchors": [{"name": "head", "particles": []}, {"name": "foot", "points": [[0, 0, 0.5], [1, 0, 0]]}],
    }
    system = compile(Scene.read(scene))
    assert len(system.x) == 2
    anchor, load = sorted(system.report.unmatched, key=lambda u: u.pointer)
    assert (anchor.pointer, anchor.nearest, anchor.distance) == ("/anchors/1/points/0", 0, 0.5)
    assert (load.pointer, load.name, load.nearest) == ("/forces/1/points/1", "wind", 1)
    assert load.distance == pytest.approx(np.hypot(2, 4))
    assert system.load_count.tolist() == [0, 1]
    del scene["strict"]
    with pytest.raises(InputError) as caught:
        compile(Scene.read(scene))
    load, anchor = caught.value.faults
    assert (load.pointer, anchor.pointer) == ("/forces/1/points", "/anchors/1/points")
    assert load.sentence == (
        "wind: 1 of 2 points met no particle; the nearest is 4.47214 m away from (3, 4, 0). Move it onto a particle, "
        "raise weld_tolerance, or set strict to false to continue without them"
    )
    assert str(caught.value) == f"/forces/1/points: {load.sentence} (and 1 more fault)"


def mesh(count: int) -> dict[str, object]:
    """A square of 2 m in `count` x `count` faces."""
    steps = np.arange(count + 1) * 2.0 / count
    return vars(grid(steps, steps))


def blown(**more: object) -> dict[str, object]:
    """A net in 4 x 4 faces, and wind on the same square in 7 x 7: of its 64 vertices only the corners meet."""
    forces = [
        {"kind": "springs", "mesh": "net", "stiffness": 100.0},
        {"kind": "pressure", "name": "wind", "mesh": "other", "pressure": 5.0},
        {"kind": "self_weight", "mesh": "other", "total": 6.4},
    ]
    corners = [{"points": [[0, 0, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0]]}]
    return {"meshes": {"net": mesh(4), "other": mesh(7)}, "forces": forces, "anchors": corners, **more}


def test_a_load_of_another_division_is_an_error_with_one_sentence_for_each_force():
    """Vertices at 2 i / 7 and at j / 2 m meet at the corners; the smallest distance is 4 / 7 - 1 / 2 = 1 / 14 m."""
    with pytest.raises(InputError) as caught:
        relax(Scene.read(blown()))
    wind, weight = caught.value.faults
    assert (wind.pointer, weight.pointer) == ("/forces/1/mesh", "/forces/2/mesh")
    said = "60 of 64 vertices met no particle; the nearest is 0.0714286 m away from (0, 0.571429, 0)"
    assert wind.sentence.startswith(f"wind: {said}") and weight.sentence.startswith(said)


def test_it_goes_on_with_what_did_meet_where_strict_is_false():
    """The same sentences are warnings; of 6.4 N on 64 vertices each corner has its 0.1 N, and the rest is left out."""
    result = relax(Scene.read(blown(strict=False)))
    wind, weight = result.report.left_out()
    assert wind.startswith("/forces/1/mesh: wind: 60 of 64 vertices met no particle; the nearest is 0.0714286 m away")
    assert "so that part of the load is left out" in wind and weight.startswith("/forces/2/mesh: 60 of 64")
    assert [(m.count, m.total) for m in result.report.missed] == [(60, 64)] * 2
    assert len(result.report.unmatched) == 60  # each point once, though two forces name the mesh
    assert not result.report.warnings and result.to_dict()["report"]["missed"][0]["message"] == wind
    assert result.force("self_weight")["force"] == pytest.approx(np.tile([0, 0, -0.1], (4, 1)), abs=1e-15)
    assert result.force("self_weight")["particles"].tolist() == [[0], [4], [20], [24]]


@pytest.mark.parametrize("strict", [True, False])
def test_anchors_of_which_none_meets_are_an_error_always(strict: bool):
    """There are anchors, so something was to be held; strict false cannot mean that nothing is."""
    stray = [{"name": "a", "points": [[0, 0, 0.5]]}, {"name": "b", "points": [[2, 0, 1], [2, 2, 1]]}]
    net = {"meshes": {"net": mesh(4)}, "forces": [{"kind": "springs", "mesh": "net"}], "strict": strict}
    with pytest.raises(InputError) as caught:
        compile(Scene.read({**net, "anchors": stray}))
    assert [fault.pointer for fault in caught.value.faults] == ["/anchors/0/points", "/anchors/1/points"]
    assert caught.value.faults[0].sentence == (
        "a: its point met no particle; the nearest is 0.5 m away from (0, 0, 0.5). No anchor holds a particle: move it "
        "onto a particle, or raise weld_tolerance"
    )
    one_meets = {**net, "anchors": [*stray, {"particles": []}, {"points": [[2, 2, 0]]}], "strict": False}
    assert len(compile(Scene.read(one_meets)).report.missed) == 2
    compile(Scene.read({**net, "anchors": []}))
    compile(Scene.read({**net, "anchors": [{"particles": []}]}))


def test_lines_are_counted_as_lines_and_their_ends_pointed_at():
    """A weight per length on two lines, one of which has an end off the cable."""
    scene = {
        "forces": [
            {"kind": "springs", "lines": lines((0, 1), (1, 2))},
            {"kind": "self_weight", "name": "own", "lines": lines((0, 1), (1, 2.25)), "per_length": 4.0},
        ]
    }
    with pytest.raises(InputError, match=r"own: 1 of 2 lines met no particle; the nearest is 0\.25 m away") as caught:
        compile(Scene.read(scene))
    assert caught.value.pointer == "/forces/1/lines"
    system = compile(Scene.read({**scene, "strict": False}))
    assert [unmatched.pointer for unmatched in system.report.unmatched] == ["/forces/1/lines/1/1"]
    assert system.groups[1].block.parameters[:, 2].tolist() == [-2, -2]  # the line that met, and no other


def test_geometry_that_meets_no_particle_stays_and_is_a_warning():
    """Strict or not: points, and a mesh, that ride along act on nothing."""
    scene = blown(geometry=[{"kind": "mesh", "mesh": "other"}, {"kind": "points", "points": [[0, 0, 0], [9, 9, 9]]}])
    scene["forces"] = scene["forces"][:1]
    system = compile(Scene.read(scene))
    assert system.report.warnings == [
        "/geometry/0: 60 of 64 points meet no particle and stay in place",
        "/geometry/1: 1 of 2 points meet no particle and stay in place",
    ]
    assert not system.report.missed


def test_many_anchors_that_miss_are_a_few_sentences():
    """An anchor for each of 40 points, 38 of which miss: ten sentences and how many more there are."""
    anchors = [{"points": [[i, 0, 0]]} for i in range(40)]
    scene = {"forces": [{"kind": "springs", "lines": lines((0, 1))}], "anchors": anchors}
    said = compile(Scene.read({**scene, "strict": False})).report.sentences()
    assert len(said) == 11 and said[0].startswith("/anchors/2/points: its point met no particle; the nearest is 1 m")
    assert said[10] == "points of 28 more forces or anchors met no particle"
    with pytest.raises(InputError, match=r"\(and 37 more faults\)$"):
        compile(Scene.read(scene))


def test_a_vertex_that_no_face_uses_counts_where_vertices_are_loaded_only():
    """A square and a loose vertex beside the net: a weight on vertices is on it too; weights of edges, pressure not."""
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    scene = {
        "particles": square,
        "meshes": {"net": {"vertices": [*square, [0, 0, 7]], "faces": [[0, 1, 2, 3]]}},
        "forces": [
            {"kind": "springs", "particles": [[0, 1], [1, 2], [2, 3]]},
            {"kind": "self_weight", "mesh": "net", "total": 5.0},
            {"kind": "self_weight", "mesh": "net", "per_length": 1.0},
            {"kind": "pressure", "mesh": "net"},
        ],
        "strict": False,
    }
    [missed] = compile(Scene.read(scene)).report.missed
    assert (missed.pointer, missed.count, missed.total, missed.distance) == ("/forces/1/mesh", 1, 5, 7.0)


@pytest.mark.parametrize(
    ("force", "sentence"),
    [
        ({"kind": "springs", "particles": [[0, 1, 2]]}, "shape [1, 3] given; each element needs 2 particles"),
        ({"kind": "unary", "particles": [[0, 1]], "vector": [0, 0, 1]}, "[1, 2] given; each element needs 1 particle"),
    ],
)
def test_an_element_has_as_many_particles_as_its_force_needs(force: dict[str, object], sentence: str):
    with pytest.raises(InputError) as caught:
        compile(Scene.read({"particles": [[0, 0, 0], [1, 0, 0], [2, 0, 0]], "forces": [force]}))
    assert caught.value.pointer == "/forces/0/particles" and str(caught.value).endswith(sentence)


def test_columns_must_fit_their_elements():
    """Every number of a force is one value or one for each element."""
    scene = Scene.read({"forces": [{"kind": "springs", "lines": lines((0, 1), (1, 2)), "stiffness": [1, 2, 3]}]})
    with pytest.raises(InputError) as caught:
        compile(scene)
    assert caught.value.pointer == "/forces/0/stiffness"
    assert "3 values for 2 elements" in caught.value.sentence


def test_springs_on_a_mesh_choose_its_edges():
    """all, warp, weft, naked, diagonals of a 2 x 1 quad mesh."""
    mesh = {
        "vertices": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]],
        "faces": [[0, 1, 4, 3], [1, 2, 5, 4]],
    }
    counts = {}
    for edges in ("all", "warp", "weft", "naked", "diagonals"):
        scene = Scene(meshes={"net": mesh}, forces=[{"kind": "springs", "mesh": "net", "edges": edges}])
        counts[edges] = len(compile(scene).groups[0].block.indices)
    assert sorted([counts.pop("warp"), counts.pop("weft")]) == [3, 4]
    assert counts == {"all": 7, "naked": 6, "diagonals": 4}


def test_a_spring_without_length_is_told():
    """Both ends weld to one particle: it does nothing, and the report says so."""
    system = compile(Scene(forces=[{"kind": "springs", "lines": lines((0, 1), (1, 1.0001))}]))
    assert any("start and end at one particle" in w for w in system.report.warnings)


few = st.sets(st.integers(0, 5))


@settings(derandomize=True, deadline=None, max_examples=examples(200), database=None)
@given(loads=few, sprung=few, pulled=few, held=few, sliding=few, floor=st.booleans())
def test_a_load_on_what_nothing_touches_is_a_warning(
    loads: set[int], sprung: set[int], pulled: set[int], held: set[int], sliding: set[int], floor: bool
):
    """Springs, another force or an anchor on all axes take a load, an anchor on some axes does not, and a floor any.

    What carries a load and none of these, counted by sets; particles without a load never.
    """
    kinds = {
        "unary": {"particles": sorted(loads), "vector": [0, 0, -1]},
        "springs": {"particles": [[p, 6] for p in sorted(sprung)], "rest_length": 0.0},
        "anchor_spring": {"particles": sorted(pulled)},
    }
    spec = {
        "particles": [[p, p % 2, 0.1 * p * p] for p in range(7)],
        "forces": [{"kind": kind, **given} for kind, given in kinds.items() if given["particles"]],
        "anchors": [
            {"particles": sorted(ps), "axes": axes} for ps, axes in ((held, "xyz"), (sliding - held, "xy")) if ps
        ],
        "settings": {"floor": {"point": [0, 0, -1]}} if floor else {},
    }
    said = [w for w in compile(Scene.read(spec)).report.warnings if "carries a load" in w]
    alone = sorted(set() if floor else loads - sprung - pulled - held)
    more = f" (and {len(alone) - 1} more)" if len(alone) > 1 else ""
    first = (
        f"particle {alone[0]} carries a load but is unsupported: no spring, other force or anchor holds it"
        if alone
        else ""
    )
    assert said == ([first + more] if alone else [])


@pytest.mark.parametrize("kind", ["bend", "hinge"])
def test_corners_that_meet_nothing_create_no_particles(kind: str):
    """A bend or hinge drawn beside the springs is an error, as a load there is. With strict false its other elements
    act as if it had not been drawn, also where the one in the middle of a rod is left out."""
    x = np.array([[i, 0.3 * np.sin(2.0 * i), 0.1 * i * i] for i in range(7)])
    count = {"bend": 3, "hinge": 4}[kind]
    places = [x[i : i + count] for i in range(8 - count)]
    beside = [*places[:1], places[1] + [0, 0, 5.0], *places[2:]]
    springs = {"kind": "springs", "lines": [[x[i], x[i + 1]] for i in range(6)], "stiffness": 1e4}
    load = {"kind": "unary", "points": [x[3]], "vector": [0, 0, -1.0]}

    def scene(points: list, **more: object) -> Scene:
        drawn = {"kind": kind, "points": points, "angle_factor": 0.9}
        return Scene.read({"forces": [springs, drawn, load], "anchors": [{"points": [x[0], x[1], x[6]]}], **more})

    with pytest.raises(InputError, match=r"/forces/1/points: 1 of \d points met no particle"):
        relax(scene(beside))
    left, without = relax(scene(beside, strict=False)), relax(scene([*places[:1], *places[2:]]))
    assert len(left.particles) == len(without.particles) == 7
    assert left.particles.tobytes() == without.particles.tobytes()
    assert "/forces/1/points: 1 of" in left.report.left_out()[0]


@settings(derandomize=True, deadline=None, max_examples=examples(60))
@given(
    st.lists(st.tuples(*[st.integers(0, 4)] * 3), min_size=1, max_size=60),
    st.lists(st.tuples(*[st.integers(0, 4)] * 3), min_size=1, max_size=60),
    st.sampled_from([0.0, 0.5, 1.1, 2.0]),
    st.integers(1, 12),
)
def test_points_join_the_first_given_particle_however_many_are_near(
    first: list[tuple[int, int, int]], points: list[tuple[int, int, int]], tolerance: float, times: int
) -> None:
    """Given particles are kept, however near each other; a point joins the first one, else the first kept point."""
    before = np.array(first * times, dtype=float)  # beyond 300 a tree is asked
    kept, which = [*before], []
    for point in np.array(points, dtype=float):
        near = [i for i, other in enumerate(kept) if np.linalg.norm(point - other) <= tolerance]
        which.append(near[0] if near else len(kept))
        if not near:
            kept.append(point)
    found, index = weld(before, np.array(points, dtype=float), tolerance)
    assert found.tolist() == np.array(kept).tolist() and index.tolist() == which


@pytest.mark.soak
def test_a_crowd_of_given_particles_is_welded_to_in_a_moment() -> None:
    """40,000 points all within the tolerance of 40,000 particles: 1.6e9 pairs, which are not looked at one by one."""
    crowd = np.random.default_rng(3).uniform(-1e-4, 1e-4, (40_000, 3))
    found, index = weld(crowd, crowd[::-1] + 1e-9, 1e-3)
    assert found.tolist() == crowd.tolist() and (index == 0).all()
    scene = {"particles": crowd, "forces": [{"kind": "unary", "points": crowd[::-1] + 1e-9, "vector": [0, 0, -1]}]}
    assert (compile(Scene(**scene)).groups[0].block.indices == 0).all()


@pytest.mark.soak
def test_many_forces_that_lie_on_each_other_are_reported_with_their_first_pairs() -> None:
    """400 lines 1e-5 apart, 79,800 pairs of forces: ten sentences, and how many more."""
    at = np.linspace(0.0, 1.0, 10)
    rows = [np.c_[at, np.full(10, i * 1e-5), np.zeros(10)] for i in range(400)]
    forces = [{"kind": "springs", "lines": np.stack([row[:-1], row[1:]], 1)} for row in rows]
    scene = Scene(forces=forces, anchors=[{"points": rows[0][:1]}], settings={}, weld_tolerance=1e-9)
    said = [w for w in compile(scene).report.warnings if "joined" in w or "nearly meet" in w]
    assert len(said) == 11 and "/forces/0" in said[0] and said[-1].endswith("more pairs of forces nearly meet")


def test_the_time_limit_counts_welding(monkeypatch: pytest.MonkeyPatch) -> None:
    """A clock on which welding takes a minute: nothing is left of a limit of 30 s, and enough of one of a day."""
    import time

    from hookean.system.weld import Welded

    passed, clock, welding = 0.0, time.monotonic, Welded._weld

    def slow(self: Welded) -> None:
        nonlocal passed
        passed += 60.0
        welding(self)

    monkeypatch.setattr(Welded, "_weld", slow)
    monkeypatch.setattr(time, "monotonic", lambda: clock() + passed)
    scene = {
        "forces": [
            {"kind": "springs", "lines": lines((0, 1), (1, 2))},
            {"kind": "unary", "points": [[1, 0, 0]], "vector": [0, 0, -9]},
        ],
        "anchors": [{"points": [[0, 0, 0], [2, 0, 0]]}],
    }
    ended = [str(relax(Scene(**scene, settings={"time_limit": limit})).status) for limit in (30.0, 90_000.0)]
    assert ended == ["time_limit", "converged"]


def test_a_section_that_does_not_exist_is_named():
    beam = {"kind": "beam", "particles": [[0, 1]], "material": "S235", "section": "tube"}
    spec = {"particles": [[0, 0, 0], [1, 0, 0]], "forces": [beam], "anchors": [{"particles": [0], "rotations": "xyz"}]}
    with pytest.raises(InputError, match="section 'tube' does not exist") as found:
        compile(Scene.read(spec))
    assert found.value.pointer


def test_only_springs_with_a_rest_length_are_warned_of_for_zero_length():
    """A spring that shall have no length may start with none."""
    for rest, warned in ((0.0, False), (1.0, True)):
        spring = {"kind": "springs", "particles": [[0, 1]], "rest_length": rest}
        spec = {"particles": [[0, 0, 0], [0, 0, 0]], "forces": [spring], "anchors": [{"particles": [0]}]}
        assert any("zero length" in said for said in compile(Scene.read(spec)).report.warnings) is warned


@pytest.mark.parametrize("strict", [True, False])
def test_an_anchor_of_a_scene_without_particles_is_refused_in_a_sentence(strict: bool):
    spec = {"anchors": [{"name": "mast", "points": [[0, 0, 0]]}], "strict": strict}
    with pytest.raises(InputError, match="mast: the scene has no particles to meet") as found:
        compile(Scene.read(spec), empty=True)
    assert found.value.pointer == "/anchors/0/points"


def test_edges_of_a_mesh_that_weld_to_points_are_counted_and_measured() -> None:
    """A square of 4 by 4 vertices, 0.5 mm apart, in metres: only the first and last of each row and column stay."""
    at = 0.0005 * np.arange(4.0)
    vertices = [[x, y, 0.0] for y in at for x in at]
    faces = [[4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4] for j in range(3) for i in range(3)]
    mesh = {"vertices": vertices, "faces": faces}
    data = {"meshes": {"cloth": mesh}, "forces": [{"kind": "springs", "mesh": "cloth"}]}
    (said,) = [one for one in compile(Scene.read(data)).report.warnings if one.startswith("/meshes")]
    assert "edges have their ends in one particle (first: vertices 0 and 1), up to 0.0005 m long" in said
    assert said.endswith("lower weld_tolerance, 0.001 m now, or draw the mesh larger")
    finer = compile(Scene.read({**data, "weld_tolerance": 1e-6})).report.warnings
    assert not [one for one in finer if one.startswith("/meshes")]


def test_a_mesh_that_is_welded_along_a_seam_has_no_edge_to_warn_of() -> None:
    """Two squares with vertices of their own at their common edge, a triangle that repeats its last corner."""
    vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]]
    mesh = {"vertices": vertices, "faces": [[0, 1, 2, 3], [4, 5, 6]]}
    data = {"meshes": {"cloth": mesh}, "forces": [{"kind": "springs", "mesh": "cloth"}]}
    assert not [one for one in compile(Scene.read(data)).report.warnings if one.startswith("/meshes")]
