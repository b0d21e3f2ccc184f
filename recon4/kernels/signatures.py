"""Which types each kernel is called with: the lines of ``signatures.txt``.

Numba compiles a kernel for the types of its arguments. The file names all that a map, a live map
and a slice need (``python -m tools.kernel_signatures`` writes it), so that an installation compiles
them at once and on all processors, without a walk.
"""

from __future__ import annotations

import ast
import importlib
import pkgutil
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from numba import types
from numba.core.dispatcher import Dispatcher

SIGNATURES = Path(__file__).with_suffix(".txt")


@dataclass(slots=True)
class Kernel:
    """A compiled function of this package."""

    name: str
    """``module.function``."""
    dispatcher: Dispatcher
    signatures: list[tuple[types.Type, ...]]
    """Types of the arguments it is called with."""
    calls: set[str]
    """Names of the kernels in ``signatures.txt`` that it calls itself, or through others."""

    def compile(self) -> None:
        """Compile it into Numba's cache; what is there already is only loaded."""
        for signature in self.signatures:
            self.dispatcher.compile(signature)  # pyrefly: ignore[missing-attribute]


@cache
def kernels() -> dict[str, Kernel]:
    """All kernels of ``signatures.txt``, by name.

    Raises:
        KeyError: If the file names a kernel or a type that there is none of.
    """
    modules = {module: _imported(module) for module in _module_names()}
    named = _names_of_types(modules.values())
    signatures: dict[str, list[tuple[types.Type, ...]]] = {}
    for line in SIGNATURES.read_text("ascii").splitlines():
        name, _, arguments = line.partition(" ")
        signatures.setdefault(name, []).append(_types(arguments, named))
    made = {}
    for name, of in signatures.items():
        module, _, function = name.partition(".")
        dispatcher = vars(modules[module])[function]
        made[name] = Kernel(name, dispatcher, of, _called(dispatcher) & signatures.keys())
    return made


def spelled(of: types.Type) -> str:
    """A type of an argument as ``signatures.txt`` has it."""
    if isinstance(of, types.Array):
        readonly = "" if of.mutable else ", True"
        return f"Array({of.dtype}, {of.ndim}, '{of.layout}'{readonly})"
    if isinstance(of, types.NamedTuple | types.NamedUniTuple):
        return f"{of.instance_class.__name__}({_spelled(of)})"
    if isinstance(of, types.BaseTuple):
        return f"Tuple({_spelled(of)})"
    return str(of)


def _spelled(parts: Any) -> str:
    return ", ".join(spelled(part) for part in parts)


def _types(arguments: str, named: dict[str, type]) -> tuple[types.Type, ...]:
    call = ast.parse(arguments, mode="eval").body
    assert isinstance(call, ast.Call)
    return tuple(_type(argument, named) for argument in call.args)


def _type(node: ast.expr, named: dict[str, type]) -> Any:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name):
        return types.boolean if node.id == "bool" else vars(types)[node.id]
    assert isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    parts = tuple(_type(part, named) for part in node.args)
    if node.func.id == "Array":
        return types.Array(*parts)
    kind: Any = types.BaseTuple
    return kind.from_types(parts, named[node.func.id])


def _names_of_types(modules: Any) -> dict[str, type]:
    found = {name: value for module in modules for name, value in vars(module).items()}
    tuples = {name: value for name, value in found.items() if isinstance(value, type)}
    return {"Tuple": tuple} | {n: value for n, value in tuples.items() if issubclass(value, tuple)}


def _called(dispatcher: Dispatcher) -> set[str]:
    """Kernels that a kernel calls; those that are inlined stand for what they call."""
    names: set[str] = set()
    code = dispatcher.py_func.__code__
    for name in code.co_names:
        callee = dispatcher.py_func.__globals__.get(name)
        if isinstance(callee, Dispatcher):
            names |= {kernel_name(callee)} | _called(callee)
    return names


def kernel_name(dispatcher: Dispatcher) -> str:
    """``module.function`` of a kernel."""
    function = dispatcher.py_func
    return f"{function.__module__.rpartition('.')[2]}.{function.__name__}"


def _module_names() -> list[str]:
    return [found.name for found in pkgutil.iter_modules([str(Path(__file__).parent)])]


def _imported(module: str) -> ModuleType:
    return importlib.import_module(f"{__package__}.{module}")
