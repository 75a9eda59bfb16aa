"""Schemas and examples of analyses; the tests run every example."""

from __future__ import annotations

from typing import Any

from hookean.values.columns import Model
from hookean_server.http.schemas import EXAMPLES
from hookean_server.workers.analysis_task import ANALYSES
from hookean_server.workers.case_tasks import Cases
from hookean_server.workers.paper_tasks import Export, Report

_NET = EXAMPLES["relax"]["pulled net"]
_TRUSS: dict[str, Any] = {
    "particles": [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.3], [1.0, 0.0, 0.0]],
    "forces": [
        {"kind": "springs", "particles": [[0, 1], [1, 2]], "stiffness": 100.0},
        {"kind": "unary", "name": "load", "particles": [1], "vector": [0.0, 0.0, -1.0]},
    ],
    "anchors": [{"particles": [0, 2]}, {"particles": [1], "axes": "y"}],
}
_CORNERS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.4], [2.0, 0.0, 0.0], [0.0, 1.0, 0.4], [1.0, 1.0, 0.0], [2.0, 1.0, 0.4]]
_ROOF: dict[str, Any] = {
    "particles": _CORNERS,
    "meshes": {"roof": {"vertices": _CORNERS, "faces": [[0, 1, 4, 3], [1, 2, 5, 4]]}},
    "forces": [{"kind": "springs", "name": "net", "mesh": "roof", "stiffness": 5.0, "rest_factor": 0.0}],
    "anchors": [{"particles": [0, 2, 3, 5]}],
}
ANALYSIS_EXAMPLES: dict[str, dict[str, Any]] = {
    "frequencies": {"scene": _NET, "count": 2},
    "buckling": {"scene": _TRUSS, "count": 1, "loads": ["load"]},
    "load-path": {"scene": _TRUSS, "steps": 10},
    "mechanisms": {"scene": _TRUSS},
    "patterns": {"scene": _ROOF, "compensation": [0.01, 0.005], "allowance": 0.05},
    "cables": {"scene": {**_ROOF, "stages": {"freeze": {"net": {"axial_stiffness": 100.0}}}}, "stretch": 0.001},
}
CASES_EXAMPLE = {
    "scene": {
        **_TRUSS,
        "forces": [*_TRUSS["forces"], {"kind": "unary", "name": "dead", "particles": [1], "vector": [0.0, 0.0, -0.1]}],
        "load_cases": {"snow": {"forces": ["load"], "factor": 0.5}},
        "combinations": {"ULS 1": {"permanent": 1.35, "snow": 1.5}},
    }
}
REPORT_EXAMPLE = {**CASES_EXAMPLE, "title": "Truss", "pictures": False}
EXPORT_EXAMPLE = {**CASES_EXAMPLE, "format": "dxf", "case": "ULS 1"}


def report_schema() -> dict[str, Any]:
    """Schema of the body of a report."""
    return _body(Report)


def export_schema() -> dict[str, Any]:
    """Schema of the body of an export."""
    body = _body(Export)
    return {**body, "required": ["scene", "format"]}


def cases_schema() -> tuple[dict[str, Any], dict[str, Any]]:
    """Schemas of the body and the answer of load cases."""
    gives = ("form", "notes", "cases", "envelope", "units")
    return _body(Cases), {"type": "object", "properties": {field: {} for field in gives}, "required": list(gives)}


def _body(options: type[Model]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": {
            "scene": {"$ref": "#/components/schemas/Scene"},
            **options.model_json_schema().get("properties", {}),
        },
        "required": ["scene"],
        "additionalProperties": False,
    }


def analysis_schema(name: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Schemas of the body and the answer of an analysis."""
    analysis = ANALYSES[name]
    gives = {"type": "object", "properties": {field: {} for field in analysis.gives}, "required": list(analysis.gives)}
    return _body(analysis.options), gives
