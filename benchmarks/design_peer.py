"""One design problem by jax_fdm, in a Python that has it: `python design_peer.py NAME` prints densities and seconds."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import jax

jax.config.update("jax_enable_x64", True)

import jax_fdm.goals as g  # noqa: E402
from design_problems import PROBLEMS, Problem  # noqa: E402
from jax_fdm import optimization  # noqa: E402
from jax_fdm.datastructures import FDNetwork  # noqa: E402
from jax_fdm.equilibrium import constrained_fdm  # noqa: E402
from jax_fdm.losses import Loss, SquaredError  # noqa: E402
from jax_fdm.parameters import EdgeForceDensityParameter  # noqa: E402

KINDS = {"z": "NodeZCoordinateGoal", "point": "NodePointGoal", "plane": "NodePlaneGoal", "length": "EdgeLengthGoal",
         "force": "EdgeForceGoal", "reaction": "NodeResidualForceGoal"}  # fmt: skip


def given(p: Problem) -> tuple[Any, Any, list[Any]]:
    """The problem as jax_fdm takes it: the net, the loss and the parameters."""
    edges = [tuple(map(int, e)) for e in p.edges]
    net = FDNetwork.from_nodes_and_edges(p.points.tolist(), edges)
    for node in p.supports:
        net.node_support(int(node))
    for node in p.free:
        net.node_load(int(node), p.loads[node].tolist())
    for edge, q in zip(edges, p.start, strict=True):
        net.edge_forcedensity(edge, float(q))
    terms = []
    for kind, which, target, weight in p.goals:
        goals = []
        for i, wanted in zip(which, target, strict=True):
            key = edges[i] if kind in ("length", "force") else int(i)
            aim = ([float(wanted), 0.0, 0.0], [1.0, 0.0, 0.0]) if kind == "plane" else wanted
            goals.append(getattr(g, KINDS[kind])(key, target=aim if kind == "plane" else aim.tolist()))
        terms.append(SquaredError(goals, alpha=weight, name=kind))
    return net, Loss(*terms), [EdgeForceDensityParameter(e, *p.bounds) for e in edges]


def main(name: str) -> None:
    """Solve twice."""
    p = PROBLEMS[name]()
    net, loss, parameters = given(p)
    seconds = []
    for _ in range(2):
        start = time.perf_counter()
        found = constrained_fdm(net, optimizer=getattr(optimization, p.optimizer)(), loss=loss, parameters=parameters,
                                maxiter=p.most, tol=p.tolerance, sparse=len(p.points) > 500)  # fmt: skip
        seconds.append(time.perf_counter() - start)
    q = [float(found.edge_forcedensity(tuple(map(int, e)))) for e in p.edges]
    print("ANSWER" + json.dumps({"q": q, "seconds": seconds}))


if __name__ == "__main__":
    main(sys.argv[1])
