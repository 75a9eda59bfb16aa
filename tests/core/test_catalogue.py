"""The catalogue says of every force what its class says, and its examples run."""

from __future__ import annotations

import json
import warnings
from typing import Any

import numpy as np
import pytest

from hookean.forces import KINDS
from hookean.scene import catalogue
from hookean.scene.scene import Scene

ENTRIES = {e["kind"]: e for e in catalogue.catalogue()}


def test_every_force_is_listed_once() -> None:
    assert list(ENTRIES) == list(KINDS)


@pytest.mark.parametrize("kind", KINDS)
def test_an_entry_says_what_the_class_says(kind: str) -> None:
    found, cls = ENTRIES[kind], KINDS[kind]
    assert found["formula"] == cls.formula and found["formula"]
    assert found["role"] == cls.role
    assert found["summary"].endswith(".") and found["summary"] in found["description"]
    assert found["title"]
    assert {f["name"] for f in found["fields"]} == set(cls.model_fields) - {"kind"}
    assert {o["name"] for o in found["outputs"]} == set(cls.outputs)
    assert all(o["unit"] for o in found["outputs"])
    assert set(found["places"]) <= {f["name"] for f in found["fields"]}
    for field in found["fields"]:
        assert field["description"] and field["unit"] and field["type"] != "object", field
        assert field["required"] == cls.model_fields[field["name"]].is_required()
    json.dumps(found, allow_nan=False)


def test_a_vector_that_is_not_along_x_y_and_z_names_its_components() -> None:
    fields = {f["name"]: f for f in ENTRIES["membrane"]["fields"]}
    assert fields["prestress"]["components"] == ["warp", "weft", "shear"]
    assert "components" not in {f["name"]: f for f in ENTRIES["unary"]["fields"]}["vector"]


def test_the_fields_of_springs() -> None:
    fields = {f["name"]: f for f in ENTRIES["springs"]["fields"]}
    assert fields["stiffness"] == {
        "name": "stiffness",
        "description": "k [force/length]",
        "unit": "force/length",
        "type": "numbers",
        "required": False,
        "default": 1000.0,
        "bounds": {"minimum": 0},
    }
    assert fields["lines"]["type"] == "lines" and fields["lines"]["unit"] == "length"
    assert fields["particles"]["type"] == "indices"
    assert fields["edges"]["choices"] == [
        "all",
        "warp",
        "weft",
        "naked",
        "diagonals",
        "diagonals_one",
        "diagonals_other",
    ]
    vector = {f["name"]: f for f in ENTRIES["unary"]["fields"]}["vector"]
    assert vector["required"] and vector["unit"] == "force" and vector["type"] == "vectors"
    assert {f["name"]: f for f in ENTRIES["floor"]["fields"]}["point"]["type"] == "vector"
    assert {f["name"]: f for f in ENTRIES["bend"]["fields"]}["points"]["type"] == "rows of points"


@pytest.mark.parametrize("kind", KINDS)
def test_bounds_are_the_ones_the_class_holds(kind: str) -> None:
    """One step outside every bound is refused; the bound itself is not refused for its own sake."""
    for field in ENTRIES[kind]["fields"]:
        for said, value in field.get("bounds", {}).items():
            outside = value if said in ("more_than", "less_than") else value + (-1 if said == "minimum" else 1)
            if abs(value) >= 1e12:
                continue
            force = {**(ENTRIES[kind]["example"] or {"kind": kind}), field["name"]: outside}
            with pytest.raises(ValueError, match=field["name"]):
                KINDS[kind].model_validate(force)


@pytest.mark.parametrize("kind", [k for k, e in ENTRIES.items() if e["example"]])
def test_examples_are_forces(kind: str) -> None:
    force = KINDS[kind].model_validate(ENTRIES[kind]["example"])
    given, _ = KINDS[kind].example()
    assert force.model_dump_json() == given.model_dump_json()


def test_the_schema_has_every_default_and_tells_forces_by_kind() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        schema = catalogue.schema()
    assert schema["properties"]["particles"]["default"] == []
    assert schema["properties"]["forces"]["items"]["discriminator"]["propertyName"] == "kind"
    assert set(schema["properties"]["forces"]["items"]["discriminator"]["mapping"]) == set(KINDS)
    json.dumps(schema, allow_nan=False)


@pytest.mark.slow
def test_the_schema_agrees_with_the_scene() -> None:
    import jsonschema

    schema = catalogue.schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    good: dict[str, Any] = {
        "particles": [[0, 0, 0], [1, 0, 0]],
        "forces": [
            {"kind": "springs", "particles": [[0, 1]]},
            {"kind": "unary", "particles": [1], "vector": [0, 0, 1]},
        ],
        "anchors": [{"particles": [0]}],
    }
    Scene.read(good)
    validator.validate(good)
    for bad in (
        {**good, "particles": [[0, 0]]},
        {**good, "forces": [{"kind": "spring"}]},
        {**good, "settings": {"tolerance": -1}},
        {**good, "anchor": []},
    ):
        assert not validator.is_valid(bad)
        with pytest.raises(ValueError):
            Scene.read(bad)


def test_markdown_has_a_row_and_a_table_for_every_force() -> None:
    text = catalogue.markdown()
    for kind, cls in KINDS.items():
        assert f"| [`{kind}`](#{kind}) |" in text
        part = text.split(f"\n## {kind}\n")[1].split("\n## ")[0]
        for name in set(cls.model_fields) - {"kind"}:
            assert f"| `{name}` |" in part
    tables = [line for line in text.splitlines() if line.startswith("|")]
    assert all(line.replace("\\|", "").count("|") in (5, 6) for line in tables)
    assert not np.any(["None" in line for line in tables])


def test_the_command_prints_one_force_or_a_scene_with_it() -> None:
    """The scene is that of the catalogue, which `hookean relax` takes; a kind that is not there is a sentence."""
    from typer.testing import CliRunner

    from hookean.cli import app

    def run(*arguments: str) -> Any:
        return CliRunner().invoke(app, ["forces", *arguments])

    assert run("wind").stdout.startswith("wind  ") and "\n\n" not in run("wind").stdout.strip()
    assert json.loads(run("wind", "--scene").stdout) == ENTRIES["wind"]["scene"]
    assert "unknown kind of force 'wnd'; did you mean wind?" in run("wnd").stderr and run("wnd").exit_code == 2
    assert "hookean forces springs --scene" in run("--scene").stderr
