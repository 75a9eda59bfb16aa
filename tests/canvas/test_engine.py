"""The engine on the canvas: held, run, patched, reset; its session when files are copied, saved and opened again."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import hookean_client
from canvas.canvasing import Bench, let_go, line, point, sentences, xyz
from hookean_canvas.run import stand_in
from hookean_client import canvas, canvas_draw, canvas_engine, canvas_link, canvas_words
from hookean_client.canvas_player import Player
from serving import Home, wait_for


@pytest.fixture(scope="module", autouse=True)
def rhino() -> Iterator[None]:
    made = stand_in.Canvas().install()
    yield
    made.remove()


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    home = Home(tmp_path_factory.mktemp("engine") / "state")
    home.serve()
    yield home
    home.end()


@pytest.fixture
def home(served: Home, monkeypatch: pytest.MonkeyPatch) -> Iterator[Home]:
    """A server for components, whose engines are let go afterwards."""
    monkeypatch.setenv("HOOKEAN_STATE", str(served.folder))
    canvas_link.service.forget()
    yield served
    let_go()


def reopen() -> None:
    """As after Rhino was closed: nothing is left in this process."""
    for player in canvas_engine._players.values():
        if player.frames is not None:
            player.frames.close()
        player.frames, player.ended = None, True
    canvas_engine._players.clear()
    canvas_engine._keys.clear()


COUNT = itertools.count()


class Cable:
    """A definition: a line of ten springs under loads, held at both ends by two points."""

    def __init__(self, bench: Bench | None = None, guid: Any = None) -> None:
        self.bench = bench or Bench(f"/models/cable-{next(COUNT)}.gh")
        self.engine = self.bench.component("Engine", ("_forces", "anchors_"), guid)
        self.count, self.load, self.stiffness = 10, -10.0, 1000.0
        self.anchors: Any = [point(0, 0, 0), point(10, 0, 0)]
        self.geometry: Any = None
        self.springs, self.loads = self.bench.component("Springs"), self.bench.component("Load")
        self.settings = {"drag": 5.0, "fast": True}
        self.out: Any = None

    def forces(self) -> list[str]:
        spans = [line((i, 0, 0), (i + 1, 0, 0)) for i in range(self.count)]
        places = [point(i, 0, 0) for i in range(self.count + 1)]
        vector = stand_in.Vector3d(0, 0, self.load)
        return [
            canvas.force(self.springs, "springs", lines=spans, stiffness=[self.stiffness]),
            canvas.force(self.loads, "unary", points=places, vector=[vector]),
        ]

    def solve(self, reset: bool) -> Any:
        text = canvas.settings(self.springs, **self.settings)
        self.out = canvas_engine.solve(self.engine, self.forces(), self.anchors, [text], self.geometry, reset)
        return self.out

    def hold(self) -> Any:
        """Reset, and solutions until nothing is scheduled."""
        return self.bench.run(self.engine, lambda: self.solve(True))

    def run(self, until: Any = None) -> Any:
        """Run, until it is at rest or `until`."""
        return self.bench.run(self.engine, lambda: self.solve(False), until)

    @property
    def player(self) -> Player:
        return canvas_engine._player(self.engine)

    def at(self, number: int) -> tuple[float, float, float]:
        return xyz(self.out.particles[number])


def close(a: Any, b: Any, within: float = 1e-6) -> bool:
    return all(abs(p - q) < within for p, q in zip(a, b, strict=True))


def keys() -> set[str]:
    client = hookean_client.connect(start=False)
    found = {row["key"] for row in client.get("/v1/sessions")["sessions"]}
    client.close()
    return found


def test_true_holds_it_at_the_start_and_false_runs_it_to_rest(home: Home) -> None:
    cable = Cable()
    cable.hold()
    assert cable.out.iterations == 0
    assert [xyz(p) for p in cable.out.particles] == [(i, 0, 0) for i in range(11)]
    assert cable.engine.Component.Message == "held at the start"
    cable.run()
    assert close(cable.at(5), (5, 0, -1.733760513267))
    assert cable.engine.Component.Message == f"at rest after {cable.out.iterations}"
    assert not cable.bench.document.scheduled
    cable.hold()
    assert [xyz(p) for p in cable.out.particles] == [(i, 0, 0) for i in range(11)]


def test_the_form_moves_while_it_runs(home: Home) -> None:
    cable = Cable()
    cable.settings = {"drag": 0.5}
    seen = [cable.run(lambda out: out.iterations) and cable.at(5)[2]]
    cable.run(lambda out: xyz(out.particles[5])[2] != seen[0])
    assert "iteration" in cable.engine.Component.Message
    assert not sentences(cable.engine)


def test_a_moved_anchor_and_changed_numbers_are_patches(home: Home) -> None:
    """They act at once on what runs: no new scene, no fresh start."""
    cable = Cable()
    cable.run()
    form, before = cable.player.form, cable.out.iterations
    cable.anchors = [point(0, 0, 0), point(10, 0, 2)]
    cable.load, cable.stiffness, cable.settings = -20.0, 2000.0, {"drag": 4.0, "fast": True}
    cable.run()
    assert cable.player.form == form
    assert cable.out.iterations > before
    assert close(cable.at(10), (10, 0, 2))
    assert cable.out.forces.Branch(1)[0] == stand_in.Vector3d(0, 0, -20)


def test_other_geometry_is_another_scene_of_the_same_session(home: Home) -> None:
    cable = Cable()
    cable.run()
    known, low = keys(), cable.at(5)
    cable.count = 11
    cable.solve(False)
    cable.run(lambda out: len(out.particles) == 12)
    assert close(cable.at(0), (0, 0, 0)) and cable.at(5)[2] < 0.5 * low[2]  # it went on from where it was
    assert keys() == known


def test_a_reset_keeps_every_support(home: Home) -> None:
    """An anchor that was moved before the reset holds the particle it first met."""
    cable = Cable()
    cable.hold()
    cable.anchors = [point(0, 0, 0), point(12.25, 0, 1)]
    cable.run()
    cable.hold()
    assert close(cable.at(10), (12.25, 0, 1))
    assert close(cable.at(9), (9, 0, 0))
    assert not sentences(cable.engine)
    cable.run()
    assert close(cable.at(10), (12.25, 0, 1))


def test_an_anchor_put_on_another_particle_during_a_reset_holds_that_one(home: Home) -> None:
    cable = Cable()
    cable.hold()
    cable.anchors = [point(0, 0, 0), point(7, 0, 0)]
    cable.hold()
    assert [xyz(p) for p in cable.out.particles] == [(i, 0, 0) for i in range(11)]
    cable.run(lambda out: xyz(out.particles[10])[2] < -1.0)
    assert close(cable.at(7), (7, 0, 0))


def test_a_model_that_is_shifted_takes_its_anchors_along(home: Home) -> None:
    """Also by as much as one spring, when another particle comes to lie where an anchor was."""
    cable = Cable()
    cable.run()
    cable.bench.solve(cable.engine, lambda: cable.solve(False))
    spans = cable.forces

    def shifted() -> list[str]:
        lines = [line((i + 1, 0, 0), (i + 2, 0, 0)) for i in range(10)]
        return [canvas.force(cable.springs, "springs", lines=lines), spans()[1]]

    cable.forces = shifted  # type: ignore[method-assign]
    cable.anchors = [point(1, 0, 0), point(11, 0, 0)]
    cable.run(lambda out: cable.player.settled and close(xyz(out.particles[10]), (11, 0, 0)))
    assert close(cable.at(0), (1, 0, 0)) and cable.at(5)[2] < -1.0


def test_copies_have_sessions_of_their_own(home: Home) -> None:
    cable = Cable()
    cable.hold()
    copy = Cable(cable.bench)
    copy.load = -30.0
    copy.run()
    cable.run()
    assert cable.player.key != copy.player.key
    assert copy.at(5)[2] < cable.at(5)[2] < 0


def test_a_definition_opened_again_finds_its_form_and_its_supports(home: Home) -> None:
    cable = Cable()
    cable.run()
    cable.anchors = [point(0, 0, 0), point(10, 0, 2.5)]
    cable.run()
    form, known, document = cable.at(5), keys(), cable.bench.document
    reopen()
    again = Cable(Bench(document.FilePath, document.DocumentID), cable.engine.Component.InstanceGuid)
    again.springs, again.loads = cable.springs, cable.loads
    again.anchors = cable.anchors
    again.run()
    assert close(again.at(5), form) and close(again.at(10), (10, 0, 2.5))
    assert keys() == known
    again.hold()
    assert close(again.at(10), (10, 0, 2.5)) and close(again.at(9), (9, 0, 0))
    assert not sentences(again.engine)


def test_a_definition_saved_as_another_goes_on_in_a_session_of_its_own(home: Home) -> None:
    cable = Cable()
    cable.run()
    cable.anchors = [point(0, 0, 0), point(10, 0, 2.5)]
    cable.run()
    first, iterations, form = cable.player.key, cable.out.iterations, cable.at(5)
    cable.bench.document.FilePath = f"/models/other-{next(COUNT)}.gh"
    cable.run()
    assert cable.player.key != first and {first, cable.player.key} <= keys()
    assert cable.out.iterations >= iterations and close(cable.at(5), form)
    assert close(cable.at(10), (10, 0, 2.5))


def test_a_definition_saved_over_another_takes_its_place(home: Home) -> None:
    cable = Cable()
    cable.run()
    there, first = cable.bench.document.FilePath, cable.player.key
    cable.bench.document.FilePath = f"/models/other-{next(COUNT)}.gh"
    cable.load = -40.0
    cable.run()
    form = cable.at(5)
    cable.bench.document.FilePath = there
    seen: list[float] = []
    cable.run(lambda out: seen.append(xyz(out.particles[5])[2]) or cable.player.settled)
    assert cable.player.key == first
    assert close(cable.at(5), form) and max(seen) < 0.99 * form[2]  # from there, not from what the file had been


def test_a_session_that_was_forgotten_is_made_again(home: Home) -> None:
    cable = Cable()
    cable.run()
    form = cable.at(5)
    client = hookean_client.connect(start=False)
    client.session(cable.player.key).delete()
    client.close()
    cable.load = -10.5
    cable.run(lambda out: cable.player.settled)
    assert cable.at(5)[2] < form[2]


def test_points_that_meet_no_particle_are_named_and_drawn(home: Home) -> None:
    cable = Cable()
    cable.anchors = [point(0, 0, 0), point(10, 0, 0), point(5.3, 0, 0)]
    cable.run()
    [said] = sentences(cable.engine, "Warning")
    assert said == (
        "Anchor 2 of anchors_, branch {0}: its point met no particle; the nearest is 0.3 m away from (5.3, 0, 0), so "
        "nothing is held there. Move it onto a particle, or raise the tolerance in Settings."
    )
    assert said in cable.out.report
    display = canvas_draw._displays[cable.player.key]
    assert [xyz(place) for place, _ in display.points] == [(5.3, 0, 0)]
    assert cable.out.reactions.Branch(0)[2] is None
    cable.anchors[2] = point(5, 0, 0)  # put onto one, it holds that one
    cable.run()
    assert close(cable.at(5), (5, 0, 0)) and not sentences(cable.engine)


def test_a_load_is_one_sentence_and_anchors_of_which_none_meets_are_an_error(home: Home) -> None:
    """The net goes on without loads that miss; without any anchor it is refused until one is put onto a particle."""
    cable = Cable()
    cable.count = 4
    cable.anchors = [point(0, 0, 0), point(4, 0, 0)]
    wide = Cable(cable.bench)
    cable.forces = lambda: [Cable.forces(cable)[0], Cable.forces(wide)[1]]  # type: ignore[method-assign]
    cable.run()
    [said] = sentences(cable.engine, "Warning")
    assert said == (
        "Load: 6 of 11 points met no particle; the nearest is 1 m away from (5, 0, 0), so that part of the load is "
        "left out. Move them onto particles, or raise the tolerance in Settings."
    )
    assert cable.out.status.startswith("In equilibrium")
    astray = Cable()
    astray.anchors = [point(0.5, 0, 0), point(9.5, 0, 0)]
    astray.run(lambda out: bool(sentences(astray.engine, "Error")))
    [said] = sentences(astray.engine, "Error")
    assert said.startswith("Anchor 0 of anchors_, branch {0}: its point met no particle; the nearest is 0.5 m away")
    assert "No anchor holds a particle: move it onto a particle, or raise the tolerance in Settings (and 1 more" in said
    astray.anchors = [point(0, 0, 0), point(10, 0, 0)]
    astray.run()
    assert not sentences(astray.engine) and astray.out.reactions.Branch(0)[0] is not None


def test_forces_are_drawn_in_colours_with_a_legend(home: Home) -> None:
    cable = Cable()
    cable.run()
    display = canvas_draw._displays[cable.player.key]
    assert len(display.lines) == 10
    assert [text.split()[1] for text, _ in display.texts] == ["N"] * canvas_draw.STEPS
    pulls = [float(text.split()[0]) for text, _ in display.texts]
    assert pulls[-1] == pytest.approx(83.05, abs=0.01)
    assert display.texts[-1][1].R > display.texts[0][1].R or display.texts[-1][1].G < display.texts[0][1].G
    cable.engine.Component.Hidden = True
    cable.bench.solve(cable.engine, lambda: cable.solve(False))
    assert not display.lines and not display.Enabled


def test_forces_come_out_by_component_and_geometry_in_its_tree(home: Home) -> None:
    """Springs of several branches of one component share a branch; items are in the order they came in."""
    cable = Cable()
    cable.count = 4
    both = cable.springs

    def forces() -> list[str]:
        found = []
        for run, spans in ((1, range(2)), (2, range(2, 4))):
            both.Component.RunCount = run
            lines = [line((i, 0, 0), (i + 1, 0, 0)) for i in spans]
            found.append(canvas.force(both, "springs", lines=lines, stiffness=[1000.0 * run]))
        return [*found, canvas.force(cable.loads, "unary", points=[point(2, 0, 0)], vector=stand_in.Vector3d(0, 0, -5))]

    cable.forces = forces  # type: ignore[method-assign]
    tree = stand_in.DataTree()
    tree.Add(stand_in.PolylineCurve([point(i, 0, 0) for i in range(5)]), stand_in.GH_Path(0, 1))
    tree.Add(point(2, 0, 0), stand_in.GH_Path(3))
    tree.Add(point(2, 9, 0), stand_in.GH_Path(3))
    cable.geometry = tree
    anchors = stand_in.DataTree()
    anchors.Add(point(4, 0, 0), stand_in.GH_Path(1))
    anchors.Add(point(0, 0, 0), stand_in.GH_Path(0))
    cable.anchors = anchors
    cable.run()
    assert [str(path) for path in cable.out.forces.Paths] == ["{0}", "{1}"]
    assert len(cable.out.forces.Branch(0)) == 4 and len(cable.out.forces.Branch(1)) == 1
    assert [str(path) for path in cable.out.geometry.Paths] == ["{0;1}", "{3}"]
    moved, stays = cable.out.geometry.Branch(stand_in.GH_Path(3))
    assert xyz(moved) == cable.at(2) and xyz(stays) == (2, 9, 0)
    curve = cable.out.geometry.Branch(stand_in.GH_Path(0, 1))[0]
    assert [xyz(p) for p in curve.TryGetPolyline()[1]] == [xyz(p) for p in cable.out.particles]
    lift = [cable.out.reactions.Branch(stand_in.GH_Path(i))[0] for i in (0, 1)]
    assert lift[0].X < 0 < lift[1].X and pytest.approx(5.0) == lift[0].Z + lift[1].Z


def test_what_the_service_refuses_is_said_with_the_components_name(home: Home) -> None:
    cable = Cable()
    cable.stiffness = -5.0
    cable.bench.run(cable.engine, lambda: cable.solve(False))
    [said] = sentences(cable.engine, "Error")
    assert "Springs, stiffness" in said and "-5" in said
    cable.stiffness = 500.0
    cable.run()
    assert not sentences(cable.engine) and cable.at(5)[2] < -2.0


def test_inputs_that_belong_elsewhere_are_refused(home: Home) -> None:
    cable = Cable()
    text = canvas.anchors(cable.loads, [point(0, 0, 0)])
    said = {
        "_forces: anchors are connected here; they belong to another input.": ([text], None),
        "_forces is missing; connect the outputs of force components.": (None, None),
        '_forces: the text "hello" is not a hookean object; connect the output of a hookean component.': (
            ["hello"],
            None,
        ),
        "A Line is not a point; connect points.": (cable.forces(), [line((0, 0, 0), (1, 0, 0))]),
    }
    for sentence, (forces, anchors) in said.items():
        cable.bench.solve(cable.engine, lambda f=forces, a=anchors: canvas_engine.solve(cable.engine, f, a))
        assert sentences(cable.engine) == [sentence]


def test_nobody_watches_for_long(home: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """A component that was deleted lets its session stand still; one that comes back goes on."""
    monkeypatch.setattr("hookean_client.canvas_player.LEFT", 0.5)
    cable = Cable()
    cable.settings = {"drag": 0.01}
    cable.run(lambda out: out.iterations)
    player, client = cable.player, hookean_client.connect(start=False)
    session = client.session(player.key)
    cable.bench.run(
        cable.engine, lambda: canvas_words.schedule(cable.engine, 100), lambda _: not session.read()["playing"]
    )
    assert player.frames is None
    client.close()
    before = cable.out.iterations
    cable.run(lambda out: out.iterations > before + 10)


def test_a_component_that_is_deleted_leaves_nothing_behind(home: Home) -> None:
    """Nothing of it stays drawn, and its session stands still."""
    cable = Cable()
    cable.settings = {"drag": 0.01}
    cable.run(lambda out: out.iterations)
    player, component = cable.player, cable.engine.Component
    document, component.document = component.document, None
    wait_for(lambda: player.ended and player.key not in canvas_draw._displays)
    client = hookean_client.connect(start=False)
    wait_for(lambda: not client.session(player.key).read()["playing"])
    client.close()
    component.document = document  # taken back with undo
    before = cable.out.iterations
    cable.run(lambda out: out.iterations != before)


PLACES = st.tuples(*[st.integers(-3, 3)] * 3).map(lambda p: [float(c) for c in p])


class Setup:
    """What a player asks of the inputs, with nothing behind."""

    reset = False

    def __init__(self, points: list[list[float]]) -> None:
        self.anchors = [
            {"name": f"s {{0}} {i}", "group": "s {0}", "point": p, "target": None, "axes": "xyz"}
            for i, p in enumerate(points)
        ]

    def scene(self, anchors: Any) -> Any:
        return {"forces": [], "meshes": {}}


@given(st.lists(st.lists(PLACES, min_size=1, max_size=6, unique_by=tuple), min_size=2, max_size=6))
def test_anchors_are_one_to_one_with_homes(history: list[list[list[float]]]) -> None:
    """However points move, come, go or change places: the same count keeps its homes, and one that stays where it is
    among others keeps its own."""
    player = Player("key")
    before: dict[tuple[float, ...], list[float]] = {}
    count = -1
    for points in history:
        held = player._held(Setup(points))
        homes = [tuple(one["home"]) for one in held]
        now = dict(zip(map(tuple, points), (one["home"] for one in held), strict=True))
        assert [one["target"] for one in held] == points
        mixed = sorted(points) == sorted(map(list, before))
        if len(points) == count and not mixed:
            assert homes == [tuple(home) for home in before.values()]
        else:
            assert all(now[place] == before[place] for place in now if place in before)
        before, count = now, len(points)


def test_paths_of_files_differ(tmp_path: Path) -> None:
    bench = Bench(str(tmp_path / "a.gh"))
    cable = Cable(bench)
    first = cable.player.key
    assert all(c.isalnum() or c in ":-" for c in first) and len(first) < 160
    bench.document.FilePath = str(tmp_path / "b.gh")
    assert cable.player.key != first
    reopen()
