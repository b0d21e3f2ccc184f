"""Deny by default: a server with a route that declares no permission does not start."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from fastapi import FastAPI
from fastapi.dependencies.models import Dependant
from fastapi.routing import iter_route_contexts
from starlette.routing import Mount

from recon4_app.access.people import Permission, allow_anonymous


@dataclass(frozen=True, slots=True)
class Declared:
    """What a route declares about access."""

    path: str
    name: str
    """Of the function that answers."""
    methods: frozenset[str]
    """Empty for a WebSocket."""
    needs: frozenset[Permission]
    """Permissions a person must have, all of them."""
    allow_anonymous: bool
    """Whether it answers before login."""


def declared(app: FastAPI) -> Iterator[Declared]:
    """Every route and WebSocket of the application, folders of files left out."""
    for route in iter_route_contexts(app.routes):
        if isinstance(route.original_route, Mount):
            continue
        calls = list(_calls(getattr(route, "dependant", None)))
        yield Declared(
            path=str(route.path),
            name=str(getattr(route, "name", "")),
            methods=frozenset(getattr(route, "methods", None) or ()),
            needs=frozenset(call.needs for call in calls if hasattr(call, "needs")),
            allow_anonymous=allow_anonymous in calls,
        )


def check_declared(app: FastAPI) -> None:
    """Check that every route declares who may use it.

    Raises:
        AssertionError: With the paths of those that do not.
    """
    silent = [one.path for one in declared(app) if not one.needs and not one.allow_anonymous]
    assert not silent, f"declare dependencies=[Depends(needs(Permission.…))] for: {silent}"


def _calls(dependant: Dependant | None) -> Iterator[object]:
    if dependant is None:
        return
    for one in dependant.dependencies:
        yield one.call
        yield from _calls(one)
