"""A frame of beams, a cable net and a membrane beside Kratos Multiphysics, an engine of its own (the extra `oracle`).

Both solve the same meshes for the same loads at large displacements, so they agree to what differs of their elements:
the terms of higher order in the strains. Displacements agree to 1e-4 of the largest.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean import Scene, relax

pytestmark = pytest.mark.soak

Floats = np.ndarray


def kratos(
    x: Floats, kind: str, elements: Any, values: Any, law: str, held: Any, loads: Floats, turning: bool
) -> Floats:
    """Displacements (n, 3) by Newton steps of Kratos; `values` are the properties of its elements by name."""
    core = pytest.importorskip("KratosMultiphysics", reason="the extra oracle is not installed")
    structural = pytest.importorskip("KratosMultiphysics.StructuralMechanicsApplication")
    pytest.importorskip("KratosMultiphysics.ConstitutiveLawsApplication")
    linear = pytest.importorskip("KratosMultiphysics.LinearSolversApplication")
    core.Logger.GetDefaultOutput().SetSeverity(core.Logger.Severity.WARNING)
    model = core.Model()
    part = model.CreateModelPart("structure")
    part.ProcessInfo[core.DOMAIN_SIZE] = 3
    pairs = [(core.DISPLACEMENT, core.REACTION)]
    pairs += [(core.ROTATION, core.REACTION_MOMENT)] if turning else []
    extra = [structural.POINT_LOAD, structural.POINT_MOMENT, core.VOLUME_ACCELERATION]
    for variable in [*(v for pair in pairs for v in pair), *extra]:
        part.AddNodalSolutionStepVariable(variable)
    nodes = [part.CreateNewNode(i + 1, *map(float, place)) for i, place in enumerate(x)]
    own = part.GetProperties()[1]
    for name, value in values.items():
        own.SetValue(core.KratosGlobals.GetVariable(name), value)
    own.SetValue(core.CONSTITUTIVE_LAW, core.KratosGlobals.GetConstitutiveLaw(law).Clone())
    for i, element in enumerate(elements):
        part.CreateNewElement(kind, i + 1, [int(n) + 1 for n in element], own)
    for node, load in zip(nodes, loads, strict=True):
        part.CreateNewCondition("PointLoadCondition3D1N", node.Id, [node.Id], own)
        node.SetSolutionStepValue(structural.POINT_LOAD, load.tolist())
    for variable, reaction in pairs:
        for axis in "XYZ":
            one, other = (core.KratosGlobals.GetVariable(f"{v.Name()}_{axis}") for v in (variable, reaction))
            core.VariableUtils().AddDof(one, other, part)
            for number in held:
                nodes[int(number)].Fix(one)
    strategy = core.ResidualBasedNewtonRaphsonStrategy(
        part, core.ResidualBasedIncrementalUpdateStaticScheme(), core.DisplacementCriteria(1e-10, 1e-14),
        core.ResidualBasedBlockBuilderAndSolver(linear.SparseLUSolver()), 60, False, False, True,
    )  # fmt: skip
    part.CloneTimeStep(1.0)
    strategy.Initialize()
    strategy.InitializeSolutionStep()
    strategy.Predict()
    assert strategy.SolveSolutionStep()
    return np.array([[node.X, node.Y, node.Z] for node in nodes]) - x


def grid(n: int) -> tuple[Floats, np.ndarray, np.ndarray]:
    """Points of a saddle over a square of 10, their numbers (n + 1, n + 1), and those of the rim."""
    a, b = np.meshgrid(np.linspace(-5, 5, n + 1), np.linspace(-5, 5, n + 1), indexing="ij")
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    rim = np.unique(np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]]))
    return np.stack([a, b, 0.04 * a * b], axis=-1).reshape(-1, 3), number, rim


def assert_same(spec: dict[str, Any], x: Floats, wanted: Floats) -> None:
    """Displacements to 1e-4 of the largest."""
    found = relax(Scene.read({"particles": x, **spec, "settings": {"tolerance": 1e-10}}))
    assert found.converged
    np.testing.assert_allclose(found.particles - x, wanted, atol=1e-4 * np.abs(wanted).max())


def test_a_frame_of_beams() -> None:
    """Two columns and a beam of square tubes under weight and wind, in eight pieces each."""
    s = np.linspace(0.0, 1.0, 9)[:, None]
    corners = np.array([[0, 0, 0], [0, 0, 3], [4, 0.5, 3], [4, 0.5, 0.0]])
    x = np.concatenate([corners[i] + (corners[i + 1] - corners[i]) * s[i > 0 :] for i in range(3)])
    pairs = np.column_stack([np.arange(24), np.arange(1, 25)])
    loads = np.zeros_like(x)
    loads[12], loads[8] = [0, 0, -8e3], [2e3, 1e3, 0]
    a, i, j, e = 1.5e-3, 1.7e-6, 3.4e-6, 210e9
    values = {"YOUNG_MODULUS": e, "POISSON_RATIO": 0.3, "DENSITY": 1.0, "CROSS_AREA": a, "TORSIONAL_INERTIA": j}
    wanted = kratos(x, "CrBeamElement3D2N", pairs, {**values, "I22": i, "I33": i}, "BeamConstitutiveLaw",
                    [0, 24], loads, True)  # fmt: skip
    beam = {"kind": "beam", "particles": pairs, "E": e, "G": e / 2.6, "A": a, "Iy": i, "Iz": i, "J": j}
    push = {"kind": "unary", "particles": range(25), "vector": loads}
    assert_same({"forces": [beam, push], "anchors": [{"particles": [0, 24], "rotations": "xyz"}]}, x, wanted)


def test_a_cable_net() -> None:
    """A prestressed saddle under snow: lines with EA and a force at the start. Kratos strains by Green and Lagrange, of
    which the engine's differ by half their square, and the strains are of the order 1e-4."""
    x, number, rim = grid(8)
    pairs = np.concatenate([np.stack([number[:-1], number[1:]], -1).reshape(-1, 2),
                            np.stack([number[:, :-1], number[:, 1:]], -1).reshape(-1, 2)])  # fmt: skip
    loads = np.zeros_like(x)
    loads[:, 2] = -200.0
    values = {"YOUNG_MODULUS": 2e8, "DENSITY": 1.0, "CROSS_AREA": 1.0, "TRUSS_PRESTRESS_PK2": 2e4}
    wanted = kratos(x, "CableElement3D2N", pairs, values, "TrussConstitutiveLaw", rim, loads, False)
    net = {"kind": "springs", "particles": pairs, "axial_stiffness": 2e8, "force": 2e4, "tension_only": True}
    push = {"kind": "unary", "particles": range(len(x)), "vector": loads}
    assert_same({"forces": [net, push], "anchors": [{"particles": rim}]}, x, wanted)


def test_a_membrane() -> None:
    """A flat prestressed square of triangles under a load across it."""
    x, number, rim = grid(8)
    x[:, 2] = 0.0
    a, b, c, d = number[:-1, :-1].ravel(), number[1:, :-1].ravel(), number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    loads = np.zeros_like(x)
    loads[:, 2] = -20.0
    core = pytest.importorskip("KratosMultiphysics", reason="the extra oracle is not installed")
    stress = core.Vector(3)
    stress[0] = stress[1] = 2e3
    stress[2] = 0.0
    values = {"YOUNG_MODULUS": 6e5, "POISSON_RATIO": 0.0, "DENSITY": 1.0, "THICKNESS": 1.0, "PRESTRESS_VECTOR": stress}
    law = "LinearElasticPlaneStress2DLaw"
    wanted = kratos(x, "MembraneElement3D3N", faces, values, law, rim, loads, False)
    cloth = {"kind": "membrane", "mesh": "cloth", "warp_stiffness": 6e5, "weft_stiffness": 6e5, "shear_stiffness": 3e5,
             "poisson": 0.0, "prestress": [2e3, 2e3, 0], "warp": [1, 0, 0]}  # fmt: skip
    push = {"kind": "unary", "particles": range(len(x)), "vector": loads}
    spec = {"forces": [cloth, push], "anchors": [{"particles": rim}]}
    assert_same({**spec, "meshes": {"cloth": {"vertices": x, "faces": faces}}}, x, wanted)
