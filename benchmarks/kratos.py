"""Kratos Multiphysics (C++, finite elements) beside hookean, on the prestressed net called tent.

Its truss has a force in proportion to the Green strain (l^2 - L^2) / (2 L^2) of the start length L and a prestress of
k (L - L0), where a spring has k (l - L0): stiffness and force agree at the start, the shapes at rest differ.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from peers import Run, Unfit
from problems import Floats, Problem

SOLVER = '{"solver_type": "amgcl"}'
TOLERANCE, STEPS = 1e-7, 60  # of what is out of balance at the start; Newton steps


def kratos(p: Problem, target: float, most: float) -> Run:
    """Newton steps with amgcl on one thread, to 1e-7 of its own first residual, whatever the target; setting up is
    counted, as it is for hookean."""
    import KratosMultiphysics as core
    import KratosMultiphysics.LinearSolversApplication  # its solvers by name
    import KratosMultiphysics.StructuralMechanicsApplication as structural
    from KratosMultiphysics import python_linear_solver_factory as factory

    if p.name != "tent":
        raise Unfit("its Newton steps need a start under tension")
    core.Logger.GetDefaultOutput().SetSeverity(core.Logger.Severity.WARNING)
    core.ParallelUtilities.SetNumThreads(1)
    begun = time.perf_counter()
    model = core.Model()
    part = _structure(p, model, core, structural)
    strategy = core.ResidualBasedNewtonRaphsonStrategy(
        part, core.ResidualBasedIncrementalUpdateStaticScheme(), core.ResidualCriteria(TOLERANCE, 1e-12),
        core.ResidualBasedBlockBuilderAndSolver(factory.ConstructSolver(core.Parameters(SOLVER))), STEPS, True, False,
        True,
    )  # fmt: skip
    strategy.Initialize()
    part.CloneTimeStep(1.0)
    strategy.InitializeSolutionStep()
    strategy.Predict()
    if not strategy.SolveSolutionStep():
        raise Unfit(f"it did not converge in {STEPS} Newton steps")
    strategy.FinalizeSolutionStep()
    x = np.array([[node.X, node.Y, node.Z] for node in part.Nodes])
    return Run(time.perf_counter() - begun, int(part.ProcessInfo[core.NL_ITERATION_NUMBER]), x)


def _structure(p: Problem, model: Any, core: Any, structural: Any) -> Any:
    """The problem as trusses of cross-section 1 under nodal loads."""
    part = model.CreateModelPart("structure")
    part.ProcessInfo[core.DOMAIN_SIZE] = 3
    for variable in (core.DISPLACEMENT, core.REACTION, core.VOLUME_ACCELERATION, structural.POINT_LOAD):
        part.AddNodalSolutionStepVariable(variable)
    part.SetBufferSize(2)
    nodes = [part.CreateNewNode(i + 1, *place) for i, place in enumerate(p.x.tolist())]
    kinds = _kinds(p)
    for number, values in enumerate(np.unique(kinds, axis=0).tolist()):
        own = part.CreateNewProperties(number + 1)
        for variable, value in zip((core.YOUNG_MODULUS, structural.TRUSS_PRESTRESS_PK2), values, strict=True):
            own.SetValue(variable, value)
        own.SetValue(structural.CROSS_AREA, 1.0)
        own.SetValue(core.DENSITY, 0.0)
        own.SetValue(core.CONSTITUTIVE_LAW, structural.TrussConstitutiveLaw())
    which = np.unique(kinds, axis=0, return_inverse=True)[1].ravel()
    for e, ((a, b), kind) in enumerate(zip(p.springs.tolist(), which.tolist(), strict=True)):
        part.CreateNewElement("TrussElement3D2N", e + 1, [a + 1, b + 1], part.GetProperties()[kind + 1])
    for axis in "XYZ":
        one, other = (core.KratosGlobals.GetVariable(f"{name}_{axis}") for name in ("DISPLACEMENT", "REACTION"))
        core.VariableUtils().AddDof(one, other, part)
        for i in p.fixed.tolist():
            nodes[i].Fix(one)
    for node, load in zip(nodes, p.load.tolist(), strict=True):
        part.CreateNewCondition("PointLoadCondition3D1N", node.Id, [node.Id], part.GetProperties()[1])
        node.SetSolutionStepValue(structural.POINT_LOAD, load)
    return part


def _kinds(p: Problem) -> Floats:
    """The stiffness k L and the prestress k (L - L0) of each spring, rounded so that equal ones are of one kind."""
    length = np.linalg.norm(p.x[p.springs[:, 1]] - p.x[p.springs[:, 0]], axis=1)
    return np.round(np.column_stack([p.k * length, p.k * (length - p.l0)]), 9)
