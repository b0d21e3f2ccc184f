"""The OpenAPI description is fit for generators of clients."""

import re
from collections import Counter

import pytest

from tools.http_types import described

NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
NEVER_FAILS = {"/api/choices", "/api/server", "/healthz"}
"""Addresses that take nothing of the caller."""


@pytest.fixture(scope="module")
def api():
    return described()


@pytest.fixture(scope="module")
def operations(api):
    return {
        (method, path): operation
        for path, methods in api["paths"].items()
        for method, operation in methods.items()
    }


def references(part):
    """Names of the schemas that a part of the description refers to."""
    if isinstance(part, dict):
        found = [part["$ref"]] if isinstance(part.get("$ref"), str) else []
        return found + [one for value in part.values() for one in references(value)]
    return [one for value in part for one in references(value)] if isinstance(part, list) else []


def test_every_operation_has_a_readable_name_of_its_own(operations):
    names = [one["operationId"] for one in operations.values()]

    assert [name for name, count in Counter(names).items() if count > 1] == []
    assert [name for name in names if not NAME.fullmatch(name)] == []
    assert operations["post", "/api/jobs"]["operationId"] == "jobs_start_job"
    assert {len(one["tags"]) for one in operations.values()} == {1}


def test_every_part_of_a_path_is_a_parameter(operations):
    def places(operation):
        return {one["name"] for one in operation.get("parameters", []) if one["in"] == "path"}

    wrong = {
        f"{method} {path}": places(operation)
        for (method, path), operation in operations.items()
        if set(re.findall(r"\{(\w+)\}", path)) != places(operation)
    }
    assert wrong == {}


def test_every_error_is_a_problem(operations, api):
    problem = "#/components/schemas/ProblemDetail"
    errors = {
        f"{method} {path} {status}": references(answer.get("content", {}))
        for (method, path), operation in operations.items()
        for status, answer in operation["responses"].items()
        if status[0] in "45"
    }

    assert {name: found for name, found in errors.items() if found != [problem]} == {}
    failing = {path for method, path in operations} - NEVER_FAILS
    documented = {name.split()[1] for name in errors}
    assert failing <= documented
    assert {"error", "detail", "code"} <= set(
        api["components"]["schemas"]["ProblemDetail"]["required"]
    )


def test_every_schema_that_is_named_is_there(api):
    known = {f"#/components/schemas/{name}" for name in api["components"]["schemas"]}

    assert set(references(api)) <= known
