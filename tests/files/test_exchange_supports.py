"""Elastic supports, materials, sections and what is left out in files for other programs, by independent readers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import compas
import ezdxf
import ifcopenshell
import ifcopenshell.validate
import meshio
import numpy as np
import pytest

import hookean
from hookean import Result, Scene


@pytest.fixture(scope="module")
def portal() -> Result:
    """A portal of a tube on a pinned foot and an elastic one, tied by a rod and a bar of given numbers, with a sail."""
    spec: dict[str, Any] = {
        "units": {"force": "kN"},
        "particles": [[0, 0, 0], [0, 0, 3], [4, 0, 3], [4, 0, 0], [2, 3, 2]],
        "materials": {"steel": {"E": 210e6, "G": 81e6, "strength": 355e3}},
        "sections": {
            "post": {"shape": "tube", "diameter": 0.2, "thickness": 0.01},
            "tie": {"shape": "rod", "diameter": 0.02},
            "bar": {"area": 1e-3},
        },
        "meshes": {"sail": {"vertices": [[0, 0, 3], [4, 0, 3], [2, 3, 2]], "faces": [[0, 1, 2]]}},
        "forces": [
            {"kind": "beam", "name": "frame", "particles": [[0, 1], [1, 2], [2, 3]], "normal": [0, 1, 0]}
            | {"material": "steel", "section": "post"},
            {"kind": "springs", "name": "tie", "particles": [[0, 3]], "material": "steel", "section": "tie"},
            {"kind": "springs", "name": "bar", "particles": [[1, 4]], "material": "steel", "section": "bar"},
            {"kind": "membrane", "name": "sail", "mesh": "sail", "warp_stiffness": 800, "poisson": 0.3},
            {"kind": "unary", "name": "P", "particles": [1, 2], "vector": [1, 0.5, -5]},
            {"kind": "support", "name": "soil", "particles": [3], "stiffness": [5e3, 5e3, 1e4]}
            | {"rotation_stiffness": [100, 200, 300]},
        ],
        "anchors": [{"name": "foot", "particles": [0]}, {"name": "mast", "particles": [4]}],
    }
    found = hookean.relax(Scene.read(spec))
    assert found.converged
    return found


def test_elastic_supports_are_in_dxf_and_compas_so_that_reactions_balance_loads(portal: Result, tmp_path: Path) -> None:
    """Forces sum to zero within what is out of balance at each of the particles; the soil's stiffness is there."""
    most = len(portal.particles) * portal.out_of_balance + 1e-12
    portal.save(tmp_path / "portal.dxf")
    total, stiff = np.zeros(3), []
    for thing in ezdxf.readfile(tmp_path / "portal.dxf").modelspace():
        told = [value for _, value in thing.get_xdata("HOOKEAN")] if thing.has_xdata("HOOKEAN") else []
        for name in ("reaction [kN]", "load [kN]"):
            total += told[told.index(name) + 1 :][:3] if name in told else [0.0] * 3
        stiff += [told[-8:]] if "stiffness [kN/m]" in told else []
    assert np.abs(total).max() < most
    assert stiff == [["stiffness [kN/m]", 5e3, 5e3, 1e4, "rotation stiffness [kN m]", 100, 200, 300]]
    portal.save(tmp_path / "portal.compas.json")
    graph = compas.json_load(str(tmp_path / "portal.compas.json"))
    nodes = [data for _, data in graph.nodes(data=True)]
    forces = [[node.get(f"{of}{axis}") or 0.0 for axis in "xyz"] for of in "pr" for node in nodes]
    assert np.abs(np.sum(forces, axis=0)).max() < most
    assert graph.node_attributes(3, ["kx", "ky", "kz", "kmx", "kmy", "kmz"]) == [5e3, 5e3, 1e4, 100, 200, 300]


def test_members_have_their_material_and_section(portal: Result, tmp_path: Path) -> None:
    """By name on edges of COMPAS; in IFC, valid by ifcopenshell's checker, as profiles of the shapes, each once."""
    portal.save(tmp_path / "portal.compas.json")
    graph = compas.json_load(str(tmp_path / "portal.compas.json"))
    assert graph.edge_attributes((0, 1), ["material", "section"]) == ["steel", "post"]
    portal.save(tmp_path / "portal.ifc")
    read = ifcopenshell.open(str(tmp_path / "portal.ifc"))
    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(read, log)
    assert log.statements == []
    made = {}
    for relation in read.by_type("IfcRelAssociatesMaterial"):
        [one] = relation.RelatingMaterial.MaterialProfiles
        for member in relation.RelatedObjects:
            made[member.Name] = (one.Material.Name, one.Profile.is_a(), one.Profile.ProfileName)
    tube = ("steel", "IfcCircleHollowProfileDef", "post")
    assert made == {f"frame {i}": tube for i in range(3)} | {
        "tie 0": ("steel", "IfcCircleProfileDef", "tie"),
        "bar 0": ("steel", "IfcProfileDef", "bar"),
    }
    [ring] = read.by_type("IfcCircleHollowProfileDef")
    assert (ring.Radius, ring.WallThickness) == (0.1, 0.01)
    assert len(read.by_type("IfcMaterial")) == 1


def test_saving_names_what_a_file_does_not_hold(portal: Result, tmp_path: Path) -> None:
    """Membranes in files of lines; of elastic supports, that meshio stops at them, as it does."""
    for ending in ("ifc", "compas.json"):
        said = portal.save(tmp_path / f"portal.{ending}")
        assert "Membranes on sail: not in the file, which has lines alone." in said
    assert not any("Membranes" in sentence for sentence in portal.save(tmp_path / "portal.vtu"))
    said = portal.save(tmp_path / "portal.inp")
    assert "Elastic supports are SPRING1, with which meshio does not read the file." in said
    with pytest.raises(BaseException, match=r"^1$|SPRING1"):
        meshio.read(tmp_path / "portal.inp")
    lying = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [{"kind": "springs", "particles": [[0, 1]]}, {"kind": "floor"}, {"kind": "self_weight", "total": 2}],
        "anchors": [{"particles": [0, 1], "axes": "xy"}],
    }
    rest = hookean.relax(Scene.read(lying))
    assert "The forces of floors on 2 particles are not in the file." in rest.save(tmp_path / "lying.vtu")
