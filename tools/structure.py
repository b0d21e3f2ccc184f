"""Counts of the shape of the code, with places: ``python -m tools.structure [KIND…]``.

`tests/unit/test_structure.py` holds the counts at or below its limits.
"""

from __future__ import annotations

import ast
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("recon4", "app")
KERNELS = "recon4/kernels/"
"""Compiled functions: numba passes their arguments by position, and calls cost time."""

DICTS = "dict[str, Any]"
PARAMETERS = "more than 5 parameters"
POSITIONAL = "more than 3 positional parameters"
FUNCTIONS = "functions over 50 lines"
FILES = "files over 400 lines"
NUMBERS = "numeric constants of modules"

FOREIGN = (
    "recon4/recording/formats/",
    "recon4/recording/packets/hesai/firing_times.py",
    "recon4/recording/packets/hesai/layouts.py",
    "recon4/recording/packets/livox/models.py",
    "recon4/recording/packets/ouster/facts.py",
    "recon4/recording/packets/ouster/layouts.py",
    "recon4/recording/packets/robosense/models.py",
    "recon4/recording/packets/robosense/solid.py",
    "recon4/recording/packets/velodyne/laser_calibration.py",
    "recon4/recording/packets/velodyne/models.py",
    "recon4/recording/packets/velodyne/wide_models.py",
    "recon4/sandbox/kernel.py",
    "recon4/sandbox/namespaces.py",
    "recon4/sandbox/seccomp.py",
)
"""Layouts of files, packets and system calls that others defined: their numbers do not count."""
UNITS = "recon4/units.py"
"""Physics and units: its numbers do not count."""
TUNING = "tuning"
"""Numbers in modules whose name begins so do not count: they hold the records of tuning."""

MAX_PARAMETERS = 5
MAX_POSITIONAL = 3
MAX_FUNCTION_LINES = 50
MAX_FILE_LINES = 400

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True, slots=True)
class Place:
    """Where something was counted."""

    kind: str
    file: str
    line: int
    what: str


def places(root: Path = ROOT) -> list[Place]:
    """Everything that is counted, in the order of the files."""
    found: list[Place] = []
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            found += places_in(path.read_text("utf-8"), path.relative_to(root).as_posix())
    for path in sorted([*(root / "tests").rglob("*.py"), *(root / "tools").rglob("*.py")]):
        found += _long_file(path.read_text("utf-8"), path.relative_to(root).as_posix())
    return found


def places_in(source: str, file: str) -> list[Place]:
    """What is counted in one file of the product.

    Args:
        source: The text of the file.
        file: Its path from the root of the project, with slashes.
    """
    tree = ast.parse(source)
    found = [*_long_file(source, file), *_numbers(tree, file)]
    if "[str, Any]" in source:
        found += _dicts(tree, file)
    if not file.startswith(KERNELS):
        found += _functions(tree, file)
    return found


def counts(found: list[Place]) -> Counter[str]:
    """How many places there are of each kind."""
    return Counter(place.kind for place in found)


def _long_file(source: str, file: str) -> list[Place]:
    lines = len(source.splitlines())
    return [Place(FILES, file, 1, f"{lines} lines")] if lines > MAX_FILE_LINES else []


def _dicts(tree: ast.Module, file: str) -> Iterator[Place]:
    """``dict[str, Any]`` and ``Mapping[str, Any]`` count alike; so does a key ``int | str``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and ast.unparse(node) in _ANONYMOUS:
            yield Place(DICTS, file, node.lineno, ast.unparse(node))


_ANONYMOUS = {"dict[str, Any]", "Mapping[str, Any]", "MutableMapping[str, Any]"}


def _numbers(tree: ast.Module, file: str) -> Iterator[Place]:
    """Names of a module that are bound to a number, or to a tuple or array of numbers.

    Fields of records (tuning) and members of enums are in classes and do not count.
    """
    if file.startswith(FOREIGN) or file == UNITS or Path(file).name.startswith(TUNING):
        return
    for node in tree.body:
        for name, value in _bound(node):
            if _is_number(value):
                yield Place(NUMBERS, file, node.lineno, f"{name} = {ast.unparse(value):.60}")


def _bound(node: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """Names that a statement binds, each with its value."""
    match node:
        case ast.Assign(targets=[ast.Tuple(elts=names)], value=ast.Tuple(elts=values)):
            yield from (
                (ast.unparse(name), value) for name, value in zip(names, values, strict=True)
            )
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            yield name, value
        case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
            yield name, value


def _is_number(node: ast.expr) -> bool:
    match node:
        case ast.Constant(value=value):
            return isinstance(value, int | float) and not isinstance(value, bool)
        case ast.UnaryOp(operand=operand):
            return _is_number(operand)
        case ast.BinOp(left=left, right=right):
            texts = (ast.Constant, ast.JoinedStr)
            both = (left, right)
            return any(map(_is_number, both)) and not any(
                isinstance(one, texts) and not _is_number(one) for one in both
            )
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            return bool(parts) and all(map(_is_number, parts))
        case ast.Starred(value=value):
            return _is_number(value)
        case ast.Call(func=function, args=given):
            made_of_numbers = ast.unparse(function).split(".")[0] in _MAKE_NUMBERS
            return made_of_numbers and any(map(_is_number, given))
    return False


_MAKE_NUMBERS = {"float", "int", "round", "range", "np", "math", "degrees", "radians", "timedelta"}
"""Functions, or packages of functions, whose result is a number."""


def _functions(tree: ast.Module, file: str) -> Iterator[Place]:
    methods: set[int] = set()
    for node in ast.walk(tree):  # a class comes before what is in it
        if isinstance(node, ast.ClassDef):
            methods |= set(map(id, node.body))
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from _function(node, file, is_method=id(node) in methods)


def _function(node: Function, file: str, *, is_method: bool) -> Iterator[Place]:
    bound = is_method and not _is_static(node)
    positional = len(node.args.posonlyargs) + len(node.args.args) - bound
    every = positional + len(node.args.kwonlyargs)
    lines = (node.end_lineno or node.lineno) - node.lineno + 1
    if every > MAX_PARAMETERS:
        yield Place(PARAMETERS, file, node.lineno, f"{node.name}: {every}")
    if positional > MAX_POSITIONAL:
        yield Place(POSITIONAL, file, node.lineno, f"{node.name}: {positional}")
    if lines > MAX_FUNCTION_LINES:
        yield Place(FUNCTIONS, file, node.lineno, f"{node.name}: {lines} lines")


def _is_static(node: Function) -> bool:
    return any(ast.unparse(decorator) == "staticmethod" for decorator in node.decorator_list)


def main() -> None:
    """Print the places, then the counts."""
    found = places()
    chosen = sys.argv[1:]
    for place in found:
        if not chosen or any(word in place.kind for word in chosen):
            print(f"{place.file}:{place.line}: {place.kind}: {place.what}")
    for kind in (DICTS, PARAMETERS, POSITIONAL, FUNCTIONS, FILES, NUMBERS):
        print(f"{counts(found)[kind]:4d} {kind}")


if __name__ == "__main__":
    main()
