"""The description is valid, complete and true: its examples run and answers fit its schemas."""

from __future__ import annotations

import json
from typing import Any

import httpx
import jsonschema
import pytest
from fastapi.openapi.models import OpenAPI

from hookean.forces import KINDS
from hookean_server.problems import CATALOGUE
from serving import CABLE, app
from soak import sampled

DOCUMENT: dict[str, Any] = json.loads(json.dumps(app().openapi()))
OPERATIONS = [(path, method, o) for path, item in DOCUMENT["paths"].items() for method, o in item.items()]
EXAMPLES = [
    (path, name, example["value"])
    for path, _, o in OPERATIONS
    for name, example in o.get("requestBody", {})
    .get("content", {})
    .get("application/json", {})
    .get("examples", {})
    .items()
]


def validator(schema: dict[str, Any]) -> jsonschema.Draft202012Validator:
    return jsonschema.Draft202012Validator({**schema, "components": DOCUMENT["components"]})


def test_it_is_openapi() -> None:
    assert DOCUMENT["openapi"].startswith("3.1")
    OpenAPI.model_validate(DOCUMENT)
    for schema in DOCUMENT["components"]["schemas"].values():
        jsonschema.Draft202012Validator.check_schema(schema)


def test_every_reference_leads_somewhere() -> None:
    def references(value: Any) -> list[str]:
        if isinstance(value, dict):
            own = [value["$ref"]] if isinstance(value.get("$ref"), str) else []
            mapped = list(value["mapping"].values()) if isinstance(value.get("mapping"), dict) else []
            return own + mapped + [r for v in value.values() for r in references(v)]
        return [r for v in value for r in references(v)] if isinstance(value, list) else []

    found = set(references(DOCUMENT))
    assert found
    for reference in found:
        assert reference.startswith("#/components/schemas/"), reference
        assert reference.rsplit("/", 1)[1] in DOCUMENT["components"]["schemas"], reference


def test_what_makes_something_links_to_every_operation_on_it() -> None:
    """An answer that made something has its name, which the operations on it take (OpenAPI 3.1.1, 4.8.20)."""
    made = {"/v1/sessions/{key}": ("key", "Session"), "/v1/jobs/{job}": ("id", "Job")}
    linking = set()
    for path, method, operation in OPERATIONS:
        for status, response in operation["responses"].items():
            if not (links := response.get("links")):
                continue
            linking.add((method, path, status))
            address = "/v1/jobs/{job}" if path in ("/v1/jobs", "/v1/design") else "/v1/sessions/{key}"
            field, schema = made[address]
            assert response["content"]["application/json"]["schema"] == {"$ref": f"#/components/schemas/{schema}"}
            assert field in DOCUMENT["components"]["schemas"][schema]["required"]
            parameter = address.partition("{")[2].rstrip("}")
            assert [link["parameters"] for link in links.values()] == [
                {f"path.{parameter}": f"$response.body#/{field}"}
            ] * len(links)
            assert {link["operationId"] for link in links.values()} == {
                other["operationId"] for at, _, other in OPERATIONS if at.startswith(address)
            }
    assert linking == {
        ("post", "/v1/sessions", "201"),
        ("put", "/v1/sessions/{key}", "200"),
        ("put", "/v1/sessions/{key}", "201"),
        ("post", "/v1/sessions/{key}/branches", "201"),
        ("post", "/v1/jobs", "202"),
        ("post", "/v1/design", "202"),
    }


def test_what_the_server_gives_is_this(client: httpx.Client) -> None:
    found = client.get("/v1/openapi.json").text.replace(f'"hookean-{client.base_url.port}"', '"hookean-8765"')
    assert json.loads(found) == DOCUMENT, "but for the cookie's name, which has the port"


@pytest.mark.parametrize(("path", "method", "operation"), OPERATIONS)
def test_every_operation_documents_its_problems(path: str, method: str, operation: dict[str, Any]) -> None:
    assert operation["summary"] and operation["operationId"]
    documented = {
        int(s) for s, r in operation["responses"].items() if "application/problem+json" in r.get("content", {})
    }
    possible = {status for status, _, _ in CATALOGUE.values()} - {400}
    if operation["security"] == []:
        possible -= {401}
    if path.startswith(("/v1/sessions", "/v1/jobs", "/v1/design")):
        assert {403, 404, 405, 431, 500} <= documented <= possible, path
        return
    possible -= {409, 412, 429, 507}  # of what is kept
    if method == "get" or path.startswith(("/v1/login", "/v1/token")):  # no body is read
        possible -= {408, 413, 415, 422, 503, 504}
    if operation.get("parameters", [{}])[0].get("in") == "query" and path == "/v1/proof":
        possible |= {422}
    if path == "/v1/examples/{example}/scene":  # read by a worker
        possible |= {503, 504}
    assert documented - {507} == possible, path


def test_forces_are_told_by_their_kind() -> None:
    forces = DOCUMENT["components"]["schemas"]["Scene"]["properties"]["forces"]["items"]
    assert set(forces["discriminator"]["mapping"]) == set(KINDS)


@pytest.mark.parametrize(("path", "name", "example"), sampled(EXAMPLES, 3))
def test_examples_run_and_fit(client: httpx.Client, path: str, name: str, example: Any) -> None:
    if path.startswith("/v1/sessions"):
        pytest.skip("of what is kept: tested with sessions")
    content = DOCUMENT["paths"][path]["post"]
    validator(content["requestBody"]["content"]["application/json"]["schema"]).validate(example)
    known = {parameter["name"] for parameter in content.get("parameters", [])}
    for arrays in ("list", "buffer"):
        params = {name: value for name, value in (("arrays", arrays), ("meshes", "compas")) if name in known}
        answer = client.post(path, json=example, params=params)
        assert answer.status_code == 200, answer.text
        described = content["responses"]["200"]["content"]
        if "application/json" in described and answer.headers["content-type"] == "application/json":
            validator(described["application/json"]["schema"]).validate(answer.json())
        else:
            assert answer.headers["content-type"].partition(";")[0] in described


def test_there_is_an_example_of_relaxing_and_of_most_operations() -> None:
    assert {path for path, _, _ in EXAMPLES} >= {"/v1/relax", "/v1/discretize/divide", "/v1/discretize/edges"}


def test_health_forces_and_problems_fit(client: httpx.Client) -> None:
    for path in ("/v1/health", "/v1/forces", "/v1/examples"):
        schema = DOCUMENT["paths"][path]["get"]["responses"]["200"]["content"]["application/json"]["schema"]
        validator(schema).validate(client.get(path).json())
    validator(DOCUMENT["components"]["schemas"]["Problem"]).validate(client.post("/v1/relax", json=[]).json())
    validator(DOCUMENT["components"]["schemas"]["Scene"]).validate(CABLE)


def test_health_says_who_it_is(client: httpx.Client) -> None:
    import hookean

    found = client.get("/v1/health").json()
    assert (found["service"], found["version"], found["api"], found["status"]) == (
        "hookean",
        hookean.__version__,
        "v1",
        "ok",
    )
    assert len(found["instance"]) == 32


def test_the_catalogue_of_forces(client: httpx.Client) -> None:
    from hookean.scene.catalogue import catalogue

    answer = client.get("/v1/forces")
    assert answer.json()["forces"] == json.loads(json.dumps(catalogue()))
    again = client.get("/v1/forces", headers={"if-none-match": answer.headers["etag"]})
    assert again.status_code == 304 and not again.content


def test_no_page_of_the_framework_is_served(client: httpx.Client) -> None:
    for path in ("/redoc", "/openapi.json", "/docs/oauth2-redirect"):
        assert client.get(path).status_code == 404
