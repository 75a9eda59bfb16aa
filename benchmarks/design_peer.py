"""One design problem by jax_fdm, in a Python that has it: `python design_peer.py NAME` prints densities and seconds."""

from __future__ import annotations

import json
import sys
import time
from typing import Any

import jax
import numpy as np

jax.config.update("jax_enable_x64", True)

import jax_fdm.goals as g  # noqa: E402
from design_problems import PROBLEMS, Problem  # noqa: E402
from jax_fdm import losses, optimization  # noqa: E402
from jax_fdm.constraints import EdgeLengthConstraint  # noqa: E402
from jax_fdm.datastructures import FDNetwork  # noqa: E402
from jax_fdm.equilibrium import constrained_fdm  # noqa: E402
from jax_fdm.parameters import EdgeForceDensityParameter  # noqa: E402

KINDS = {"z": "NodeZCoordinateGoal", "point": "NodePointGoal", "plane": "NodePlaneGoal", "length": "EdgeLengthGoal",
         "force": "EdgeForceGoal", "direction": "EdgeDirectionGoal", "reaction": "NodeResidualForceGoal"}  # fmt: skip


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
        goals = [g.NetworkLoadPathGoal()] if kind == "load_path" else []
        for i, wanted in zip(which, target, strict=True) if target is not None else ():
            key = edges[i] if kind in ("length", "force", "direction") else int(i)
            aim = ([float(wanted), 0.0, 0.0], [1.0, 0.0, 0.0]) if kind == "plane" else wanted
            goals.append(getattr(g, KINDS[kind])(key, target=aim if kind == "plane" else aim.tolist()))
        terms.append(getattr(losses, p.loss)(goals, alpha=weight, name=kind))
    bounds = [end if np.isfinite(end) else None for end in p.bounds]
    return net, losses.Loss(*terms), [EdgeForceDensityParameter(e, *bounds) for e in edges]


def main(name: str) -> None:
    """Solve twice."""
    p = PROBLEMS[name]()
    net, loss, parameters = given(p)
    constraints = [EdgeLengthConstraint(tuple(map(int, e)), *p.lengths) for e in p.edges] if p.lengths else []
    seconds = []
    for _ in range(2):
        start = time.process_time()
        found = constrained_fdm(net, optimizer=getattr(optimization, p.optimizer)(), loss=loss, parameters=parameters,
                                constraints=constraints,
                                maxiter=p.most, tol=p.tolerance, sparse=len(p.points) > 500)  # fmt: skip
        seconds.append(time.process_time() - start)
    q = [float(found.edge_forcedensity(tuple(map(int, e)))) for e in p.edges]
    print("ANSWER" + json.dumps({"q": q, "seconds": seconds}))


if __name__ == "__main__":
    main(sys.argv[1])
