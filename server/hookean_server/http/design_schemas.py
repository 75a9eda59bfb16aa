"""Schemas and examples of design problems, from the models of the core; the tests run every example."""

from __future__ import annotations

from typing import Any

from hookean.designing.problem import Constraint, DesignSettings, Goal, Variable
from hookean.designing.quantities import QUANTITIES
from hookean.scene.catalogue import PlainSchema
from hookean.values.columns import Model

PROBLEM: dict[str, Any] = {
    "scene": {
        "particles": [[-1.0, 0.0, 0.0], [0.0, 0.0, -0.2], [1.0, 0.0, 0.0]],
        "forces": [
            {
                "kind": "springs",
                "name": "string",
                "particles": [[0, 1], [1, 2]],
                "stiffness": 100.0,
                "rest_length": 1.0,
            },
            {"kind": "unary", "name": "load", "particles": [1], "vector": [0.0, 0.0, -5.0]},
        ],
        "anchors": [{"name": "ends", "particles": [0, 2]}],
    },
    "variables": [{"force": "string", "field": "rest_length", "tie": "all", "lower": 0.5, "upper": 2.0}],
    "goals": [{"kind": "position", "particles": [1], "axes": "z", "target": -0.7}],
}
SLOPES = {
    "scene": PROBLEM["scene"],
    "variables": [{"force": "string", "field": "stiffness"}],
    "goals": [{"kind": "position", "particles": [1], "axes": "z"}],
}


def _fields(model: type[Model]) -> dict[str, Any]:
    schema = model.model_json_schema(schema_generator=PlainSchema)
    parts = schema.pop("$defs", {})
    whole: dict[str, Any] = _inlined(schema, parts)
    return whole


def _inlined(value: Any, parts: dict[str, Any]) -> Any:
    """A schema with its parts in the place of references to them."""
    if isinstance(value, dict):
        name = str(value.get("$ref", "")).removeprefix("#/$defs/")
        if name in parts:
            return {**_inlined(parts[name], parts), **{k: v for k, v in value.items() if k != "$ref"}}
        return {key: _inlined(one, parts) for key, one in value.items()}
    return [_inlined(one, parts) for one in value] if isinstance(value, list) else value


def _measured(model: type[Model]) -> dict[str, Any]:
    """A goal or a constraint: the fields of one kind of quantity beside its own."""
    own = _fields(model)["properties"]
    own.pop("quantity")
    kinds = []
    for kind, cls in QUANTITIES.items():
        schema = _fields(cls)
        properties = {**schema["properties"], "kind": {"const": kind}, **own}
        _accept_points(properties)
        required = ["kind", *(name for name in schema.get("required", []) if name not in ("kind", "particles"))]
        kinds.append(
            {"type": "object", "properties": properties, "required": required, "additionalProperties": False,
             "title": kind, "description": schema.get("description", kind), "x-unit": cls.unit}
        )  # fmt: skip
    return {"oneOf": kinds, "description": model.__doc__}


def _accept_points(properties: dict[str, Any]) -> None:
    """Particles may be named by the points where they are drawn."""
    if "particles" in properties:
        properties["points"] = {
            "type": "array",
            "items": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3},
            "description": "Points where the particles are drawn, in the place of their numbers [length]",
        }


def design_schemas() -> dict[str, Any]:
    """The schemas by name."""
    variables = {"type": "array", "items": {"$ref": "#/components/schemas/DesignVariable"}, "minItems": 1}
    goals = {"type": "array", "items": {"$ref": "#/components/schemas/DesignGoal"}}
    parts = {
        "variables": variables,
        "goals": goals,
        "constraints": {"type": "array", "items": {"$ref": "#/components/schemas/DesignConstraint"}},
        "settings": {"$ref": "#/components/schemas/DesignSettings"},
        "start": {
            "type": "array",
            "items": {"type": "number"},
            "description": "Values of all variables in their order to start from; default: those of the scene",
        },
    }
    scene = {"$ref": "#/components/schemas/Scene"}
    kind = {"type": "object", "additionalProperties": False}
    return {
        "DesignVariable": _fields(Variable),
        "DesignGoal": _measured(Goal),
        "DesignConstraint": _measured(Constraint),
        "DesignSettings": _fields(DesignSettings),
        "Design": {
            **kind,
            "properties": parts,
            "required": ["variables"],
            "description": "What varies, and to what end",
        },
        "DesignProblem": {
            **kind,
            "properties": {"scene": scene, **parts},
            "required": ["scene", "variables"],
            "examples": [PROBLEM],
        },
        "SensitivityRequest": {
            **kind,
            "properties": {"scene": scene, "variables": variables, "goals": {**goals, "minItems": 1}},
            "required": ["scene", "variables", "goals"],
        },
        "Sensitivity": {
            "type": "object",
            "properties": {
                "value": {"type": ["number", "null"], "description": "Sum of weight x value of all goals"},
                "gradient": {"type": "array", "description": "Of each variable an array [unit of goal by of variable]"},
                "values": {"type": "array", "description": "Values of each goal"},
                "variables": {"type": "array", "items": {"type": "string"}},
                "warnings": {"type": "array", "items": {"type": "string"}},
            },
            "required": ["value", "gradient", "values", "variables", "warnings"],
        },
    }
