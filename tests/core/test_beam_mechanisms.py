"""Mechanisms and states of self-stress of frames of beams, against textbooks and against the tangents of the beams."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hookean
from hookean import InputError, Scene
from hookean.analysis.matrices import Unknowns
from hookean.system.system import compile

from .beam_scenes import SLENDER
from .beam_scenes import row as beams

Spec = dict[str, Any]
CORNERS = [[0, 0, 0], [0, 0, 3], [4, 0, 3], [4, 0, 0]]
LINE = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]


def frame(x: Any, pairs: Any, *anchors: Spec, more: Any = (), **given: Any) -> Scene:
    """Beams between pairs of particles, and what stands beside them."""
    beam = {"kind": "beam", "particles": pairs, **SLENDER, **given}
    return Scene.read({"particles": x, "forces": [beam, *more], "anchors": list(anchors)})


def clamp(*particles: int) -> Spec:
    return {"particles": list(particles), "rotations": "xyz"}


@pytest.mark.parametrize(
    ("scene", "counts"),
    [
        (frame(LINE[:2], [[0, 1]]), (0, 6, 0)),  # afloat
        (frame(LINE, [[0, 1], [1, 2]], clamp(0)), (0, 0, 0)),  # a cantilever
        (frame(LINE, [[0, 1], [1, 2]], clamp(0, 2)), (0, 0, 6)),
        (frame(CORNERS, [[0, 1], [1, 2], [2, 3]], clamp(0, 3)), (0, 0, 6)),  # a portal on clamps
        (frame(CORNERS, [[0, 1], [1, 2], [2, 3]], {"particles": [0, 3]}), (0, 1, 1)),  # on balls: the thrust
        (frame(CORNERS, [[0, 1], [1, 2], [2, 3], [3, 0]]), (0, 6, 6)),  # a ring afloat: one cut, six forces
        # hinges about y at both clamps and one between them: it buckles through, and is stressed along itself
        (frame(LINE, [[0, 1], [1, 2]], clamp(0, 2), release_start="y", release_end="y"), (1, 0, 4)),
        # a bar props a cantilever
        (frame(LINE, [[0, 1]], clamp(0), {"particles": [2]}, more=[{"kind": "springs", "particles": [[1, 2]]}]),
         (0, 0, 1)),
    ],
)  # fmt: skip
def test_counts_of_frames(scene: Scene, counts: tuple[int, int, int]) -> None:
    """Mechanisms, motions as a whole, states of self-stress, and Maxwell's rule between them. Of two beams hinged about
    y at each end the middle moves along z, a mechanism, and turns about y, which moves nothing; along x and about x
    both are clamped, and so they are in the other plane."""
    found = hookean.mechanisms(scene)
    assert found.free_turns == ("y" in scene.forces[0].release_start)
    assert (found.mechanisms, found.rigid_motions, found.self_stress_states) == counts
    assert found.turns.shape[0] == counts[0] and found.beam_stresses.shape[0] == counts[2]


def tangled(seed: int) -> Scene:
    """A random frame of beams with and without hinges and eccentric ends, and bars, on a random support."""
    rng = np.random.default_rng([77, seed])
    n = int(rng.integers(4, 8))
    x = rng.normal(size=(n, 3))
    pairs = [[i, int(rng.integers(0, i))] for i in range(1, n)] + [[0, n - 1]] * (rng.random() < 0.5)
    half = max(1, len(pairs) // 2)
    first = {**beams(0, normal=rng.normal(size=3)), "particles": pairs[:half]}
    first["offset_end"] = 0.1 * rng.normal(size=3)
    second = {**beams(0, normal=rng.normal(size=3)), "particles": pairs[half:]}
    hinges = ["", "y", "z", "yz", "xyz"]
    second["release_start"] = rng.choice(hinges, len(second["particles"])).tolist()  # each its own
    second["release_end"] = str(rng.choice(["", "y"]))
    bars = {"kind": "springs", "particles": [[0, n - 2], [1, n - 1]]}
    held = [{"particles": [0], "rotations": str(rng.choice(["", "x", "xyz"]))}, {"particles": [n - 1], "axes": "z"}]
    return Scene.read({"particles": x, "forces": [first, second, bars], "anchors": held})


def each(axes: Any, force: Any) -> list[str]:
    """The released axes of each beam of a force."""
    return [axes] * len(force.particles) if isinstance(axes, str) else list(axes)


@pytest.mark.parametrize(("hinged", "turns"), [("y", 3), ("yz", 9), ("xyz", 12)])
def test_turns_of_hinged_joints_are_no_mechanisms(hinged: str, turns: int) -> None:
    """A tripod on balls is a truss, three bars for three axes of its top: neither loose nor stressed. Of the twelve
    rotations of four joints three beams with torsion alone hold one each; with bending about one axis at both ends
    three each, but of legs on balls each still turns about itself. At clamped feet nothing does."""
    x, ends = [[-1, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0]], {"release_start": hinged, "release_end": hinged}
    legs = [[0, 1], [2, 1], [3, 1]]
    found = hookean.mechanisms(frame(x, legs, {"particles": [0, 2, 3]}, **ends))
    assert (found.mechanisms, found.rigid_motions, found.self_stress_states) == (0, 0, 0)
    assert found.free_turns == turns and found.modes.shape[0] == 0
    assert f"free turns of hinged joints: {turns}" in found.summary()[1]
    assert hookean.mechanisms(frame(x, legs, clamp(0, 2, 3), **ends)).free_turns == (3 if hinged == "xyz" else 0)


def test_an_eccentric_end_that_swings_is_a_mechanism() -> None:
    """A joint that turns swings the end of a beam beside it: this moves. With both ends hinged there are six rotations
    less that of the chord's length, of which three turn the joint without a beam beside it."""
    hinged = {"release_start": "xyz", "release_end": "xyz", "offset_end": [0.0, 0.0, 0.3]}
    found = hookean.mechanisms(frame(LINE[:2], [[0, 1]], {"particles": [0, 1]}, **hinged))
    assert found.free_turns == 3 and found.mechanisms + found.rigid_motions == 2


def test_each_beam_has_hinges_of_its_own() -> None:
    """Beams of one force with hinges of their own are those of a force each, to the bit, in their shape and in the
    counts; they come back from JSON as they were."""
    push = {"kind": "unary", "particles": [1], "vector": [0.1, 0.2, -0.3]}
    start, end = ["y", ""], ["", "yz"]
    one = frame(LINE, [[0, 1], [1, 2]], clamp(0, 2), more=[push], release_start=start, release_end=end)
    last = {"kind": "beam", "particles": [[1, 2]], **SLENDER, "release_start": start[1], "release_end": end[1]}
    two = frame(LINE, [[0, 1]], clamp(0, 2), more=[last, push], release_start=start[0], release_end=end[0])
    np.testing.assert_array_equal(hookean.relax(one).particles, hookean.relax(two).particles)
    assert hookean.mechanisms(one).summary()[1:] == hookean.mechanisms(two).summary()[1:]
    assert Scene.read(one.model_dump(mode="json")) == one
    with pytest.raises(InputError, match=r"release_start: 1 values for 2 elements; give one value or one for each"):
        hookean.relax(frame(LINE, [[0, 1], [1, 2]], clamp(0), release_start=["y"]))
    with pytest.raises(InputError, match=r"release_start/1: 'q' given; '', 'x', 'y', .* or 'xyz' allowed"):
        frame(LINE, [[0, 1], [1, 2]], clamp(0), release_start=["y", "q"])


PUSH = {"kind": "unary", "name": "push", "particles": [1], "vector": [0, 0, -1e-3]}
TRIPOD, LEGS = [[-1, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0]], [[0, 1], [2, 1], [3, 1]]


@pytest.mark.parametrize(("hinged", "turns"), [("yz", 9), ("xyz", 12)])
def test_a_truss_of_hinged_beams_is_stable(hinged: str, turns: int) -> None:
    """A tripod of beams that are hinged all round is the truss, N = -P / 2 * 2^0.5 in the legs against each other, and
    stable: its free turns move nothing. So it is with the turns held; and where a beam ends beside its joint, which
    swings it, the message names the joint."""
    ends = {"release_start": hinged, "release_end": hinged}
    foot, turning = {"particles": [0, 2, 3]}, {"particles": range(4), "axes": "", "rotations": "xyz"}
    loose = hookean.relax(frame(TRIPOD, LEGS, foot, more=[PUSH], **ends))
    assert loose.stability == "stable" and loose.soft_modes == turns and "mechanism" not in loose.message
    assert f"{turns} turns of hinged joints" in loose.stability_reason
    assert loose.position_error is not None and loose.position_error < 1e-6
    held = hookean.relax(frame(TRIPOD, LEGS, foot, turning, more=[PUSH], **ends))
    assert held.stability == "stable" and held.soft_modes is None
    for found in (loose, held):
        np.testing.assert_allclose(found.force("beam")["force"][:2], -1e-3 * np.sqrt(0.5), rtol=1e-4)
    beside = hookean.relax(frame(TRIPOD, LEGS, foot, **ends, offset_start=[0.0, 0.1, 0.0]))
    assert beside.stability == "mechanism"
    assert "turns most: hold it by the rotations of an anchor" in beside.message


@pytest.mark.soak
@pytest.mark.parametrize("hinged", ["yz", "xyz"])
def test_hinged_beams_buckle_snap_and_vibrate_as_bars(hinged: str) -> None:
    """Free turns of joints do not keep a truss from its factors: those of springs with its EA, whose unknowns are
    fewer, to the rounding of a tangent. They have no frequency; joints that turn against torsion of struts have one."""
    beams = {"kind": "beam", **SLENDER, "release_start": hinged, "release_end": hinged}
    kinds = [beams, {"kind": "springs", "axial_stiffness": SLENDER["E"] * SLENDER["A"]}]

    def made(x: Any, pairs: Any, load: Any, *held: Spec) -> list[Scene]:
        spec = {"particles": x, "anchors": held, "settings": {"tolerance": 1e-11}}
        return [Scene.read({**spec, "forces": [{**kind, "particles": pairs}, load]}) for kind in kinds]

    tripods = made(TRIPOD, LEGS, PUSH, {"particles": [0, 2, 3]})
    one, two = (hookean.buckling(scene, count=1).factors for scene in tripods)
    np.testing.assert_allclose(one, two, rtol=1e-9)
    if hinged == "xyz":
        one, two = (hookean.frequencies(scene, count=3).frequencies for scene in tripods)
        np.testing.assert_allclose(one, two, rtol=1e-9)
    push, held = {**PUSH, "vector": [0, 0, -100]}, [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}]
    shallow = made([[-1, 0, 0], [0, 0, 0.3], [1, 0, 0]], [[0, 1], [1, 2]], push, *held)
    paths = [hookean.load_path(scene, steps=60, increment=0.2) for scene in shallow]
    one, two = ([point.factor for point in path.critical_points] for path in paths)
    assert len(one) == 2
    np.testing.assert_allclose(one, two, rtol=1e-9)


@pytest.mark.parametrize("seed", range(12))
def test_what_strains_nothing_meets_no_stiffness(seed: int) -> None:
    """At the start nothing is stressed, so the tangent K = C D C^T of the equilibrium matrix C and positive
    stiffnesses D: as many motions meet none as the rank says, the modes are such motions, and there are as many
    states of self-stress as forces more than the rank. Eigenvalues of K are at least 1e-6 of the largest, or
    rounding."""
    scene = tangled(seed)
    found = hookean.mechanisms(scene)
    system = compile(scene)
    state = system.start()
    unknowns = Unknowns.of(system, state, state.free)
    tangent = unknowns.tangent(system, state).toarray()
    values = np.linalg.eigvalsh(tangent)
    none = int((np.abs(values) < 1e-9 * values.max()).sum())
    assert len(tangent) == found.free_axes
    assert found.mechanisms + found.rigid_motions + found.free_turns == none
    ends = [
        pair for f in scene.forces[:2] for pair in zip(each(f.release_start, f), each(f.release_end, f), strict=True)
    ]
    released = sum(("x" in a + b) + sum(len(set(end) & {"y", "z"}) for end in (a, b)) for a, b in ends)
    assert found.self_stress_states == found.bars + 6 * found.beams - released - found.rank
    for mode, turn in zip(found.modes, found.turns, strict=True):
        moved = np.concatenate([mode, turn * system.slots.lengths[:, None], np.zeros_like(turn)])
        assert np.abs(tangent @ unknowns.gather(moved)).max() < 1e-9 * values.max()


def test_self_stresses_are_forces_of_bars_and_beams() -> None:
    """A cantilever propped along itself: the bar pulls as the beam does, and nothing else is stressed."""
    prop = {"kind": "springs", "particles": [[1, 2]]}
    found = hookean.mechanisms(frame(LINE, [[0, 1]], clamp(0), {"particles": [2]}, more=[prop]))
    stress = found.self_stresses[0, 0]
    np.testing.assert_allclose(found.beam_stresses[0, 0], [stress, 0, 0, 0, 0, 0], atol=1e-12)
    assert "1 beams" in found.summary()[0] and found.to_dict()["beams"] == 1


def test_a_result_counts_in_its_shape() -> None:
    """A frame that has turned and bent far is as determinate as before."""
    push = {"kind": "unary", "particles": [2], "vector": [0.3, 0.5, -0.8]}
    bent = hookean.relax(frame(LINE, [[0, 1], [1, 2]], clamp(0), more=[push]))
    found = hookean.mechanisms(bent)
    assert (found.mechanisms, found.rigid_motions, found.self_stress_states) == (0, 0, 0)
    np.testing.assert_array_equal(found.particles, bent.particles)


def test_nothing_to_count_is_one_sentence() -> None:
    with pytest.raises(InputError, match="no bars and no beams; add springs"):
        hookean.mechanisms(Scene.read({"particles": [[0, 0, 0]]}))


def test_what_holds_a_structure_beside_bars_and_beams_is_named() -> None:
    """A beam afloat has six rigid motions, and springs to the ground do not count; loads are not named."""
    ground = {
        "kind": "support",
        "name": "soil",
        "particles": [0],
        "stiffness": [1, 1, 1],
        "rotation_stiffness": [1, 1, 1],
    }
    push = {"kind": "unary", "particles": [1], "vector": [0, 0, -1]}
    found = hookean.mechanisms(frame(LINE[:2], [[0, 1]], more=[ground, push]))
    assert (found.rigid_motions, found.left_out) == (6, ("soil",))
    assert found.summary()[-1] == "counted without soil" and found.to_dict()["left_out"] == ["soil"]
    alone = hookean.mechanisms(frame(LINE[:2], [[0, 1]], more=[push]))
    assert alone.left_out == () and len(alone.summary()) == 4
