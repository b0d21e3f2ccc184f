"""``openapi.json``: what the framework knows of the routes, who may call each, how to sign in."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from typing import Any

from fastapi import FastAPI

from app.access.middleware.session import COOKIE, FORM_HEADER
from app.access.routes_check import declared

WORDS = """Everything the pages do. Errors answer `{"error", "detail"}`; `detail` is for people.
`x-needs` of an operation names the right it takes (empty = none); which role has which right is in
`docs/access.md`, one's own rights are in `/api/me`."""
SCHEMES = {
    "session": {"type": "apiKey", "in": "cookie", "name": COOKIE},
    "token": {
        "type": "apiKey",
        "in": "header",
        "name": FORM_HEADER,
        "description": "`token` of `/api/me` or of the login, for whatever is not GET",
    },
}
"""Only where people sign in; without `--lan` neither is asked for."""
CLASS = re.compile(r"^class (?P<name>\w+).*\n(?P<body>(?:(?: {4}.*)?\n)+)", re.MULTILINE)
FIELD = re.compile(
    r'^ {4}(?P<name>\w+): .*\n(?: {8}.*\n| {4}[)\]].*\n)* {4}"""(?P<text>(?:.|\n)*?)"""',
    re.MULTILINE,
)
"""Read as text: the parser of Python may not be called while others call it (3.11)."""
OUR_PROBLEM = {"application/json": {"schema": {"$ref": "#/components/schemas/Problem"}}}


def description(app: FastAPI) -> dict[str, Any]:
    """The OpenAPI description of an application whose routes say who may use them."""
    described = app.openapi()  # kept by the framework: what follows changes nothing the second time
    described["info"]["description"] = WORDS
    parts = described["components"]
    parts["securitySchemes"] = SCHEMES
    for name in ("HTTPValidationError", "ValidationError"):  # ours are problems like all others
        parts["schemas"].pop(name, None)
    _tell_fields(parts["schemas"])
    needed = {
        (route.path, method.lower()): sorted(route.needs)
        for route in declared(app)
        for method in route.methods
    }
    for path, methods in described["paths"].items():
        for method, operation in methods.items():
            operation["x-needs"] = needed[path, method]
            if "422" in operation["responses"]:
                operation["responses"]["422"]["content"] = OUR_PROBLEM
    return described


def _tell_fields(schemas: dict[str, Any]) -> None:
    """Put the text below each field of a record's class into the record's description."""
    for name, record in _documented(set(schemas)):
        fields = schemas[name].get("properties", {})
        if not record.keys() <= fields.keys():
            continue  # another class of the same name
        for field, words in record.items():
            fields[field].setdefault("description", words)


def _documented(names: set[str]) -> Iterator[tuple[str, dict[str, str]]]:
    """Our classes of some names, each with the texts below its fields."""
    ours = [module for name, module in sys.modules.items() if name.startswith(("app.", "recon4."))]
    for module in ours:
        try:
            source = inspect.getsource(module)
        except (OSError, TypeError):
            continue  # not from a file
        for one in CLASS.finditer(source):
            if one["name"] in names:
                fields = FIELD.finditer(one["body"])
                yield one["name"], {f["name"]: " ".join(f["text"].split()) for f in fields}
