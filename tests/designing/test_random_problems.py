"""Random design problems: what an answer says of itself is true by code of its own."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import hookean
from hookean.designing.answer import Design

from .random_problems import TWISTS, case_of
from .rechecked import Check, faults

SEEDED = {"derandomize": True, "deadline": None, "database": None, "suppress_health_check": list(HealthCheck)}


def checked(seed: int, twist: str) -> Design:
    """The answer to a problem, of which everything has to be true."""
    case = case_of(seed, twist)
    found = hookean.design(case.problem())
    said = faults(Check(case, found), seed)
    assert not said, (seed, twist, str(found.status), said)
    assert found.message.endswith(".") and "nan" not in found.message
    return found


@pytest.mark.slow
@settings(max_examples=8, **SEEDED)
@given(seed=st.integers(0, 10**6), twist=st.sampled_from(TWISTS))
def test_what_an_answer_says_is_true(seed: int, twist: str) -> None:
    """Values, limits and objective of a net at rest by Newton's method on its energy; at a minimum no search by SciPy
    with differences finds better (1e-6); what is infeasible no search by least squares meets; what has no end goes on
    falling; what ends early is no worse than the start."""
    checked(seed, twist)


@pytest.mark.soak
@settings(max_examples=200, **SEEDED)
@given(seed=st.integers(0, 10**6), twist=st.sampled_from(TWISTS))
def test_what_two_hundred_answers_say_is_true(seed: int, twist: str) -> None:
    checked(seed, twist)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("twist", "status"), [("contradictory", "infeasible"), ("infeasible", "infeasible"), ("unbounded", "unbounded")]
)
def test_what_has_no_answer_is_reported(twist: str, status: str) -> None:
    """A height both above and below, one far beyond the net, and a load without a bound that a goal lowers."""
    assert checked(1, twist).status == status


@pytest.mark.soak
@pytest.mark.parametrize(("seed", "twist"), [(619, "scaled"), (362, "plain"), (8153, "contradictory"), (160, "plain")])
def test_answers_in_narrow_valleys_and_far_from_the_start_are_true(seed: int, twist: str) -> None:
    """Where slopes of goals nearly cancel on a long way down, where a stiffness grows to thousands of its size, where
    what is left of a goal is rounding, and at the edge of a snap, where slopes are steep and no step leads on."""
    checked(seed, twist)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [41, 59])
def test_the_last_digits_are_found(seed: int) -> None:
    """Badly scaled problems at whose end first derivatives lead on slowly: the least objective is a part of 1e-8 near,
    by SciPy from there."""
    case = case_of(seed, "scaled")
    found = hookean.design(case.problem())
    check = Check(case, found)
    assert found.status == "converged" and found.objective <= check.better()[0] * (1.0 + 1e-8)


@pytest.mark.soak
def test_a_search_that_is_at_no_minimum_does_not_say_converged() -> None:
    """Near a snap of a net, where a change of 1e-6 of the rest lengths moves it by 1e-4, line searches lead too far:
    the end is lower than that of L-BFGS-B alone, 1.3528e8, and converged at a minimum only."""
    case = case_of(132, "scaled")
    found = hookean.design(case.problem())
    assert found.objective < 1.352e8
    assert found.status != "converged" or Check(case, found).left() < 1e-4


@pytest.mark.soak
@pytest.mark.parametrize("twist", ["plain", "scaled"])
def test_goals_that_conflict_much_do_not_end_early(twist: str) -> None:
    """Where much of every goal is left, least squares go on slowly: the end is that of L-BFGS-B from the start, which
    takes some more iterations than the usual limit."""
    case = case_of(112, twist)
    found, other = hookean.design(case.problem()), hookean.design(case.problem(method="l-bfgs-b", max_iterations=400))
    assert (found.status, other.status) == ("converged", "converged")
    assert found.objective <= other.objective * (1.0 + 1e-5)


@pytest.mark.soak
def test_the_last_digits_along_a_limit_are_found() -> None:
    """A curved valley along a curved limit: SciPy ends at 98.83399, 2e-4 lower than where slopes are first slight."""
    found = hookean.design(case_of(140, "scaled").problem())
    assert found.status == "converged" and found.objective < 98.8341
