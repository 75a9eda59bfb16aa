"""Many constraints: the augmented Lagrangian against quadratic programming, and on a net too large for that."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hookean.designing.search import design

from .test_many import recovery

LIMIT = 1.02  # of lengths


def limited(m: int, goals: str, method: str) -> dict[str, Any]:
    """Heights of a net, or its least load path, with no length above a limit."""
    problem, _ = recovery(m)
    if goals == "load path":
        problem["goals"] = [{"kind": "load_path", "force": "net"}]
    constraints = [{"kind": "length", "force": "net", "upper": LIMIT}]
    return {**problem, "constraints": constraints, "settings": {"method": method, "max_iterations": 1000}}


def test_both_methods_find_one_optimum() -> None:
    """Of 12 unknowns and as many constraints, several at their limits: objectives to 1 %, which is where the shifts of
    the limits settle, and constraints to 1e-6."""
    own, other = (design(limited(3, "heights", method)) for method in ("augmented_lagrangian", "slsqp"))
    assert own.status == other.status == "converged"
    assert own.objective == pytest.approx(other.objective, rel=1e-2)
    lengths, gain = np.asarray(own.constraints[0]["value"]), np.asarray(own.constraints[0]["gain"])
    assert lengths.max() <= LIMIT * (1.0 + 1e-6) and np.count_nonzero(lengths > LIMIT - 1e-5) > 1
    assert not gain[lengths < LIMIT - 1e-4].any() and gain.max() > 0.0


@pytest.mark.soak
def test_a_large_net_keeps_its_limits() -> None:
    """364 unknowns and as many constraints: what is found keeps them to 1e-6."""
    found = design(limited(14, "heights", "auto"))
    assert found.method == "augmented_lagrangian" and found.constraints[0]["met"]
    assert np.asarray(found.constraints[0]["value"]).max() <= LIMIT * (1.0 + 1e-6)


def test_the_method_fits_the_problem() -> None:
    """A method without constraints is refused where there are some, and this one where there are none."""
    from hookean.errors import InputError

    problem = limited(4, "heights", "levenberg_marquardt")
    with pytest.raises(InputError, match="takes no constraints"):
        design(problem)
    with pytest.raises(InputError, match="needs constraints"):
        design({**problem, "constraints": [], "settings": {"method": "augmented_lagrangian"}})
