"""Particles are dragged in Rhino's viewport: a mouse of stand-ins, an engine on a real service."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from canvas.canvasing import point, sentences
from canvas.test_engine import Cable, close, home, rhino, served  # noqa: F401  fixtures
from canvas.test_tools import Placed
from hookean_client import canvas_grab


class Callback:
    """Rhino's: it tells of the mouse while it is enabled."""

    made: list[Any] = []  # noqa: RUF012

    def __init__(self) -> None:
        self.Enabled = False
        self.made.append(self)


@pytest.fixture(autouse=True)
def mouse(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    module = ModuleType("Rhino.UI")
    module.MouseCallback = Callback  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "Rhino.UI", module)
    monkeypatch.setattr(Callback, "made", [])
    yield


def event(at: tuple[float, float], button: str = "Left", flipped: bool = False) -> Any:
    """The mouse over x and z, seen along y from afar."""
    ends = [point(at[0], -100.0, at[1]), point(at[0], 100.0, at[1])]
    line = SimpleNamespace(From=ends[flipped], To=ends[not flipped])
    port = SimpleNamespace(ClientToWorld=lambda _: line, CameraDirection=point(0.0, 1.0, 0.0))
    view = SimpleNamespace(ActiveViewport=port)
    return SimpleNamespace(View=view, ViewportPoint=None, MouseButton=button, Cancel=False)


class Dragged(Cable):
    """The cable with a Grab beside its forces."""

    def __init__(self, **inputs: Any) -> None:
        super().__init__()
        self.grab = Placed("Grab").once(**inputs)["grab"]

    def forces(self) -> list[str]:
        return [*super().forces(), self.grab]

    @property
    def mouse(self) -> Any:
        return Callback.made[-1]


def test_a_particle_follows_the_mouse_and_is_free_again(home: Any) -> None:  # noqa: F811
    """Held in the middle at (5, 0, -4), across the line of sight; let go, it rests where it did. A press far from
    all particles, with another button or on an anchor holds nothing."""
    cable = Dragged(_range_=[1.0])
    cable.hold()
    assert cable.mouse.Enabled
    before = [(cable.run(), cable.at(i))[1] for i in range(11)]
    for down in (event((5.0, 50.0)), event(before[5][::2], "Right"), event((0.0, 0.0))):
        cable.mouse.OnMouseDown(down)
        assert not down.Cancel
    down, move, up = event(before[5][::2]), event((5.0, -4.0), flipped=True), event((5.0, -4.0))
    cable.mouse.OnMouseDown(down)
    cable.mouse.OnMouseMove(move)
    assert down.Cancel and move.Cancel
    cable.run(lambda _: not canvas_busy(cable) and cable.player.rests and close(cable.at(5), (5.0, 0.0, -4.0), 1e-5))
    cable.mouse.OnMouseUp(up)
    assert up.Cancel
    cable.run()
    assert all(close(cable.at(i), before[i], 1e-4) for i in range(11))


def canvas_busy(cable: Dragged) -> bool:
    """Whether something is still to be sent to the session."""
    return bool(cable.player.hand._news.is_set())


def test_a_spring_pulls_it_by_its_strength(home: Any) -> None:  # noqa: F811
    """At rest the spring of 20 N/m to (5, 0, -9) carries S (mouse - x) upwards or down: the reactions of both ends and
    this force add up to the loads, 9 x 10 N on free particles."""
    cable = Dragged(_strength_=[20.0])
    cable.hold()
    cable.run()
    at = cable.at(5)
    cable.mouse.OnMouseDown(event(at[::2]))
    cable.mouse.OnMouseMove(event((5.0, -9.0)))
    settled = lambda _: not canvas_busy(cable) and cable.player.rests and cable.player.exact  # noqa: E731
    cable.run(settled)
    pull = 20.0 * (-9.0 - cable.at(5)[2])
    assert abs(pull) > 1.0
    carried = sum(force[2] for force in cable.player.state["reactions"]["force"])
    inner = 9 * 10.0  # the loads at both ends go into their anchors
    assert abs(carried - 20.0 - (inner - pull)) < 1e-3 * inner
    cable.mouse.OnMouseUp(event((5.0, -9.0)))
    cable.run()
    assert close(cable.at(5), at, 1e-4)


def test_it_drags_nothing_while_held_at_the_start_or_switched_off(home: Any) -> None:  # noqa: F811
    cable = Dragged()
    cable.hold()
    down = event((5.0, 0.0))
    cable.mouse.OnMouseDown(down)
    assert not down.Cancel
    cable.grab = Placed("Grab").once(_on_=[False])["grab"]
    assert cable.grab is None
    cable.forces = lambda: Cable.forces(cable)  # type: ignore[method-assign]
    cable.run()
    assert not cable.mouse.Enabled


def test_numbers_that_do_not_fit_are_refused() -> None:
    placed = Placed("Grab")
    assert placed.once(_range_=[-1.0])["grab"] is None
    assert sentences(placed.ghenv) == ["Range: -1.0 given; a number from 0 to 1e12 is expected."]
    assert json.loads(placed.once()["grab"])["kind"] == canvas_grab.KIND
