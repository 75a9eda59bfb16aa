"""docs/compas.md: its blocks run from top to bottom against a service, and it names what there is."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from hookean import Scene, relax
from hookean.files import compas_json
from hookean_client import compas
from serving import Home

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "compas.md").read_text(encoding="utf-8")


def test_the_blocks_run_and_the_net_carries_its_load(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Printed forms agree, 81 loads of 0.5 kN arrive at the corners, and the documents are a scene as well."""
    home = Home(tmp_path / "state")
    monkeypatch.setenv("HOOKEAN_STATE", str(home.folder))
    names: dict[str, object] = {}
    try:
        home.serve()
        for code in re.findall(r"```python\n(.*?)```", TEXT, re.S):
            exec(compile(code, "docs/compas.md", "exec"), names)
    finally:
        home.end()
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("converged In equilibrium")
    sags = [float(line.split()[1]) for line in said if line.startswith("sag")]
    assert len(sags) == 2 and sags[0] == pytest.approx(sags[1], abs=1e-9) and sags[0] < -1.0
    found, corners = names["found"], names["corners"]
    total = np.sum([found.vertex_attribute(key, "reaction") for key in corners], axis=0)  # type: ignore[attr-defined]
    assert total == pytest.approx([0, 0, 81 * 0.5], abs=1e-3)
    plain = compas_json.plain_scene(names["hanging"])[0]
    assert relax(Scene.read(plain)).converged


def test_the_page_names_functions_and_attributes_that_exist() -> None:
    named = set(re.findall(r"^\| `(\w+)\(", TEXT, re.M))
    assert named == {"springs", "load", "anchors", "scene", "relaxed"}
    assert all(callable(getattr(compas, name)) for name in (*named, "to_mesh", "to_graph", "document"))
    assert all(f"`{name}`" in TEXT for name in (*compas.SUPPORTS, *compas.LOADS))


def test_the_page_names_every_component_of_the_group() -> None:
    from hookean_canvas.components import bundles

    shipped = {bundles.read(name).name for name in bundles.names() if bundles.read(name).subcategory == "COMPAS"}
    assert shipped and shipped == set(re.findall(r"COMPAS (?:Structure|Springs|Load|Anchors|Relax)", TEXT))
