"""Beams in Abaqus input files, read back by meshio, and solved by matrices into which only the file goes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.files.exchange.write import exchange

TUBE = {"E": 200.0, "G": 80.0, "A": 1.0, "Iy": 0.08, "Iz": 0.02, "J": 0.05}
Spec = dict[str, Any]


def frame(**more: Any) -> Spec:
    """A bent frame in space: two beams with another one across, a stay with prestress, a force and a moment."""
    return {
        "particles": [[0, 0, 0], [1, 0.5, 2], [3, 0.5, 2.5], [1, 3, 2], [3, 0, 5]],
        "forces": [
            {"kind": "beam", "name": "rib", "particles": [[0, 1], [1, 2]], **TUBE, "normal": [0.2, 1, 0.1]},
            {"kind": "beam", "name": "purlin", "particles": [[1, 3]], **TUBE, "Iz": 0.01, **more},
            {"kind": "springs", "name": "stay", "particles": [[2, 4]], "axial_stiffness": 5.0, "force": 1e-7},
            {"kind": "unary", "particles": [2], "vector": [0, 2e-6, -1e-6], "moment": [1e-6, 0, 2e-6]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"particles": [3], "rotations": "y"}, {"particles": [4]}],
        "settings": {"tolerance": 1e-11},
    }


def block(text: str, keyword: str) -> list[list[str]]:
    """The lines of the first block of a keyword, as their parts."""
    found = re.search(rf"^\*{keyword}\b[^\n]*\n((?:[^*\n][^\n]*\n)*)", text, re.M)
    return [[part.strip() for part in line.split(",")] for line in found[1].splitlines()] if found else []


def beam_matrix(length: float, e: float, g: float, area: float, first: float, second: float, torsion: float) -> Any:
    """The stiffness (12, 12) of a straight beam along t in its own axes n1, n2, t; `first` is I11, against bending
    about n1 (Przemieniecki, Theory of matrix structural analysis, 1968, 5.6, without shear)."""
    k = np.zeros((12, 12))
    for a, b, sign in ((0, 0, 1), (0, 6, -1), (6, 0, -1), (6, 6, 1)):
        k[a + 2, b + 2] += sign * e * area / length
        k[a + 5, b + 5] += sign * g * torsion / length
    # u along one axis turns by u' about the other: about n2 along n1, and the other way round about n1 along n2
    for u, turn, inertia, way in ((0, 4, second, 1.0), (1, 3, first, -1.0)):
        at = [u, turn, u + 6, turn + 6]
        t = np.diag([1.0, way, 1.0, way])
        own = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4.0]])
        scale = np.array([1.0, length, 1.0, length])
        k[np.ix_(at, at)] += t @ (e * inertia / length**3 * own * scale * scale[:, None]) @ t
    return k


def released(k: Any, freed: list[int]) -> Any:
    """A stiffness without some of its unknowns, which carry nothing."""
    for i in freed:
        k = k - np.outer(k[:, i], k[i]) / k[i, i]
    return k


def solved(path: Path) -> np.ndarray:
    """Displacements (n, 6) of the model of a file for small loads."""
    read, text = meshio.read(path), path.read_text(encoding="utf-8")
    x, size = read.points, len(read.points)
    stiff, force = np.zeros((6 * size, 6 * size)), np.zeros(6 * size)
    modulus = float(block(text, "ELASTIC")[0][0])
    trusses = len(read.cells[0].data)
    for (a, b), (_, stress) in zip(read.cells[0].data, block(text, "INITIAL CONDITIONS"), strict=True):
        d = (x[b] - x[a]) / np.linalg.norm(x[b] - x[a])
        pull = np.concatenate([-d, d])
        at = [6 * a, 6 * a + 1, 6 * a + 2, 6 * b, 6 * b + 1, 6 * b + 2]
        stiff[np.ix_(at, at)] += modulus / np.linalg.norm(x[b] - x[a]) * np.outer(pull, pull)
        force[at] -= float(stress) * pull
    codes = {"M1": 3, "M2": 4, "T": 5}
    hinges = {(int(n), end): code.split("-") for n, end, code in block(text, "RELEASE")}
    headings = re.findall(
        r"ELSET=BEAM_SECTION_(\d+)[^\n]*\n([^\n]*)\n([^\n]*)\n([^\n]*)\n", text.split("*BEAM GENERAL", 1)[1]
    )
    for number, first, second, third in headings:
        area, i11, _, i22, j = map(float, first.split(","))
        axis, (e, g) = np.array(list(map(float, second.split(",")))), map(float, third.split(","))
        for row in read.cell_sets[f"BEAM_SECTION_{number}"][1]:
            a, b = read.cells[1].data[row]
            length = np.linalg.norm(x[b] - x[a])
            t = (x[b] - x[a]) / length
            n1 = axis - (axis @ t) * t
            n1 /= np.linalg.norm(n1)
            turn = np.kron(np.eye(4), np.stack([n1, np.cross(t, n1), t]))
            k = beam_matrix(length, e, g, area, i11, i22, j)
            for end, shift in (("S1", 0), ("S2", 6)):
                k = released(k, [shift + codes[c] for c in hinges.get((trusses + row + 1, end), [])])
            at = [*range(6 * a, 6 * a + 6), *range(6 * b, 6 * b + 6)]
            stiff[np.ix_(at, at)] += turn.T @ k @ turn
    for n, axis, value in block(text, "CLOAD"):
        force[6 * (int(n) - 1) + int(axis) - 1] += float(value)
    free = np.ones(6 * size, dtype=bool)
    for n, axis, _ in block(text, "BOUNDARY"):
        free[6 * (int(n) - 1) + int(axis) - 1] = False
    free[np.abs(stiff).sum(axis=1) == 0.0] = False  # rotations where only a stay ends
    moved = np.zeros(6 * size)
    moved[free] = np.linalg.solve(stiff[np.ix_(free, free)], force[free])
    return moved.reshape(-1, 6)


@pytest.mark.parametrize("hinged", [{}, {"release_start": "yz"}, {"release_end": ["xz"], "normal": [1, 0, 0]}])
def test_a_frame_is_the_same_model_for_the_other_program(hinged: Spec, tmp_path: Path) -> None:
    """Points, elements and sets by meshio; displacements by matrices, to the rotations of 1e-7 of loads so small."""
    found = hookean.relax(Scene.read(frame(**hinged)))
    assert len(found.save(tmp_path / "frame.inp")) == 1
    read = meshio.read(tmp_path / "frame.inp")
    np.testing.assert_allclose(read.points, frame()["particles"], atol=1e-15)
    assert [cells.type for cells in read.cells] == ["line", "line"]
    assert read.cells[0].data.tolist() == [[2, 4]] and read.cells[1].data.tolist() == [[0, 1], [1, 2], [1, 3]]
    assert read.cell_sets["STAY"][0].tolist() == [0] and read.cell_sets["PURLIN"][1].tolist() == [2]
    assert read.cell_sets["RIB"][1].tolist() == [0, 1] and read.point_sets["HELD"].tolist() == [0, 3, 4]
    assert "*ELEMENT, TYPE=T3D2\n" in (text := (tmp_path / "frame.inp").read_text()) and "TYPE=B31\n" in text
    moved = solved(tmp_path / "frame.inp")
    size = np.abs(moved[:, :3]).max()
    assert 1e-8 < size < 1e-4
    np.testing.assert_allclose(found.particles - read.points, moved[:, :3], atol=1e-5 * size)


@pytest.mark.slow
def test_eccentric_ends_are_linked_and_shear_and_hinges_written(tmp_path: Path) -> None:
    """A point for each eccentric end, where it is, with a rigid link to its particle; G times the shear area."""
    more = {"offset_end": [0, 0, -0.5], "shear_y": 0.5, "shear_z": 0.25, "release_end": "xyz"}
    found = hookean.relax(Scene.read(frame(**more)))
    found.save(tmp_path / "frame.inp")
    read, text = meshio.read(tmp_path / "frame.inp"), (tmp_path / "frame.inp").read_text()
    np.testing.assert_allclose(read.points[5:], [[1, 3, 1.5]])
    assert read.cells[1].data.tolist() == [[0, 1], [1, 2], [1, 5]]
    assert block(text, "MPC") == [["BEAM", "6", "4"]] and block(text, "RELEASE") == [["4", "S2", "ALLM"]]
    assert [float(v) for v in block(text, "TRANSVERSE SHEAR STIFFNESS")[0]] == pytest.approx([20.0, 40.0])  # n2: z


def test_a_load_case_has_the_points_without_stress(tmp_path: Path) -> None:
    """Where the beams start, also of a system that counts displacements from the form; as the result alone gives it."""
    spec = frame()
    spec["forces"][3]["name"] = "push"
    spec["forces"].append({"kind": "unary", "particles": [1], "vector": [0, 0, -0.1]})  # acts on the form, too
    cases = hookean.load_cases(Scene.read({**spec, "load_cases": {"push": {"forces": ["push"]}}}))
    case = cases.cases["push"]
    system, state = cases.frozen.system(case.result.scene)
    system.x = state.x
    exchange(case.result, tmp_path / "one.inp", system)
    case.result.save(tmp_path / "two.inp")
    assert (tmp_path / "one.inp").read_bytes() == (tmp_path / "two.inp").read_bytes()
    start = np.array(spec["particles"])
    np.testing.assert_allclose(meshio.read(tmp_path / "one.inp").points, start, atol=1e-15)
    assert np.abs(cases.frozen.particles - start).max() > 1e-3


def test_what_a_file_of_beams_cannot_hold_is_named(tmp_path: Path) -> None:
    """Springs with cutoffs at other lengths, films, and beams that are bent in."""
    spec = frame(curvature="straight")
    spec["forces"][2]["upper_cutoff"] = 50.0
    spec["meshes"] = {"m": {"vertices": spec["particles"][:3], "faces": [[0, 1, 2]]}}
    spec["forces"].append({"kind": "soapfilm", "name": "film", "mesh": "m", "tension": 1e-9})
    spec["forces"].append({"kind": "support", "name": "soil", "particles": [2], "stiffness": [1, 1, 1]})
    found = hookean.relax(Scene.read(spec))
    assert found.save(tmp_path / "frame.inp")[1:] == [
        "film: not in the file, which has beams, membranes, lines with an axial stiffness, and elastic supports.",
        "Elastic supports are SPRING1, with which meshio does not read the file.",
        "stay: trusses without their cutoffs.",
        "purlin: the file does not hold the bending of rods that are straight without stress.",
    ]
    assert block((tmp_path / "frame.inp").read_text(), "SPRING") == [["1"], ["1.0"]]


def test_what_strains_far_from_the_points_of_the_start_is_named(tmp_path: Path) -> None:
    """A slack cable beside a mast: with a logarithmic strain from the points and the stress of the file, its force is
    not that of the result, which saving reports. Drawn where it hangs, it has that force."""
    drawn = [[0, 0, 0], [0, 0, 2], [2, 0, 2], [4, 0, 2]]
    spec: Spec = {
        "particles": drawn,
        "forces": [
            {"kind": "beam", "name": "mast", "particles": [[0, 1]], **TUBE},
            {"kind": "springs", "name": "cable", "particles": [[1, 2], [2, 3]], "axial_stiffness": 50.0,
             "rest_length": 2.2},
            {"kind": "unary", "particles": [2], "vector": [0, 0, -1e-2]},
        ],
        "anchors": [{"particles": [0], "rotations": "xyz"}, {"particles": [3]}],
    }  # fmt: skip

    def saved(points: Any) -> tuple[list[str], float, float]:
        """What saving says, the force that the file gives, and that of the result."""
        found = hookean.relax(Scene.read({**spec, "particles": points}))
        said = found.save(tmp_path / "cable.inp")[1:]
        stress = float(block((tmp_path / "cable.inp").read_text(), "INITIAL CONDITIONS")[0][1])
        length, before = (np.linalg.norm(np.subtract(p[2], p[1])) for p in (found.particles, points))
        return said, stress + 50.0 * np.log(length / before), found.force("cable")["force"][0]

    said, force, real = saved(drawn)
    assert force > 10.0 * real  # 2 m to 2.2 m: 9.5 % logarithmic, 9.1 % of the rest length
    assert len(said) == 1
    assert said[0].startswith("The points are those of the start, from which cable strain by up to 10 %: ")
    said, force, real = saved(hookean.relax(Scene.read(spec)).particles)
    assert not said
    assert force == pytest.approx(real, rel=0.01)
