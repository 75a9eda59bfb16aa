"""One list of what a result says of itself: headers, document text and comments follow from it."""

from __future__ import annotations

import dataclasses
import math

import pytest

from hookean import Scene, relax
from hookean.running import claims
from hookean.running.claims import CLAIMS, Claim, document_text
from hookean.running.result import Result
from serving import CABLE


@pytest.fixture(scope="module")
def result() -> Result:
    return relax(Scene.read(CABLE))


def test_claims_are_fields_of_results_with_their_units(result: Result) -> None:
    fields = {field.name for field in dataclasses.fields(Result)}
    assert {claim.field for claim in CLAIMS} <= fields and len({claim.field for claim in CLAIMS}) == len(CLAIMS)
    said = claims.claims(result)
    assert said["status"] == "converged" and said["message"] == result.message
    assert said["out_of_balance"] == f"{result.out_of_balance:.9g} N" and said["time"] == "0 s"
    assert float(said["residual"]) == pytest.approx(result.residual, rel=1e-8)


def test_another_claim_is_one_line(result: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever a field holds: a number, a list of tables, nothing."""
    monkeypatch.setattr(claims, "CLAIMS", (Claim("energy", "", "By kind"), Claim("residual", "length", "A length")))
    changed = dataclasses.replace(result, energy={"total": 1.5}, residual=0.25)
    assert claims.claims(changed) == {"energy": '{"total": 1.5}', "residual": "0.25 m"}
    assert "residual" not in claims.claims(dataclasses.replace(result, residual=math.inf))


def test_text_of_documents_is_clean_and_bounded(result: Result) -> None:
    """No null characters, no halves of surrogate pairs, no more than a hundred warnings, none twice."""
    odd = dataclasses.replace(result, message="a\0b \ud800 c", solver="")
    found = document_text(odd, ["same", "same", *(f"{i}" for i in range(200))])
    assert found["hookean:message"] == "ab ? c" and "hookean:solver" not in found
    lines = found["hookean:warnings"].split("\n")
    assert lines[:2] == ["same", "0"] and lines[-1] == "and 101 more warnings" and len(lines) == 101
    assert "hookean:warnings" not in document_text(result)
