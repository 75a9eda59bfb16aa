"""docs/service.md: its routes exist, its table of frames is the wire's, its Python runs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hookean_server.app import create_app
from hookean_server.sessions.wire import STATUSES
from hookean_server.settings import Settings
from serving import Home

PAGE = (Path(__file__).parents[2] / "docs" / "service.md").read_text("utf-8")


def test_the_routes_of_the_page_exist():
    routes = set(create_app(Settings()).openapi()["paths"])
    named = {route.partition("?")[0] for route in re.findall(r"(?:GET|POST|PUT|PATCH|DELETE) (/[\w/{}.]*)", PAGE)}
    actions = {f"/v1/sessions/{{key}}/{name}" for name in ("play", "relax", "pause", "step", "reset", "undo", "redo")}
    missing = named - routes - actions - {"/v1/openapi.json"}
    assert len(named) > 6 and not missing, missing
    assert ", ".join(STATUSES) in PAGE


def test_the_client_of_the_page_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    """From top to bottom, against a service that is found by its file."""
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    home = Home(tmp_path)
    monkeypatch.setenv("HOOKEAN_STATE", str(tmp_path))
    monkeypatch.delenv("HOOKEAN_TOKEN", raising=False)
    try:
        home.serve()
        exec(compile(code, "docs/service.md", "exec"), {})
    finally:
        home.end()
    said = capsys.readouterr().out.splitlines()
    assert len(said) == 2 and said[1].startswith(("Running", "In equilibrium"))
