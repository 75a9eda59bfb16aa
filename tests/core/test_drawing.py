"""What is drawn into a running simulation: the model is the one that a scene with the same parts describes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import InputError, Scene, Simulation, relax

SQUARE = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]]


def sheet(**springs: Any) -> Simulation:
    """A face drawn on an empty page, whose edges are springs."""
    drawn = Simulation(Scene())
    net = {"kind": "springs", "name": "net", "mesh": "sheet", "stiffness": 50.0, "rest_factor": 0.5, **springs}
    drawn.draw({"add": {"points": SQUARE, "faces": {"sheet": [[0, 1, 2, 3]]}, "forces": [net]}})
    return drawn


def lines(**values: Any) -> Simulation:
    """Two springs in a row that are drawn one after the other, which makes them one force."""
    drawn = Simulation(Scene())
    drawn.draw({"add": {"points": [[0, 0, 0]]}})
    for x, pair in ((2.0, [0, 1]), (3.0, [1, 2])):
        force = {"kind": "springs", "name": "rope", "particles": [pair], **values}
        drawn.draw({"add": {"points": [[x, 0, 0]], "forces": [force]}})
    return drawn


def test_an_empty_page_is_drawn_on_and_rests_as_the_scene_does():
    """A face divided twice is a grid of 4 x 4 faces: held at its corners and loaded it has the shape of the same grid
    given as a scene."""
    drawn = sheet()
    for count in (1, 4):
        drawn.draw({"divide": {"faces": {"sheet": list(range(count))}}})
    assert drawn.system.slots.count == 25
    drawn.patch(
        {
            "pin": [{"particles": [0, 1, 2, 3]}],
            "add": [{"kind": "unary", "vector": [0, 0, -1], "particles": list(range(25))}],
        }
    )
    mesh = drawn.scene.meshes["sheet"]
    scene = {
        "meshes": {"m": {"vertices": mesh.vertices.tolist(), "faces": mesh.faces.tolist()}},
        "forces": [
            {"kind": "springs", "mesh": "m", "stiffness": 50, "rest_factor": 0.5},
            {"kind": "unary", "points": mesh.vertices.tolist(), "vector": [0, 0, -1]},
        ],
        "anchors": [{"points": SQUARE}],
    }
    truth = relax(Scene.read(scene)).particles
    assert np.abs(drawn.relax().particles - truth).max() < 1e-6 * 4  # both to the accuracy of positions of a run
    assert np.allclose(np.unique(mesh.vertices[:, 0]), [0, 1, 2, 3, 4])


def test_points_within_the_weld_distance_are_the_particles_that_are_there():
    """A second square whose points are 1 mm beside two corners of the first one, and one of its points given twice: 6
    particles in all, and its springs and faces are on them as those without rounding would be. A particle counts where
    it is now. Without the distance there are 9."""
    for weld, count in ((0.002, 6), (0.0, 9)):
        drawn = sheet()
        drawn.patch({"pin": [{"particles": [2], "targets": [[4.0, 4.0, 1.0]]}]})
        points = [[4.001, 0, 0], [8, 0, 0], [8, 4, 0], [4, 3.999, 1], [8, 0, 0.001]]
        tie = {"kind": "springs", "name": "tie", "particles": [[4, 7], [8, 0]]}
        drawn.draw({"add": {"points": points, "weld": weld, "faces": {"next": [[4, 5, 6, 7]]}, "forces": [tie]}})
        assert drawn.system.slots.count == count
        ends, corners = (drawn.scene.forces[1].particles, drawn.system.places.vertices("next"))
        assert ends.tolist() == ([[1, 2], [4, 0]] if weld else [[4, 7], [8, 0]])
        assert corners.tolist() == ([1, 2, 4, 5] if weld else [4, 5, 6, 7])
    with pytest.raises(InputError, match="particle 9 does not exist; there are 9"):
        sheet().draw({"add": {"points": points, "weld": 0.002, "faces": {"next": [[4, 5, 9]]}}})


def test_springs_that_are_drawn_alike_are_one_force_and_each_is_undone_alone():
    drawn = lines(stiffness=30.0)
    [rope] = drawn.scene.forces
    assert rope.particles.tolist() == [[0, 1], [1, 2]] and rope.stiffness == 30.0
    drawn.draw(
        {
            "add": {
                "forces": [
                    {"kind": "springs", "name": "rope", "particles": [[0, 2]], "stiffness": 5, "rest_length": [1]}
                ]
            }
        }
    )
    [rope] = drawn.scene.forces
    assert rope.stiffness.tolist() == [30, 30, 5] and rope.rest_length.tolist() == [2, 1, 1]
    for count in (3, 2, 1):
        drawn.undo()
        assert drawn.system.slots.count == count
    drawn.undo()
    assert drawn.system.slots.count == 0
    for count in (1, 2, 3):
        drawn.redo()
        assert drawn.system.slots.count == count


@pytest.mark.parametrize("values", [{"stiffness": 12.0}, {"stiffness": [12.0], "rest_length": [1.5]}])
def test_pieces_of_a_spring_behave_as_the_spring(values: dict[str, Any]):
    """n springs of n k and L0 / n in a row have stiffness k and rest length L0: the force at both ends stays."""
    drawn = Simulation(Scene())
    rope = {"kind": "springs", "particles": [[0, 1]], **values}
    drawn.draw({"add": {"points": [[0, 0, 0], [2, 0, 0]], "forces": [rope]}})
    drawn.patch({"pin": [{"particles": [0, 1], "targets": [[0, 0, 0], [2.6, 0, 0]]}]})
    whole = drawn.relax().reactions["force"]
    drawn.draw({"divide": {"springs": [0], "pieces": 5}})
    assert drawn.scene.forces[0].particles.tolist() == [[0, 2], [2, 3], [3, 4], [4, 5], [5, 1]]
    result = drawn.relax()
    # the residual of a run is 1e-6 of the forces
    assert np.allclose(result.reactions["force"], whole, atol=1e-5 * np.abs(whole).max())
    assert np.allclose(result.particles[2:, 0], np.arange(1, 5) * 2.6 / 5, atol=1e-5)


def test_a_face_beside_a_divided_one_gets_triangles_and_its_area_stays():
    """No edge has one face that is not on the rim: the surface has no gaps, and its area is that of the square."""
    drawn = sheet()
    drawn.draw({"divide": {"faces": {"sheet": [0]}}})
    drawn.draw({"divide": {"faces": {"sheet": [0]}}})
    mesh = drawn.scene.meshes["sheet"]
    assert len(mesh.faces) == 4 + 2 * 3 + 1  # four of one, three triangles of each neighbour, the fourth as it was
    corners = mesh.vertices[mesh.faces]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
    assert np.isclose(area.sum(), 16.0) and (area > 0).all()
    around = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2)
    pairs, counts = np.unique(np.sort(around[around[:, 0] != around[:, 1]], axis=1), axis=0, return_counts=True)
    rim = mesh.vertices[pairs[counts == 1]]
    assert ((rim == 0) | (rim == 4)).any(axis=2).all()


def test_extruded_edges_have_springs_like_theirs_and_faces_between():
    drawn = lines(stiffness=[7.0], rest_length=[1.0])
    drawn.draw({"extrude": {"edges": [[0, 1], [1, 2]], "by": [0, 0, 2], "mesh": "wall"}})
    [rope] = drawn.scene.forces
    assert sorted(rope.particles[2:].tolist()) == [[0, 3], [1, 4], [2, 5], [3, 4], [4, 5]]
    assert (rope.stiffness == 7).all()
    # rest lengths keep their ratio to the start length: 1 / 2 of the first edge, 1 of the second
    by_pair = {tuple(pair): rest for pair, rest in zip(rope.particles.tolist(), rope.rest_length, strict=True)}
    assert (by_pair[3, 4], by_pair[4, 5], by_pair[0, 3], by_pair[2, 5]) == (1.0, 1.0, 1.0, 2.0)
    assert drawn.system.places.faces("wall").tolist() == [[0, 1, 4, 3], [1, 2, 5, 4]]


def test_what_is_deleted_takes_with_it_all_that_needs_it():
    """Of a grid of 2 x 2 faces the middle particle goes with its faces and springs; what stays keeps its place, values
    and anchors under new numbers."""
    drawn = sheet()
    drawn.draw({"divide": {"faces": {"sheet": [0]}}})
    middle = int(np.flatnonzero((drawn.system.points == [2, 2, 0]).all(axis=1))[0])
    load = {"kind": "unary", "particles": list(range(9)), "vector": [[0, 0, -i] for i in range(9)]}
    drawn.patch({"pin": [{"particles": [1, middle, 8], "name": "feet"}], "add": [load]})
    stays = [i for i in range(9) if i != middle]
    start = drawn.system.points[stays]
    drawn.draw({"delete": {"particles": [middle]}})
    assert np.array_equal(drawn.system.points, start)
    assert "sheet" not in drawn.scene.meshes
    [force] = drawn.scene.forces
    assert force.vector[:, 2].tolist() == [-i for i in stays]
    assert np.array_equal(
        drawn.system.points[drawn.scene.anchors[0].particles], start[[1, stays.index(8)] if middle != 8 else [1]]
    )


def test_a_spring_of_a_mesh_is_deleted_alone():
    """The edges of the mesh become pairs; the other three keep their values."""
    drawn = sheet()
    drawn.draw({"delete": {"springs": [1]}})
    [net] = drawn.scene.forces
    assert net.mesh is None and len(net.particles) == 3 and net.stiffness == 50.0
    drawn.draw({"delete": {"faces": {"sheet": [0]}, "springs": [0, 1, 2]}})
    assert not drawn.scene.forces and not drawn.scene.meshes and drawn.system.slots.count == 4


def test_particles_go_on_from_where_they_are():
    """A net that hangs stays where it is while another part is drawn; new particles are halfway on what is there."""
    drawn = lines(stiffness=30.0)
    drawn.patch({"pin": [{"particles": [0, 2]}], "add": [{"kind": "unary", "particles": [1], "vector": [0, 0, -5]}]})
    now = drawn.relax().particles
    drawn.draw({"divide": {"springs": [0]}})
    assert np.array_equal(drawn.state.x[:3], now)
    assert np.allclose(drawn.state.x[3], (now[0] + now[1]) / 2)
    drawn.undo()
    assert np.array_equal(drawn.state.x[:3], now)


def test_a_particle_may_start_where_another_one_did():
    """They stay two, also after undo and redo: a new one is drawn where one that has moved away began."""
    drawn = lines()
    drawn.patch({"pin": [{"particles": [1], "targets": [[2, 0, -1]]}]})
    drawn.draw({"add": {"points": [[2, 0, 0]]}})
    assert drawn.state.x[[1, 3]].tolist() == [[2, 0, -1], [2, 0, 0]]
    drawn.draw({"add": {"points": [[9, 0, 0]]}})
    drawn.undo()
    assert drawn.state.x[[1, 3]].tolist() == [[2, 0, -1], [2, 0, 0]]


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        ({}, "nothing given; give exactly one of add, divide, extrude, delete"),
        ({"add": {"forces": [{"kind": "springs", "particles": [[0, 9]]}]}}, "particle 9 does not exist; there are 3"),
        ({"add": {"faces": {"a": [[0, 1, 7]]}}}, "particle 7 does not exist"),
        ({"add": {"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]]}]}}, "give particles by number"),
        ({"add": {"forces": [{"kind": "springs", "mesh": "b"}]}}, "mesh 'b' does not exist"),
        ({"divide": {"springs": [2]}}, "spring 2 does not exist; there are 2"),
        ({"divide": {"faces": {"a": [0]}}}, "mesh 'a' does not exist"),
        ({"divide": {"springs": [0], "pieces": 1}}, "at least 2 allowed"),
        ({"extrude": {"edges": [[0, 1]], "by": [0, 0, 0]}}, "zero length"),
        ({"extrude": {"edges": [[0, 8]], "by": [0, 0, 1]}}, "particle 8 does not exist"),
        ({"delete": {"particles": [3]}}, "particle 3 does not exist"),
    ],
)
def test_what_does_not_fit_is_named_and_changes_nothing(edit: dict[str, Any], said: str):
    drawn = lines()
    before = drawn.scene.canonical, drawn.state.revision, len(drawn.history.before)
    with pytest.raises(InputError, match=said):
        drawn.draw(edit)
    assert (drawn.scene.canonical, drawn.state.revision, len(drawn.history.before)) == before


def test_old_models_are_forgotten_where_they_are_large(monkeypatch: pytest.MonkeyPatch):
    """Of small models all that were drawn can be taken back, of large ones ten."""
    drawn = lines()
    for _ in range(12):
        drawn.draw({"add": {"points": [[9, 9, 9]]}})
    assert len(drawn.history.before) == 15
    monkeypatch.setattr("hookean.running.history.LARGE", 20)
    drawn.draw({"add": {"points": [[9, 9, 9]]}})
    assert len(drawn.history.before) == 10
