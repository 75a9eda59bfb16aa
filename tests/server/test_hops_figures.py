"""The chapter's figures as functions of Hops: the numbers their folders are held to, in answers that Grasshopper's
component can use. Those that take long in full in `make soak`."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hookean.commands.examples import figure, find
from hookean_server.hops.functions import FUNCTIONS
from serving import SOAK

from .hops_canvas import Component, Solved
from .hops_inside import Service

SERVICE = Service()
LINE = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0)]
EIGHT = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (3, 3, 0), (7, 3, 0), (7, 7, 0), (3, 7, 0)]

Read = Callable[[Solved], float]


def of(name: str) -> Read:
    """A number as it comes out."""
    return lambda found: float(found.one(name))


def each(name: str, pick: Callable[[Any], float]) -> Read:
    """A number of all that comes out."""
    return lambda found: float(pick(np.array(found.all(name))))


def lengths(pick: Callable[[Any], float]) -> Read:
    return lambda found: float(pick(np.linalg.norm(np.diff(np.array(found.all("Springs")), axis=1)[:, 0], axis=1)))


def lift(pick: Callable[[Any], float]) -> Read:
    return lambda found: float(pick(np.array(found.all("Reactions"))[:, 2]))


def inside(found: Solved) -> float:
    """The part of the load on supports that are not at corners."""
    upward, place = (np.array(found.all(name)) for name in ("Reactions", "Supports"))
    return float(upward[np.hypot(*(place[:, :2] - 5.0).T) < 5.0, 2].sum() / upward[:, 2].sum())


def corner(i: int) -> Read:
    return lambda found: float(np.linalg.norm(found.all("Reactions")[i]))


def drawn(folder: str, *inputs: str, **more: Any) -> dict[str, Any]:
    """What a figure's model holds, as inputs of a function."""
    return dict(zip(inputs, figure(folder).drawn(), strict=True)) | more


ribbon = functools.partial(drawn, "9.32-ribbon", "Surface", "Beams", "Arcs", "End arcs")
bridge = functools.partial(drawn, "basento", "Skin", "Feet", "Fingers")
frames = functools.partial(drawn, "9.22-freeform-frames", "Near frame", "Far frame")


A, B = (0.0, 0.0, 0.0), (8.0, 0.0, 4.0)
LEVEL = {"A": A, "B": (10.0, 0.0, 0.0)}
STRETCHED = {"Arc length": 10.0, "Stiffness": 75.0, "Rest factor": 1.0}
CREASED = {"Divisions": 20, "Diagonal stiffness": 2000.0, "Load": 1.0}
SAGS = {"length": of("Length"), "sag": of("Sag"), "off the catenary": of("Off the catenary")}

# function, inputs (the rest has its default), folder of the figure, its numbers and where they come out
CASES: list[tuple[str, Any, str, dict[str, Read]]] = [
    ("cable", {}, "9.4", {
        "springs": lambda f: len(f.all("Forces")), "length": of("Length"), "sag": of("Sag"),
        "length of the first spring": lengths(lambda x: x[0]), "length of a middle spring": lengths(lambda x: x[4]),
        "force in the first spring": each("Forces", lambda x: x[0]), "lift of an anchor": lift(lambda x: x[0])}),
    ("cable", {"Anchors": [A, (7.0, 0.0, 2.0)], "Length factor": 10.0 / 53.0**0.5}, "9.7", {
        "length while moved": of("Length"), "largest force while moved": of("Largest force"),
        "lowest point while moved": lambda f: -f.one("Sag")}),
    ("cable", {"Anchors": [A, (4.0, 0.0, 0.0), LINE[1]]}, "9.9", {
        "sag of the right part": of("Sag"), "lift of all anchors": lift(np.sum),
        "lift of the third anchor": lift(lambda x: sorted(x)[-1])}),
    ("cable", {"Anchors": [A, (4.5, 0.0, 0.0), LINE[1]]}, "9.9", {"sag with an anchor between particles": of("Sag")}),
    ("cable", {"Pieces": 5, "Load": 20.0}, "9.11", {
        "extension of spring 1": lengths(lambda x: x[0] - 2.0), "extension of spring 2": lengths(lambda x: x[1] - 2.0),
        "extension of spring 3": lengths(lambda x: x[2] - 2.0), "length": of("Length")}),
    ("bouncing_cable", {}, "9.6", {"length at 0.9 s": of("Length"), "sag at 0.9 s": of("Sag")}),
    ("bouncing_cable", {"Time": 0.3}, "9.6", {"length at 0.3 s": of("Length")}),
    ("smooth_curve", {}, "9.10", {
        "length of the cable": of("Length"), "length of the curve": of("Length of the curve")}),
    ("hooke", {}, "9.12", {"length under the load": of("Length"), "extension": of("Extension")}),
    ("hooke", {"Stiffness": 4.0}, "9.12", {"extension at 4 N/cm": of("Extension")}),
    ("hooke", {"Weight": 0.0}, "9.12", {
        "length without the load": of("Length"), "extension under 0 N": of("Extension")}),
    ("catenary", LEVEL, "9.14", {
        "span 10, length 12: a": of("Parameter"), "span 10, length 12: sag": of("Depth"),
        "span 10, length 12: largest tension": of("Largest tension")}),
    ("catenary", {"A": A, "B": B}, "9.16", {
        "rising: a": of("Parameter"), "rising: depth below A": of("Depth"),
        "rising: largest tension": of("Largest tension")}),
    ("catenary", {"A": A, "B": (0.0, 0.0, -8.0), "Gravity": [(1.0, 0.0, 0.0)]}, "9.16", {
        "gravity sideways: a": of("Parameter"), "gravity sideways: depth below A": of("Depth"),
        "gravity sideways: largest tension": of("Largest tension")}),
    ("arc_to_catenary", {}, "9.17", {
        **{f"arc: {name}": read for name, read in SAGS.items()},
        "arc: shortest segment": lengths(np.min), "arc: longest segment": lengths(np.max),
        "arc: largest change of a segment": lengths(lambda x: np.abs(x - 0.4).max())}),
    ("arc_to_catenary", STRETCHED, "9.17", {f"line: {name}": read for name, read in SAGS.items()}),
    ("arc_to_catenary", {"Span": 14.0}, "9.17", {f"wide arc: {name}": read for name, read in SAGS.items()}),
    ("arc_to_catenary", {"Span": 14.0, "By arc length": True}, "9.17",
     {f"wide arc, rest by arc length: {name}": read for name, read in SAGS.items()}),
    ("arc_frames", {}, "9.21", {"height of the middle after 4 s": of("Height of the middle")}),
    ("arc_frames", {"Time": 20.0}, "9.21", {"height of the middle after 20 s": of("Height of the middle")}),
    ("chains_between_frames", frames, "9.22", {
        "chains": lambda f: len(f.all("Chains")), "total length": of("Length"), "largest force": of("Largest force"),
        "shortest chain": each("Lengths", np.min), "longest chain": each("Lengths", np.max),
        "largest sag": of("Largest sag"), "chains off the catenaries": of("Off the catenaries")}),
    ("membrane", {"Size": 8.0, "Divisions": 8, "Stiffness": 1000.0, "Load": 5.0}, "9.1", {
        "sag in the middle": of("Sag"), "largest force in a spring": of("Largest force"),
        "least force in a spring": of("Least force"), "vertical reaction of a corner": lift(lambda x: x[0])}),
    ("membrane", {}, "9.24", {
        "vertices of the mesh": lambda f: len(f.one("Mesh").Vertices),
        "edges of the mesh": lambda f: len(f.all("Springs")),
        "sag in the middle": of("Sag"), "largest force": of("Largest force"), "least force": of("Least force"),
        "length of all springs": of("Length"), "upward reactions together": lift(np.sum)}),
    ("membrane", {"Rest factor": 0.8, "Rise": 4.0, "Drop": 1.0}, "9.26", {
        "height of the middle": lambda f: -f.one("Sag"), "largest force": of("Largest force"),
        "smallest force": of("Least force"), "carried by all corners": lift(np.sum)}),
    ("membrane", {"Held": "rim"}, "9.27", {
        "rim: particles held": lambda f: len(f.all("Reactions")), "rim: sag in the middle": of("Sag"),
        "rim: largest force": of("Largest force"), "rim: upward reactions together": lift(np.sum)}),
    ("membrane", {"Anchors": EIGHT}, "9.27", {
        "points: particles held": lambda f: len(f.all("Reactions")), "points: sag in the middle": of("Sag"),
        "points: deepest sag": of("Deepest"), "points: largest force": of("Largest force"),
        "points: part of the load on the four inside": inside}),
    ("hypar_net", {}, "9.28", {"net: height over (0.5, 0.5)": of("Height")}),
    ("membrane_with_diagonals", {}, "9.29", {
        "both: sag": of("Sag"), "both: largest force in an edge": of("Largest edge force"),
        "both: largest force in a diagonal": of("Largest diagonal force"),
        "both: upward reactions together": lift(np.sum)}),
    ("membrane_with_diagonals", {"Diagonals": "none"}, "9.29", {
        "none: sag": of("Sag"), "none: largest force in an edge": of("Largest edge force")}),
    ("membrane_with_diagonals", CREASED, "9.30", {
        "diagonals 1: deepest sag": of("Deepest"), "diagonals 1: energy of the springs": of("Energy")}),
    ("membrane_with_diagonals", {**CREASED, "Diagonal factor": 0.9}, "9.30", {
        "diagonals 0.9: upward reactions together": lift(np.sum)}),
    ("membrane_with_diagonals", {"Diagonals": "one"}, "9.31", {
        "A: deepest sag": of("Deepest"), "A: reaction at (0, 0)": corner(0),
        "A: largest force in a diagonal": of("Largest diagonal force")}),
    ("membrane_with_diagonals", {"Diagonals": "other"}, "9.31", {"B: reaction at (0, 0)": corner(0)}),
    ("membrane_of_warp_and_weft", {}, "9.31", {
        "C: sag in the middle": of("Sag"), "C: largest force in the warp": each("Warp forces", np.max),
        "C: largest force in the weft": each("Weft forces", np.max)}),
    ("hanging_chain", {}, "hanging-vault", {
        "chain: sag": of("Height"), "chain: horizontal pull": of("Pull"),
        "chain: greatest tension": of("Largest force")}),
    ("hanging_chain", {"Upside down": True}, "hanging-vault", {
        "arch: rise": of("Height"), "arch: thrust": of("Pull"),
        "arch: greatest force, tension +": of("Largest force")}),
    ("vault", {}, "hanging-vault", {
        "net: sag": of("Height"), "net: least tension": of("Least force"), "net: greatest tension": of("Largest force"),
        "net: weight": of("Total weight")}),
    ("vault", {"Upside down": True}, "hanging-vault", {
        "vault: crown": of("Height"), "vault: greatest force, tension +": of("Largest force"),
        "vault: weight": of("Total weight"), "vault: thrust at a corner": of("Thrust at a corner")}),
    ("bridge_skin", bridge, "basento", {
        "least tension": of("Least force"), "greatest tension": of("Largest force"), "area of the skin": of("Area"),
        "deck carried": of("Deck")}),
    ("bridge_skin", functools.partial(bridge, **{"Upside down": True}), "basento", {
        "least compression": lambda f: -f.one("Largest force"), "greatest compression": lambda f: -f.one("Least force"),
        "feet push up": of("Deck")}),
    ("sail", {}, "wind", {
        "height of the middle at a steady 12 m/s": of("Height of the middle"),
        "largest force in an edge at a steady 12 m/s": of("Largest edge force")}),
    ("sail", {"Speed": 17.5}, "wind", {"largest load on a particle": of("Load")}),
    ("falling_sphere", {"Shell": 0.0, "Time": 1.0}, "sphere", {
        "fallen after 1 s": of("Fallen"), "volume as drawn": of("Volume"), "springs": lambda f: len(f.all("Springs"))}),
    ("falling_sphere", {"Shell": 0.0}, "sphere", {
        "height kept, springs alone": of("Height kept"), "volume kept, springs alone": of("Volume kept")}),
]  # fmt: skip
LONG: list[tuple[str, Any, str, dict[str, Read]]] = [
    ("ribbon", ribbon, "9.32", {
        "area": of("Area"),
        "smallest force across": each("Across", np.min), "largest force across": each("Across", np.max),
        "smallest force along": each("Along", np.min), "largest force along": each("Along", np.max),
        "farthest from where it was drawn": of("Moved")}),
    ("falling_sphere", {}, "sphere", {
        "height kept, with Shell": of("Height kept"), "volume kept, with Shell": of("Volume kept")}),
]  # fmt: skip


@functools.cache
def component(name: str) -> Component:
    return Component(SERVICE.call, f"/{name}")


@pytest.mark.thinned
@pytest.mark.parametrize("case", [*CASES, *(LONG if SOAK else [])], ids=lambda c: f"{c[0]} {c[2]}")
def test_a_figure_has_the_numbers_of_its_folder(case: tuple[str, Any, str, dict[str, Read]]) -> None:
    name, given, folder, numbers = case
    found = component(name).solve(given() if callable(given) else given)
    assert found.errors == []
    expected = find(folder).expected.numbers
    off = {n: (read(found), str(expected[n])) for n, read in numbers.items() if not expected[n].holds(read(found))}
    assert not off


def test_an_anchor_that_meets_nothing_is_told() -> None:
    """Figure 9.9: between particles, it has no influence and is named."""
    (said,) = component("cable").solve({"Anchors": [A, (4.5, 0.0, 0.0), LINE[1]]}).warnings
    assert "(4.5, 0, 0)" in said


def test_a_net_and_a_film_of_any_size_tend_to_the_areas_of_figure_9_28() -> None:
    """Flat faces are off by a part of their size squared: of two sizes follows the limit."""
    expected = find("9.28").expected.numbers
    film = {"Film": True, "Tension": 1.0}
    sizes = (64, 32) if SOAK else (32, 16)
    for given, name, off in (({}, "net: area", 4e-6), (film, "film: area", 3e-6 if SOAK else 5e-5)):
        fine, coarse = (component("hypar_net").solve({**given, "Divisions": n}).one("Area") for n in sizes)
        value = expected[name].value
        assert value is not None and abs((4.0 * fine - coarse) / 3.0 - value) < off


def test_every_figure_of_the_gallery_is_a_function() -> None:
    """Each folder of a numbered figure has a case, each function of a figure too; as does the catenary."""
    from hookean.commands.examples import examples

    folders = {find(folder).folder for _, _, folder, _ in [*CASES, *LONG]} | {find("9.28").folder}
    originals = {example.folder for example in examples() if example.original}
    assert {folder for folder in originals if folder.name[0].isdigit()} <= folders <= originals
    figures = {name for name, function in FUNCTIONS.items() if function.group == "Figures"}
    assert figures | {"catenary"} == {name for name, *_ in [*CASES, *LONG]}


BOUNDED = [
    ("cable", {"Pieces": 5000}, "Pieces: 5000 given; 1 to 2000 allowed"),
    ("membrane", {"Divisions": 1000}, "Divisions: 1000 given; 1 to 150 allowed"),
    ("membrane", {"Held": "sides"}, "Held: unknown text; allowed: corners, rim"),
    ("falling_sphere", {"Time": 1e6}, "Time: 1e+06 given; 0 to 30 allowed"),
    ("cable", {"Anchors": [A]}, "Anchors: one anchor given; a cable needs two"),
    ("arc_to_catenary", {"Span": 30.0}, "Arc length: 20 given for a span of 30"),
    ("catenary", {"A": A, "B": (40.0, 0.0, 0.0)}, "and no shorter cable joins them"),
    ("catenary", {"A": A, "B": (12.0, 0.0, 0.0)}, "the cable is straight; give a longer one"),
]


@pytest.mark.parametrize(("name", "given", "sentence"), BOUNDED)
def test_what_would_last_or_cannot_be_is_refused(name: str, given: dict[str, Any], sentence: str) -> None:
    """By the server as well, for a component of an older version knows no bounds."""
    loose = Component(SERVICE.call, f"/{name}")
    loose.inputs = [unbounded(param) for param in loose.inputs]
    (said,) = loose.solve(given).errors
    assert sentence in said


def unbounded(param: Any) -> Any:
    from dataclasses import replace

    return replace(param, minimum=None, maximum=None)


def test_what_the_clock_ends_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """It would be kept for ever, and differ from machine to machine."""
    monkeypatch.setattr("hookean_server.hops.functions.LONGEST", 0.0)
    for name, given in (("membrane", {"Divisions": 60}), ("falling_sphere", {"Shell": 0.0})):
        answer = SERVICE.call("POST", "/solve", component(name).request(given))
        assert answer.status_code == 504
        assert component(name).read(answer).errors[0].startswith("Not finished within 0 s; give a coarser model")
