"""``openapi.json``: the routes, the permission each requires, and how to sign in."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from typing import Any

from fastapi import FastAPI

from recon4_app.access.middleware.session import FORM_HEADER, cookie_names
from recon4_app.access.routes_check import declared
from recon4_app.error_responses import PROBLEM, ProblemDetail

INTRODUCTION = """The HTTP interface of the pages. The body of an error is a `ProblemDetail`; its
`detail` is a text for users, its `code` is for programs. `x-needs` of an operation names the
permission it requires (empty = none). `docs/how-to/access.md` lists the permissions of each role,
`/api/me` those of the caller."""
TOKEN_SCHEME = {
    "type": "apiKey",
    "in": "header",
    "name": FORM_HEADER,
    "description": "`token` of `/api/me` or of the login; required unless the method is GET",
}
BEARER_SCHEME = {
    "type": "http",
    "scheme": "bearer",
    "description": "an access token of the page Account, in place of the other two",
}
CLASS = re.compile(r"^class (?P<name>\w+).*\n(?P<body>(?:(?: {4}.*)?\n)+)", re.MULTILINE)
FIELD = re.compile(
    r'^ {4}(?P<name>\w+): .*\n(?: {8}.*\n| {4}[)\]].*\n)* {4}"""(?P<text>(?:.|\n)*?)"""',
    re.MULTILINE,
)
"""Read as text: the parser of Python may not be called while others call it (3.11)."""


def description(app: FastAPI, prefix: str = "") -> dict[str, Any]:
    """The OpenAPI description of an application, with the permission of each operation.

    Args:
        app: The application.
        prefix: Path of the server on its host, as ``/recon4``; empty = none.
    """
    described = app.openapi()  # cached by the framework: the changes below are idempotent
    described["info"]["description"] = INTRODUCTION
    if prefix:
        described["servers"] = [{"url": prefix}]
    parts = described["components"]
    parts["securitySchemes"] = {  # required with a login only
        "session": {"type": "apiKey", "in": "cookie", "name": cookie_names(prefix).session},
        "token": TOKEN_SCHEME,
        "access_token": BEARER_SCHEME,
    }
    parts["schemas"] |= _schemas_of_problems()
    for name in ("HTTPValidationError", "ValidationError"):  # ours are problems like all others
        parts["schemas"].pop(name, None)
    _describe_fields(parts["schemas"])
    routes = {
        (route.path, method.lower()): route for route in declared(app) for method in route.methods
    }
    for path, methods in described["paths"].items():
        for method, operation in methods.items():
            route = routes[path, method]
            operation["x-needs"] = sorted(route.needs)
            # Generated clients make a name of it, which must not change with the path.
            operation["operationId"] = f"{operation['tags'][-1]}_{route.name}".replace(" ", "_")
            if "422" in operation["responses"]:
                operation["responses"]["422"]["content"] = PROBLEM
    return described


def _schemas_of_problems() -> dict[str, object]:
    """`ProblemDetail` and the models in it, which no route names."""
    schema = ProblemDetail.model_json_schema(ref_template="#/components/schemas/{model}")
    return schema.pop("$defs") | {"ProblemDetail": schema}


def _describe_fields(schemas: dict[str, Any]) -> None:
    """Copy the docstring below each field of a class into its schema."""
    for name, record in _documented(set(schemas)):
        fields = schemas[name].get("properties", {})
        if not record.keys() <= fields.keys():
            continue  # another class of the same name
        for field, text in record.items():
            fields[field].setdefault("description", text)


def _documented(names: set[str]) -> Iterator[tuple[str, dict[str, str]]]:
    """Classes of our own with these names, each with the docstrings of its fields."""
    ours = [
        module
        for name, module in sys.modules.items()
        if name.startswith(("recon4_app.", "recon4."))
    ]
    for module in ours:
        try:
            source = inspect.getsource(module)
        except (OSError, TypeError):
            continue  # not from a file
        for one in CLASS.finditer(source):
            if one["name"] in names:
                fields = FIELD.finditer(one["body"])
                yield one["name"], {f["name"]: " ".join(f["text"].split()) for f in fields}
