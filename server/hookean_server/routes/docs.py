"""`/docs`: the description of the API as one plain page, without scripts and without anything from elsewhere."""

from __future__ import annotations

import asyncio
import json
from html import escape
from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

router = APIRouter()

HEADERS = {
    "content-security-policy": "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "referrer-policy": "no-referrer",
    "cache-control": "no-cache",
}


@router.get("/docs", include_in_schema=False)
async def docs(request: Request) -> Response:
    """Every operation with its parameters, bodies and answers, as `/v1/openapi.json` has them."""
    page = await asyncio.to_thread(lambda: _page(request.app.openapi()))
    return Response(page, media_type="text/html", headers=HEADERS)


def _page(document: dict[str, Any]) -> str:
    operations = [(path, m, o) for path, item in document["paths"].items() for m, o in item.items()]
    schemas = document["components"]["schemas"]
    return "\n".join(
        [
            '<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>hookean: the service</title>',
            f"<h1>hookean {escape(document['info']['version'])}</h1>",
            f"<p>{escape(document['info']['description'])}</p>",
            '<p>For programs: <a href="/v1/openapi.json">/v1/openapi.json</a>.</p>',
            "<h2>Operations</h2>",
            *(_operation(path, method, operation) for path, method, operation in operations),
            "<h2>Schemas</h2>",
            *(f"<h3><code>{escape(name)}</code></h3>\n{_json(schema)}" for name, schema in schemas.items()),
            "</html>\n",
        ]
    )


def _operation(path: str, method: str, operation: dict[str, Any]) -> str:
    schemes = [name for one in operation["security"] for name in one]
    parts = [
        f"<h3><code>{method.upper()} {escape(path)}</code></h3>",
        f"<p><strong>{escape(operation['summary'])}</strong>. {escape(operation.get('description', ''))}</p>",
        f"<p>Needs: {escape(' or '.join(schemes) or 'nothing')}.</p>",
    ]
    for title in ("parameters", "requestBody", "responses"):
        if operation.get(title):
            parts.append(f"<details><summary>{title}</summary>{_json(operation[title])}</details>")
    return "\n".join(parts)


def _json(value: Any) -> str:
    return f"<pre>{escape(json.dumps(value, indent=2, ensure_ascii=False))}</pre>"
