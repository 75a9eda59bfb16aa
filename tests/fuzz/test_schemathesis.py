"""Every operation of the API's description, called with what fits its schemas and what does not: no answer that is
not described, none that does not fit its schema, none that says the service failed.

Five of 300 cases an operation in `make test`, all in `make soak`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from schemathesis import GenerationMode
from schemathesis.specs.openapi import checks

from hookean_server.app import create_app
from hookean_server.problems import CATALOGUE
from server.conftest import Served
from serving import CABLE, HANG, SOAK

CASES = 300 if SOAK else 5
SCHEMA = schemathesis.openapi.from_dict(create_app().openapi())
OPERATIONS = {operation.label: operation for found in SCHEMA.get_all_operations() if (operation := found.ok())}
CHECKS = [
    checks.status_code_conformance,
    checks.content_type_conformance,
    checks.response_schema_conformance,
    checks.response_headers_conformance,
]
KNOWN = {"key": ("a", "b", "c"), "slug": tuple(CATALOGUE)}


@pytest.fixture(scope="module")
def running() -> Iterator[Served]:
    found = Served(solve_seconds=2.0, file_seconds=10.0, grace_seconds=3.0, sessions=12, awake=4)
    yield found.ready()
    assert found.end()[0] == 0


@pytest.mark.parametrize("label", sorted(OPERATIONS))
def test_every_answer_is_described(label: str, running: Served) -> None:
    operation, seen = OPERATIONS[label], set()
    modes = [GenerationMode.POSITIVE, GenerationMode.NEGATIVE]
    cases = st.one_of(*(operation.as_strategy(generation_mode=mode) for mode in modes))

    @settings(
        max_examples=CASES,
        deadline=None,
        database=None,
        derandomize=not SOAK,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=cases, data=st.data())
    def call(case: Any, data: st.DataObject) -> None:
        for name, values in KNOWN.items():
            if name in (case.path_parameters or {}) and data.draw(st.booleans()):
                case.path_parameters[name] = value = data.draw(st.sampled_from(values))
                if name == "key":
                    _made(running, value)
        # whoever is let in ends the service, or what lets the others in
        headers = {} if operation.path in ("/v1/shutdown", "/v1/token") else dict(running.known)
        answer = case.call(base_url=running.url, headers=headers, timeout=HANG)
        failed = answer.status_code >= 500 and answer.status_code not in (503, 504, 507)
        assert not failed, (answer.content[:500], running.log()[-5000:])
        case.validate_response(answer, checks=CHECKS)
        assert b"Traceback" not in answer.content and b"site-packages" not in answer.content
        seen.add(answer.status_code)

    call()
    assert seen
    assert running.process.poll() is None


def _made(running: Served, key: str) -> None:
    if running.client.get(f"/v1/sessions/{key}").status_code == 404:
        for listed in running.client.get("/v1/sessions").json()["sessions"][8:]:
            running.client.delete(f"/v1/sessions/{listed['key']}")
        running.client.put(f"/v1/sessions/{key}", json=CABLE)
