"""The names of `recon4.api`: few, documented with examples that run, loaded when they are used."""

import doctest
import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from hatchling.builders.wheel import WheelBuilder

from recon4 import api, pipeline

ROOT = Path(__file__).parents[3]
FINDER = doctest.DocTestFinder(recurse=True, exclude_empty=True)


def test_there_are_at_most_fifteen_in_order():
    assert len(api.__all__) <= 15
    assert api.__all__ == sorted(api.__all__)
    assert set(api.__all__) <= set(dir(api))


def test_type_checkers_see_each_name_where_it_is_loaded_from():
    text = (ROOT / "recon4" / "api" / "__init__.py").read_text("utf-8")
    block = text[text.index("if TYPE_CHECKING:") : text.index("_HOMES")]
    seen = re.findall(r"^    from (\S+) import (.+)$", block, re.MULTILINE)

    assert {name: home for home, names in seen for name in names.split(", ")} == api._HOMES
    assert {*api._HOMES, "errors"} == set(api.__all__)


def test_another_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'proces'"):
        _ = api.proces  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", api.__all__)
def test_the_examples_of_a_docstring_give_what_they_show(name, here, monkeypatch):
    monkeypatch.chdir(here)
    found = FINDER.find(getattr(api, name), name, globs={"api": api, "Path": Path})
    ran = [doctest.DocTestRunner().run(test) for test in found]

    assert sum(one.attempted for one in ran) > 0
    assert sum(one.failed for one in ran) == 0


@pytest.mark.parametrize("name", api.__all__)
def test_the_page_lists_a_name(name):
    page = (ROOT / "docs" / "reference" / "python.md").read_text("utf-8")

    assert re.search(rf"^\| `{name}\b", page, re.MULTILINE)


def test_importing_it_loads_no_package_but_its_own():
    program = (
        "import sys; before = set(sys.modules); import recon4.api;"
        "names = {name.partition('.')[0] for name in set(sys.modules) - before};"
        "print(sorted(names - sys.stdlib_module_names))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT
    )

    assert ended.stdout == "['recon4']\n"


def test_the_wheel_says_that_it_has_types():
    files = {file.distribution_path for file in WheelBuilder(str(ROOT)).recurse_included_files()}

    assert {"recon4/py.typed", "recon4/api/__init__.py"} <= files


@pytest.mark.parametrize("page", ["README.md", "docs/reference/python.md"])
def test_the_first_example_of_a_page_runs(page, here, monkeypatch):
    """All but the stages: the walk was processed before."""
    text = (ROOT / page).read_text("utf-8")
    example = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[0]
    monkeypatch.chdir(here)
    shutil.copyfile("recording/recording.pcap", "walk.pcap")
    takes = inspect.signature(pipeline.process)
    processed = []
    monkeypatch.setattr(
        pipeline, "process", lambda *given, **named: processed.append(takes.bind(*given, **named))
    )
    values = {}

    exec(compile(example, page, "exec"), values)

    assert len(processed) == 1
    assert values["project"].summary.points > 0
