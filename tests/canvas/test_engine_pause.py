"""`_on_` of the Engine: False holds it where it is, True lets it go on from there."""

from __future__ import annotations

from canvas.test_engine import Cable, close, home, rhino, served, xyz  # noqa: F401
from hookean_client import canvas, canvas_engine
from serving import Home


class Switched(Cable):
    """A cable whose engine has a switch."""

    on = True

    def solve(self, reset: bool) -> object:
        text = canvas.settings(self.springs, **self.settings)
        self.out = canvas_engine.solve(self.engine, self.forces(), self.anchors, [text], self.geometry, reset, self.on)
        return self.out


def test_a_file_saved_paused_stays_at_its_start_until_it_is_switched_on(home: Home) -> None:  # noqa: F811
    cable = Switched()
    cable.on = False
    cable.run()
    assert cable.out.iterations == 0 and [xyz(p) for p in cable.out.particles] == [(i, 0, 0) for i in range(11)]
    assert cable.engine.Component.Message == "paused at iteration 0" and not cable.bench.document.scheduled
    cable.on = True
    cable.run()
    assert close(cable.at(5), (5, 0, -1.733760513267))


def test_a_pause_holds_the_form_where_it_is_and_edits_wait(home: Home) -> None:  # noqa: F811
    cable = Switched()
    cable.settings = {"drag": 0.5}
    cable.run(lambda out: out.iterations)
    cable.on = False
    cable.run()
    paused, form = cable.out.iterations, [xyz(p) for p in cable.out.particles]
    assert paused and cable.engine.Component.Message == f"paused at iteration {paused}"
    cable.load = -20.0
    cable.run()
    assert (cable.out.iterations, [xyz(p) for p in cable.out.particles]) == (paused, form)
    cable.on, cable.settings = True, {"drag": 5.0, "fast": True}
    cable.run()
    assert cable.at(5)[2] < -1.733760513267 - 0.1


def test_a_reset_while_paused_goes_back_to_the_start(home: Home) -> None:  # noqa: F811
    cable = Switched()
    cable.settings = {"drag": 0.5}
    cable.run(lambda out: out.iterations)
    cable.on = False
    cable.run()
    cable.hold()
    assert cable.out.iterations == 0 and cable.engine.Component.Message == "held at the start"
    cable.run()
    assert cable.out.iterations == 0 and cable.engine.Component.Message == "paused at iteration 0"


def test_a_cable_at_rest_stays_at_rest_when_it_is_switched_off(home: Home) -> None:  # noqa: F811
    cable = Switched()
    cable.run()
    ended = cable.out.iterations
    cable.on = False
    cable.run()
    assert cable.out.iterations == ended and cable.engine.Component.Message == f"at rest after {ended}"
