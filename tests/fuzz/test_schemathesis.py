"""Every operation of the API's description, called with what fits its schemas and what does not: no answer that is
not described, none that does not fit its schema, none that says the service failed, none without the credentials that
are described; and in the order that its links lead, from what makes a session or a job to all that is done with it.

In `make test` three of 300 cases of every third operation and 5 of 200 runs along links, all in `make soak`.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from copy import deepcopy
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from hookean_server.problems import CATALOGUE
from server.conftest import Served
from serving import CABLE, HANG, app
from soak import SOAK, sampled

CASES = 300 if SOAK else 3
RUNS, STEPS = (200, 20) if SOAK else (5, 10)
LABELS = sorted(f"{method.upper()} {path}" for path, item in app().openapi()["paths"].items() for method in item)
MAKING = {"POST /v1/sessions": CABLE, "PUT /v1/sessions/{key}": CABLE, "POST /v1/jobs": {"scene": CABLE}}
CHECKS = (
    "status_code_conformance",
    "content_type_conformance",
    "response_schema_conformance",
    "response_headers_conformance",
    "negative_data_rejection",
    "ignored_auth",
)
CONFIG = {
    "checks": {"negative_data_rejection": {"expected-statuses": ["4xx", "5xx"]}},  # 412 comes before 422
    "phases": {"stateful": {"inference": {"algorithms": []}}},  # only the links of the description
}
KNOWN = {"key": ("a", "b", "c"), "slug": tuple(CATALOGUE)}
ENDING = ("/v1/shutdown", "/v1/token")
"""Whoever is let in there ends the service, or what lets the others in."""


@pytest.fixture(scope="module")
def running() -> Iterator[Served]:
    found = Served(solve_seconds=2.0, file_seconds=10.0, grace_seconds=3.0, sessions=12, awake=4)
    yield found.ready()
    assert found.end()[0] == 0


@pytest.fixture(scope="module")
def operations(running: Served) -> dict[str, Any]:
    """Of the service's own description: the name of its cookie has its port."""
    import schemathesis  # takes as long as collecting a tenth of all tests, which each process does
    from schemathesis.config import SchemathesisConfig

    config = SchemathesisConfig.from_dict(CONFIG)
    schema = schemathesis.openapi.from_dict(running.client.get("/v1/openapi.json").json(), config=config)
    return {operation.label: operation for found in schema.get_all_operations() if (operation := found.ok())}


@pytest.mark.thinned
@pytest.mark.parametrize("label", sampled(LABELS, 3))
def test_every_answer_is_described(label: str, running: Served, operations: dict[str, Any]) -> None:
    from schemathesis import GenerationMode
    from schemathesis.core.parameters import ParameterLocation

    operation, seen = operations[label], set()
    modes = [GenerationMode.POSITIVE, GenerationMode.NEGATIVE]
    cases = st.one_of(*(operation.as_strategy(generation_mode=mode) for mode in modes))

    @_settings(CASES)
    @given(case=cases, data=st.data())
    def call(case: Any, data: st.DataObject) -> None:
        known = {} if case.meta.is_negative_at(ParameterLocation.PATH) else KNOWN
        for name, values in known.items():
            if name in (case.path_parameters or {}) and data.draw(st.booleans()):
                case.path_parameters[name] = value = data.draw(st.sampled_from(values))
                if name == "key":
                    _made(running, value)
        seen.add(_called(case, running))

    call()
    assert seen
    assert running.process.poll() is None


def _settings(count: int) -> settings:
    return settings(
        max_examples=count,
        deadline=None,
        database=None,
        derandomize=not SOAK,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
    )


def _given(case: Any, running: Served) -> dict[str, Any]:
    """What a case is sent with."""
    headers = {} if case.operation.path in ENDING else {"Authorization": f"Bearer {running.token}"}
    return {"base_url": running.url, "timeout": HANG, "headers": headers}


def _check(name: str) -> Any:
    """A check of schemathesis."""
    from schemathesis.specs.openapi import checks

    return getattr(checks, name)


def _called(case: Any, running: Served, *more: str) -> int:
    """The status of the answer to a case, checked."""
    answer = case.call(**_given(case, running))
    _checked(case, answer, running, more)
    return int(answer.status_code)


def _settled(case: Any, running: Served) -> Any:
    """An answer that does not depend on what else the machine does: hypothesis takes the same steps again, and what
    follows from an answer may not differ then."""
    for _ in range(20):
        if (answer := case.call(**_given(case, running))).status_code not in (503, 504):
            break
        time.sleep(0.05)
    if case.operation.label == "POST /v1/jobs" and answer.status_code == 202:
        job = f"/v1/jobs/{answer.json()['id']}"
        while running.client.get(job).json()["status"] in ("waiting", "running", "cancelling"):
            time.sleep(0.01)
    return answer


def _checked(case: Any, answer: Any, running: Served, more: Iterable[str], recorder: Any = None) -> None:
    failed = answer.status_code >= 500 and answer.status_code not in (503, 504, 507)
    assert not failed, (answer.content[:500], running.log()[-5000:])
    given = _given(case, running)
    chosen = [_check(name) for name in (*CHECKS, *more)]
    case.validate_response(answer, chosen, headers=given["headers"], transport_kwargs=given, recorder=recorder)
    assert b"Traceback" not in answer.content and b"site-packages" not in answer.content


def _made(running: Served, key: str) -> None:
    if running.client.get(f"/v1/sessions/{key}").status_code == 404:
        for listed in running.client.get("/v1/sessions").json()["sessions"][8:]:
            running.client.delete(f"/v1/sessions/{listed['key']}")
        running.client.put(f"/v1/sessions/{key}", json=CABLE)


@pytest.mark.thinned
@pytest.mark.parametrize("label", [pytest.param(s, marks=[] if "}/" in s else [pytest.mark.soak]) for s in LABELS])
def test_values_at_their_limits_and_other_methods_are_described(
    label: str, running: Served, operations: dict[str, Any]
) -> None:
    """Every value that schemathesis derives from a schema: at each limit, beyond it, left out, of another type."""
    from schemathesis import GenerationMode

    operation, modes = operations[label], [GenerationMode.POSITIVE, GenerationMode.NEGATIVE]
    chosen = operation.schema.config.generation_for(operation=operation, phase="coverage")
    cases = operation.schema.iter_coverage_cases(operation, generation_modes=modes, generation_config=chosen)
    # no `missing_required_header`: no operation requires one
    assert [_called(case, running, "unsupported_method") for case in cases]


@pytest.mark.soak
def test_what_was_made_is_there_until_it_is_deleted(running: Served, operations: dict[str, Any]) -> None:
    """Along the links of the description, from an answer that made something to the operations on it."""
    seen: set[tuple[str, int]] = set()

    class Linked(operations["POST /v1/sessions"].schema.as_state_machine()):  # type: ignore[misc]
        def setup(self) -> None:
            self.keys: set[str] = set()

        def before_call(self, case: Any) -> None:
            if (body := MAKING.get(case.operation.label)) is not None:  # the tests above send what makes nothing
                case.body, case.media_type = deepcopy(body), "application/json"
            for name in ("if-match", "if-none-match"):  # of a machine of their own
                case.headers.pop(name, None)

        def call(self, case: Any, **_: Any) -> Any:
            return _settled(case, running)

        def validate_response(self, response: Any, case: Any, *_: Any, **__: Any) -> None:
            # a job that was cancelled can still be read
            more = [] if case.operation.path.startswith("/v1/jobs") else ["use_after_free"]
            more.append("ensure_resource_availability")
            _checked(case, response, running, more, self.recorder)
            label, status = case.operation.label, response.status_code
            seen.add((label, status))
            if status == 201:
                self.keys.add(response.json()["key"])
            elif label == "DELETE /v1/sessions/{key}" and status == 204:
                self.keys.remove(case.path_parameters["key"])

        def teardown(self) -> None:
            found = {listed["key"] for listed in running.client.get("/v1/sessions").json()["sessions"]}
            for key in found:
                running.client.delete(f"/v1/sessions/{key}")
            assert found == self.keys

    for listed in running.client.get("/v1/sessions").json()["sessions"]:
        running.client.delete(f"/v1/sessions/{listed['key']}")
    Linked.run(settings=settings(_settings(RUNS), stateful_step_count=STEPS, phases=[Phase.generate]))
    assert ("POST /v1/sessions", 201) in seen
    if SOAK:  # but for the item of a job, whose number is drawn
        linked = {s for s in LABELS if s.partition(" ")[2].startswith(("/v1/sessions/{", "/v1/jobs/{"))}
        assert {label for label, status in seen if status < 300} >= linked - {"GET /v1/jobs/{job}/results/{number}"}
