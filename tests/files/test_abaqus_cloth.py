"""Membranes, shells and elastic supports in Abaqus input files, read back by meshio and by a parser of their own."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import hookean
from hookean import Scene
from hookean.files.exchange.abaqus_blocks import number
from hookean.running.result import Result

Spec = dict[str, Any]
GRID = [[x, y, 0.1 * x * (2 - y)] for y in range(3) for x in range(3)]
FACES = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8], [4, 8, 7]]
ORTHOTROPIC = {"warp_stiffness": 500, "weft_stiffness": 300, "shear_stiffness": 40, "poisson": 0.2, "warp": [1, 0.2, 0]}
STEEL = {"E": 210.0, "poisson": 0.3, "density": 7.85, "expansion": 12e-6}
KINDS = {"SPRING1": "vertex"}  # meshio has this cell, not this name of it
SPRING1 = "Elastic supports are SPRING1, with which meshio does not read the file."


def roof(cloth: Spec, **more: Any) -> Spec:
    """Three quads and two triangles with a cable along an edge, a bar, an elastic support and a load."""
    return {
        "units": {"length": "m", "force": "kN"},
        "particles": GRID,
        "meshes": {"roof": {"vertices": GRID, "faces": FACES}},
        "materials": {"mild steel": STEEL},
        "sections": {"bar": {"area": 0.02}},
        "forces": [
            {"kind": "membrane", "name": "cloth", "mesh": "roof", "prestress": [2, 3, 0.1], **cloth},
            {"kind": "springs", "name": "edge", "particles": [[0, 1], [1, 2]], "axial_stiffness": 50, "force": 1,
             "tension_only": True},
            {"kind": "springs", "name": "bar", "particles": [[4, 7]], "material": "mild steel", "section": "bar",
             "force": -0.1},
            {"kind": "support", "name": "soil", "particles": [7], "stiffness": [4, 5, 6]},
            {"kind": "unary", "name": "snow", "particles": [4, 7], "vector": [0, 0.1, -1]},
        ],
        "anchors": [{"particles": [0, 2, 3, 5, 6, 8]}],
        "settings": {"tolerance": 1e-11},
        **more,
    }  # fmt: skip


def saved(spec: Spec, path: Path) -> tuple[Result, list[str]]:
    found = hookean.relax(Scene.read(spec))
    assert found.converged
    return found, found.save(path)


def read(path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    table = meshio.abaqus._abaqus.abaqus_to_meshio_type
    for kind, cells in KINDS.items():
        monkeypatch.setitem(table, kind, cells)
    return meshio.read(path)


def blocks(path: Path) -> list[tuple[str, dict[str, str], list[list[str]]]]:
    """Every block of a file: its keyword, parameters, and rows of fields."""
    found: list[tuple[str, dict[str, str], list[list[str]]]] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("*"):
            keyword, *given = (part.strip() for part in line[1:].split(","))
            pairs = (part.partition("=")[::2] for part in given)
            found.append((keyword, dict(pairs), []))
        elif found[-1][0] != "HEADING":
            found[-1][2].append([part.strip() for part in line.split(",")])
    return found


def only(path: Path, keyword: str, **given: str) -> list[list[str]]:
    """The rows of the block of this keyword and parameters."""
    (rows,) = (r for k, has, r in blocks(path) if k == keyword and given.items() <= has.items())
    return rows


def members(path: Path, name: str) -> list[int]:
    return [int(part) for row in only(path, "ELSET", ELSET=name) for part in row]


def nodal(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Forces (n, 3) on the points by the initial stress of the file, and by its loads: a truss pulls with its stress
    times its area, a triangle with thickness x stress x (normal x opposite edge) / 2 at each corner."""
    x = np.array([[float(v) for v in row[1:]] for row in only(path, "NODE")])
    inner, outer = np.zeros_like(x), np.zeros_like(x)
    nodes = {int(row[0]): np.array(row[1:], int) - 1 for k, _, rows in blocks(path) if k == "ELEMENT" for row in rows}
    sections = {i: (has, float(rows[0][0])) for k, has, rows in blocks(path) if k.endswith(" SECTION")
                for i in members(path, has["ELSET"])}  # fmt: skip
    warps = {row[0]: np.array(row[1:], float) for k, _, rows in blocks(path) if k == "DISTRIBUTION" for row in rows}
    for first, *values in only(path, "INITIAL CONDITIONS", TYPE="STRESS"):
        at, (has, size), stress = nodes[int(first)], sections[int(first)], np.array(values, float)
        if len(at) == 2:
            along = (x[at[1]] - x[at[0]]) / np.linalg.norm(x[at[1]] - x[at[0]])
            inner[at] += size * stress[0] * np.stack([along, -along])
            continue
        normal = np.cross(x[at[1]] - x[at[0]], x[at[2]] - x[at[0]])
        normal /= np.linalg.norm(normal)
        along = warps[first][:3] if "ORIENTATION" in has else np.array([1.0, 0, 0])
        along = along - (along @ normal) * normal
        along /= np.linalg.norm(along)
        across = np.cross(normal, along)
        tensor = stress[0] * np.outer(along, along) + stress[1] * np.outer(across, across)
        tensor += stress[2] * (np.outer(along, across) + np.outer(across, along))
        for i in range(3):
            inner[at[i]] -= 0.5 * size * tensor @ np.cross(normal, x[at[i - 1]] - x[at[i - 2]])
    for point, axis, value in only(path, "CLOAD"):
        outer[int(point) - 1, int(axis) - 1] += float(value)
    return inner, outer


@pytest.mark.parametrize("cloth", [ORTHOTROPIC, {"warp_stiffness": 500, "poisson": 0.3, "warp": [0.3, 1, 0]}])
def test_what_the_file_holds_is_in_equilibrium(cloth: Spec, tmp_path: Path) -> None:
    """Stress of cloth and lines, loads, and what the elastic support carries in the shape, on every free point; and the
    reactions are those of the result: to what is out of balance, and the digits of the file."""
    result, said = saved(roof(cloth), tmp_path / "roof.inp")
    assert said[1:] == [SPRING1]  # nothing is left out
    inner, outer = nodal(tmp_path / "roof.inp")
    free, size = [1, 4, 7], np.abs(inner).max()
    assert size > 1.0 and np.abs((inner + outer)[free]).max() < 1e-9 * size
    held = dict(zip(result.reactions["particles"], result.reactions["force"], strict=True))
    for point in (0, 2, 3, 5, 6, 8):
        np.testing.assert_allclose(-(inner + outer)[point], held[point], atol=1e-9 * size)
    assert only(tmp_path / "roof.inp", "BOUNDARY") == [
        [str(point + 1), axis, axis] for point in (0, 2, 3, 5, 6, 8) for axis in "123"
    ]


def cloth_edges(found: Any) -> list[tuple[int, int]]:
    """The edges of each triangle of a file."""
    triangles = np.concatenate([part.data for part in found.cells if part.type == "triangle"]).tolist()
    return [(row[i], row[i - 1]) for row in triangles for i in range(3)]


def test_cloth_without_elastic_supports_is_read_by_any_meshio(tmp_path: Path) -> None:
    """With the cells that it knows for the names of elements."""
    spec = roof(ORTHOTROPIC)
    spec["forces"] = [force for force in spec["forces"] if force["kind"] != "support"]
    result, _ = saved(spec, tmp_path / "roof.inp")
    found = meshio.read(tmp_path / "roof.inp")
    np.testing.assert_allclose(found.points, result.particles, rtol=1e-15, atol=1e-15)
    assert [(part.type, len(part.data)) for part in found.cells] == [("line", 3), ("triangle", 12), ("triangle", 2)]


def test_elements_sets_materials_and_sections_are_those_of_the_scene(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By meshio: points, elements and sets. By the blocks: the numbers of the cloth, of steel with its area, density
    and expansion, and springs to the ground."""
    path = tmp_path / "roof.inp"
    result, _ = saved(roof(ORTHOTROPIC), path)
    found = read(path, monkeypatch)
    np.testing.assert_allclose(found.points, result.particles, rtol=1e-15, atol=1e-15)
    assert [(part.type, len(part.data)) for part in found.cells] == [
        ("line", 3), ("triangle", 12), ("triangle", 2), ("vertex", 1), ("vertex", 1), ("vertex", 1),
    ]  # fmt: skip
    assert [len(rows) for rows in found.cell_sets["CLOTH"][:3]] == [0, 12, 2]
    assert found.cell_sets["EDGE"][0].tolist() == [0, 1] and found.cell_sets["BAR"][0].tolist() == [2]
    assert found.cells[2].data.tolist() == [[4, 5, 8], [4, 8, 7]]
    whole = {tuple(sorted(row)) for row in found.cells[1].data.tolist()}
    assert whole == {tuple(sorted(f[i] for i in range(4) if i != j)) for f in FACES[:3] for j in range(4)}
    sections = {has["ELSET"]: (has["MATERIAL"], rows) for k, has, rows in blocks(path) if k.endswith(" SECTION")}
    half, thin = (float(rows[0][0]) for name, (_, rows) in sections.items() if name.startswith("SHEET"))
    edge = np.mean([np.linalg.norm(np.subtract(*found.points[[a, b]])) for a, b in cloth_edges(found)])
    assert thin == pytest.approx(1e-3 * edge, rel=1e-12) and half == pytest.approx(0.5 * thin, rel=1e-12)
    (lamina,) = only(path, "ELASTIC", TYPE="LAMINA")
    warp, weft, poisson, *shear = (float(value) for value in lamina)
    assert [thin * warp, thin * weft, poisson] == pytest.approx([500, 300, 0.2], rel=1e-12)
    assert [thin * value for value in shear] == pytest.approx([40, 40, 40], rel=1e-12)
    steel = next(name for name, (material, _) in sections.items() if material == "MILD_STEEL")
    assert members(path, steel) == members(path, "BAR") and sections[steel][1] == [["0.02"]]
    text = path.read_text()
    assert "*MATERIAL, NAME=MILD_STEEL\n*ELASTIC\n210.0, 0.0\n*DENSITY\n7.85\n*EXPANSION\n1.2e-05\n" in text
    assert text.count("*NO COMPRESSION") == 1 and re.search(r"\n50.0, 0.0\n\*NO COMPRESSION\n", text)
    springs = [rows for keyword, _, rows in blocks(path) if keyword == "SPRING"]
    assert springs == [[["1"], ["4.0"]], [["2"], ["5.0"]], [["3"], ["6.0"]]]


def test_a_shell_and_a_membrane_are_plates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """S4 and S3 of the thickness and modulus that they have by a material, or by E t and D; where they start, for a
    shell has no stress there; along x the prestress of a warp along y is that of its weft."""
    path, t = tmp_path / "roof.inp", 0.1
    solid = {"material": "mild steel", "thickness": t, "warp": [0, 1, 0], "prestress": [2, 3, 0]}
    bending = {"kind": "shell", "name": "bending", "mesh": "roof", "material": "mild steel", "thickness": t}
    stiff = {"kind": "shell", "name": "bending", "mesh": "roof", "strength": 21.0 * t**2 / 12 / 0.91, "poisson": 0.3}
    own = {"warp_stiffness": 21.0, "poisson": 0.3, "warp": [0, 1, 0], "prestress": [2, 3, 0]}
    flat = [[x, y, 0.0] for x, y, _ in GRID]
    for cloth, shell, name in ((solid, bending, "MILD_STEEL"), (own, stiff, "MATERIAL_3")):
        spec = roof(cloth, particles=flat, meshes={"roof": {"vertices": flat, "faces": FACES}})
        spec["forces"].append(shell)
        result, said = saved(spec, path)
        assert said[1:2] == [SPRING1]
        found = read(path, monkeypatch)
        np.testing.assert_allclose(found.points, flat, atol=1e-15)
        assert np.abs(result.particles - found.points).max() > 1e-3
        assert [cells.data.tolist() for cells in found.cells[1:3]] == [FACES[3:], FACES[:3]]
        text = path.read_text()
        assert "*ELEMENT, TYPE=S3\n" in text and "*ELEMENT, TYPE=S4\n" in text
        sections = [(has, rows) for k, has, rows in blocks(path) if k == "SHELL SECTION"]
        assert [float(rows[0][0]) for _, rows in sections] == pytest.approx([t, t], rel=1e-12)
        assert {has["MATERIAL"] for has, _ in sections} == {f"{name}_V2" if name == "MILD_STEEL" else name}
        elastic = re.search(rf"NAME={sections[0][0]['MATERIAL']}\n\*ELASTIC\n([^\n]*)\n", text)
        assert elastic and [float(v) for v in elastic[1].split(",")] == pytest.approx([210.0, 0.3], rel=1e-12)
        stress = np.array([row[1:] for row in only(path, "INITIAL CONDITIONS") if len(row) == 4], dtype=float)
        np.testing.assert_allclose(stress, np.tile([30.0, 20.0, 0.0], (5, 1)), atol=1e-12)


def test_bending_that_is_of_no_plate_is_named(tmp_path: Path) -> None:
    """A shell without cloth, or on cloth that is not alike in all directions; and wrinkles."""
    spec = roof({**ORTHOTROPIC, "wrinkling": True})
    spec["forces"].append({"kind": "shell", "name": "bending", "mesh": "roof", "strength": 1.0})
    _, said = saved(spec, tmp_path / "roof.inp")
    has = "beams, membranes, lines with an axial stiffness, and elastic supports"
    assert said[1:] == [
        f"bending: not in the file, which has {has}.",
        SPRING1,
        "cloth: the file does not hold its wrinkles.",
    ]
    assert "TYPE=S3" in (tmp_path / "roof.inp").read_text()


def test_no_field_is_longer_than_twenty_characters(tmp_path: Path) -> None:
    """All that a number may have in these files: a longer one is not read, or is cut."""
    rng = np.random.default_rng(1)
    values = np.sign(rng.normal(size=300)) * 10.0 ** rng.uniform(-99, 99, 300)
    for value in (*values.tolist(), *(rng.normal(size=300)).tolist(), 0.0, -1.0 / 3.0, 1e22):
        assert len(number(value)) <= 20
        assert float(number(value)) == pytest.approx(value, rel=1e-13)
    saved(roof(ORTHOTROPIC), tmp_path / "roof.inp")
    assert max(len(part) for _, _, rows in blocks(tmp_path / "roof.inp") for row in rows for part in row) <= 20
