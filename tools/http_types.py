"""Types of the HTTP API for the pages: ``python -m tools.http_types`` writes them.

`web/shared/http_types.d.ts` has one interface for each record and one entry for each operation of
``openapi.json``. `web/shared/api.js` is written against it, so that ``make web`` finds a page that
uses a field the server does not have.
"""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from recon4_app.main import create_app
from recon4_app.openapi import description
from recon4_app.settings import ServerSettings

TYPES = Path(__file__).parents[1] / "web/shared/http_types.d.ts"
HEAD = "// Generated from the server's OpenAPI description by `make docs`; do not edit.\n"
NAMES = {
    "string": "string",
    "number": "number",
    "integer": "number",
    "boolean": "boolean",
    "null": "null",
}
JSON = "application/json"


def described() -> dict[str, Any]:
    """The OpenAPI description of the server as it is."""
    with tempfile.TemporaryDirectory() as root:
        return description(create_app(ServerSettings(root=Path(root))))


def http_types() -> str:
    """The text of `http_types.d.ts` for the server as it is."""
    api = described()
    schemas = api["components"]["schemas"]
    operations = [
        (f"{method.upper()} {path}", operation)
        for path, methods in api["paths"].items()
        for method, operation in methods.items()
    ]
    bodies = [operation.get("requestBody", {}) for _, operation in operations]
    requests = set(_reachable(bodies, schemas))
    records = [_record(name, one, name in requests) for name, one in sorted(schemas.items())]
    entries = "".join(_operation(name, one) for name, one in sorted(operations))
    return f"{HEAD}\n{''.join(records)}export interface Operations {{\n{entries}}}\n"


def _reachable(part: Any, schemas: dict[str, Any]) -> Iterator[str]:
    """Names of the records a part of the description refers to, directly or through others."""
    waiting, found = [part], set()
    while waiting:
        part = waiting.pop()
        if isinstance(part, list):
            waiting.extend(part)
        elif isinstance(part, dict):
            waiting.extend(part.values())
            name = _name(part)
            if name and name not in found:
                found.add(name)
                waiting.append(schemas[name])
                yield name


def _name(schema: dict[str, Any]) -> str:
    reference = schema.get("$ref", "")
    return reference.rpartition("/")[2] if isinstance(reference, str) else ""


def _record(name: str, schema: dict[str, Any], requested: bool) -> str:
    """A declaration; only a request may leave out a field that has a default."""
    if "properties" not in schema:
        return f"export type {name} = {_type(schema)};\n\n"
    required = schema.get("required", [])
    fields = "".join(
        f"  {field}{'?' if requested and field not in required else ''}: {_type(one)};\n"
        for field, one in schema["properties"].items()
    )
    return f"export interface {name} {{\n{fields}}}\n\n"


def _type(schema: dict[str, Any]) -> str:
    if "$ref" in schema:
        return _name(schema)
    if "anyOf" in schema:
        return " | ".join(dict.fromkeys(_type(one) for one in schema["anyOf"]))
    if "enum" in schema or "const" in schema:
        return " | ".join(json.dumps(one) for one in schema.get("enum", [schema.get("const")]))
    if "prefixItems" in schema:
        return f"[{', '.join(_type(one) for one in schema['prefixItems'])}]"
    if schema.get("type") == "array":
        return f"Array<{_type(schema.get('items', {}))}>"
    if schema.get("type") == "object":
        values = schema.get("additionalProperties", {})
        return f"Record<string, {_type(values) if isinstance(values, dict) else 'any'}>"
    return NAMES.get(schema.get("type", ""), "any")


def _operation(name: str, operation: dict[str, Any]) -> str:
    """Path and query parameters, body and response of an operation."""
    path = [f"{one}: string" for one in re.findall(r"\{(\w+)\}", name)]
    parameters = [one for one in operation.get("parameters", []) if one["in"] == "query"]
    required = [one for one in parameters if one.get("required")]
    query = [
        f"{one['name']}{'' if one in required else '?'}: {_type(one['schema'])}"
        for one in parameters
    ]
    body = operation.get("requestBody", {}).get("content", {}).get(JSON, {}).get("schema")
    success = next(one for code, one in operation["responses"].items() if code[0] in "23")
    content = success.get("content", {})
    response = _type(content[JSON].get("schema", {})) if JSON in content else "string"
    fields = [f"    path: {{ {'; '.join(path)} }};\n"] if path else []
    fields += [f"    query{'' if required else '?'}: {{ {'; '.join(query)} }};\n"] if query else []
    fields += [f"    body: {_type(body)};\n"] if body else []
    return f"  {json.dumps(name)}: {{\n{''.join(fields)}    response: {response};\n  }};\n"


if __name__ == "__main__":
    TYPES.write_text(http_types(), encoding="utf-8")
