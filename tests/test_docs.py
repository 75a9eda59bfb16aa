"""The docs that come from the classes are what the classes say."""

from __future__ import annotations

import re
from pathlib import Path

import hookean
from hookean.scene.catalogue import exports, page

ROOT = Path(__file__).parents[1]


def test_the_page_of_forces_is_the_catalogue():
    """docs/forces.md is what `make docs` would write now."""
    same = (ROOT / "docs" / "forces.md").read_text(encoding="utf-8") == page()
    assert same, "docs/forces.md is not what the classes say: run make docs"


def test_every_force_is_exported():
    """`hookean/__init__.py` is what `make docs` would write now, without forces that are gone, and all is there."""
    text = Path(hookean.__file__).read_text(encoding="utf-8")
    assert exports(text) == text, "hookean/__init__.py does not export the forces there are: run make docs"
    gone = text.replace("import Unary as Unary", "import Gone as Gone").replace('"Unary"', '"Gone"')
    assert exports(gone) == text
    assert {getattr(hookean, name).__name__ for name in hookean.__all__} >= set(hookean.__all__) - {"Anchors"}
    assert hookean.Anchors is hookean.Anchor


def test_the_recipe_and_the_limits_of_the_docs_are_read():
    """The TOML blocks of docs/rhino-files.md parse as a recipe and as limits."""
    from hookean.files.limits import read_limits
    from hookean.scene.text import parse_tables

    recipe, limits = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "rhino-files.md").read_text("utf-8"), re.S)
    assert parse_tables(recipe)["forces"][0]["lines"] == "layer:cables"
    assert read_limits(limits, "limits.toml")


SCENE = (ROOT / "docs" / "scene.md").read_text(encoding="utf-8")


def test_the_blocks_of_the_page_of_the_scene_run(tmp_path, monkeypatch, capsys):
    """The JSON of docs/scene.md is a scene that relaxes, its Python runs from top to bottom."""
    from hookean import Scene, relax

    (text,) = re.findall(r"```json\n(.*?)```", SCENE, re.S)
    assert relax(Scene.read(text)).converged
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for code in re.findall(r"```python\n(.*?)```", SCENE, re.S):
        exec(compile(code, "docs/scene.md", "exec"), names)
    said = capsys.readouterr().out
    assert said.startswith("converged In equilibrium")
    [sentence] = re.findall(r"`/forces/0/stifness: ([^`]*)`", SCENE)
    assert sentence in said


def test_the_page_of_the_scene_names_everything():
    """Every field of scene, anchor, geometry, settings, patch and result, every solver and status, every route."""
    from dataclasses import fields

    from hookean import Patch, Result, Scene, Status
    from hookean.scene.scene import Anchor, Geometry, MeshData, Settings
    from hookean.scene.solver_names import SOLVERS
    from hookean_server.app import create_app
    from hookean_server.settings import Settings as ServerSettings

    wanted = {n for model in (Scene, Anchor, Geometry, MeshData, Settings, Patch) for n in model.model_fields}
    wanted |= {f.name for f in fields(Result)} | set(SOLVERS) | {str(s) for s in Status}
    missing = sorted(name for name in wanted if f"`{name}`" not in SCENE)
    assert not missing, f"docs/scene.md does not tell of {', '.join(missing)}"
    for name, field in Settings.model_fields.items():
        told = re.search(rf"^\| `{name}` \| ([^ |]+)", SCENE, re.M)
        shown = f"{field.default}".replace("1e-06", "1e-6").removesuffix(".0")
        assert told and told[1] == {"None": "none", "False": "false", "True": "true"}.get(shown, shown)
    routes = set(create_app(ServerSettings()).openapi()["paths"])
    for route in re.findall(r"`(?:GET|POST) (/v1[^`]*)`", SCENE):
        assert route in routes | {"/v1/openapi.json", "/v1/discretize/{operation}"}, route


def test_the_pages_of_physics_and_solvers_describe_what_is_there():
    """docs/solvers.md has a row for every solver; neither it nor docs/physics.md has one of any that is not there."""
    from hookean.forces import KINDS
    from hookean.scene.solver_names import SOLVERS

    physics = (ROOT / "docs" / "physics.md").read_text("utf-8")
    rows = {name for row in re.findall(r"^\| (`.*?) \|", physics, re.M) for name in re.findall(r"`(\w+)`", row)}
    assert rows <= set(KINDS)
    rows = set(re.findall(r"^\| .*? \| `(\w+)` \|", (ROOT / "docs" / "solvers.md").read_text("utf-8"), re.M))
    assert rows == set(SOLVERS)


def test_what_kangaroo_users_are_sent_to_exists():
    """Every name in the second column of docs/from-kangaroo.md names something of hookean."""
    import hookean
    import hookean.discretize
    from hookean.forces import KINDS
    from hookean.scene.scene import Scene
    from hookean.scene.scene import Settings as SceneSettings
    from hookean.scene.solver_names import SOLVERS

    text = (ROOT / "docs" / "from-kangaroo.md").read_text("utf-8")
    columns = [row.split("|")[2] for row in text.splitlines() if row.startswith("|")]
    named = {name for column in columns for name in re.findall(r"`([^`]+)`", column)}
    fields = {field for cls in KINDS.values() for field in cls.model_fields}
    known = {*KINDS, *fields, *SOLVERS, *Scene.model_fields, *SceneSettings.model_fields, *hookean.__all__}
    known |= set(hookean.discretize.__all__)
    known |= {"axes", "lines", "mesh", "move", "pin", "release", "patch", "discretize", "hookean relax"}
    known |= {"corners:", "naked:", 'edges = "warp"', "rest_factor = 0", "settings.floor"}
    assert named <= known, named - known
