"""The shape of the code does not get worse: limits of `tools.structure`."""

import ast
from pathlib import Path

import pytest

from tools.structure import (
    DICTS,
    FILES,
    FUNCTIONS,
    NUMBERS,
    PARAMETERS,
    POSITIONAL,
    Place,
    counts,
    places,
    places_in,
)

ROOT = Path(__file__).parents[2]
LIMITS = {DICTS: 23, PARAMETERS: 13, POSITIONAL: 1, FUNCTIONS: 0, FILES: 0, NUMBERS: 94}
"""What was reached. Lower a limit with the change that makes it possible; never raise one."""


@pytest.fixture(scope="module")
def found() -> list[Place]:
    return places()


@pytest.mark.parametrize("kind", LIMITS)
def test_no_count_grows(found, kind):
    of_kind = [f"{p.file}:{p.line}: {p.what}" for p in found if p.kind == kind]

    assert len(of_kind) <= LIMITS[kind], "\n".join([f"{kind}: {len(of_kind)}", *of_kind])


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("x: dict[str, Any] = {}", {DICTS: 1}),
        ("def f(x: Mapping[str, Any]) -> dict[str, Any]: ...", {DICTS: 2}),
        ("x: dict[str, int] = {}", {}),
        ("def f(a, b, c, d): ...", {POSITIONAL: 1}),
        ("def f(a, b, c, *, d, e): ...", {}),
        ("def f(a, b, c, *, d, e, f): ...", {PARAMETERS: 1}),
        ("class C:\n def f(self, a, b, c): ...", {}),
        ("class C:\n def f(self, a, b, c, d): ...", {POSITIONAL: 1}),
        ("class C:\n @staticmethod\n def f(a, b, c, d): ...", {POSITIONAL: 1}),
        ("def f():\n" + " x = 1\n" * 49, {}),
        ("def f():\n" + " x = 1\n" * 50, {FUNCTIONS: 1}),
        ("x = y\n" * 400, {}),
        ("x = y\n" * 401, {FILES: 1}),
    ],
)
def test_what_is_counted(source, expected):
    assert counts(places_in(source, "recon4/some.py")) == expected


@pytest.mark.parametrize(
    ("source", "count"),
    [
        ("_FAR_M = 30.0", 1),
        ("_MOST: int = -3", 1),
        ("_NEAR_M, _FAR_M = 0.3, 30.0", 2),
        ("_BYTES = 64 << 20", 1),
        ("_LAST = 2 * OTHER", 1),
        ("_STEPS = (0.5, 0.2)", 1),
        ("_SD = np.repeat([0.1, 0.3], 3)", 1),
        ("_FAR_RAD = float(np.deg2rad(5.0))", 1),
        ("_DAY = timedelta(days=1) * 2", 1),
        ("_SAME = OTHER", 0),
        ("_SURE = True", 0),
        ("_LINE = 'x' * 3", 0),
        ("_UNITS = (('mm', 1000.0), ('m', 1.0))", 0),
        ("STAGE = Stage('map', 9)", 0),
        ("class Tuning:\n far_m: float = 30.0", 0),
        ("def f():\n far_m = 30.0", 0),
    ],
)
def test_numbers_of_a_module_are_counted_and_those_of_records_are_not(source, count):
    assert counts(places_in(source, "recon4/some.py"))[NUMBERS] == count


@pytest.mark.parametrize(
    "file",
    ["recon4/units.py", "recon4/mapping/tuning.py", "recon4/recording/formats/pcap.py"],
)
def test_numbers_of_tuning_units_and_foreign_layouts_are_not_counted(file):
    assert not places_in("_FAR_M = 30.0", file)


def test_parameters_of_kernels_are_not_counted():
    source = "def f(a, b, c, d, e, g): ..."

    assert not places_in(source, "recon4/kernels/some.py")
    assert counts(places_in(source, "recon4/some.py")) == {PARAMETERS: 1, POSITIONAL: 1}


def test_tuning_records_are_structs_unless_they_complete_settings():
    slow = [
        f"{path.relative_to(ROOT)}: {node.name}"
        for room in ("recon4", "app")
        for path in sorted((ROOT / room).rglob("tuning*.py"))
        for node in ast.parse(path.read_text("utf-8")).body
        if isinstance(node, ast.ClassDef) and node.decorator_list
        if not any(ast.unparse(base).endswith("Settings") for base in node.bases)
    ]

    assert slow == []


def test_every_test_in_a_browser_is_marked():
    """One that is not runs among the others, where no later test can call `asyncio.run`."""
    files = sorted((ROOT / "tests" / "e2e").rglob("test_*.py"))
    unmarked = [one.name for one in files if "pytest.mark.e2e" not in one.read_text("utf-8")]

    assert len(files) > 20 and unmarked == []
