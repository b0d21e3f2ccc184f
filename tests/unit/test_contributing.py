"""The worked examples of CONTRIBUTING.md fit the files that they change."""

import re

import pytest

from tools.structure import ROOT

BLOCK = re.compile(r"^```diff\n--- (\S+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
CHANGES = BLOCK.findall((ROOT / "CONTRIBUTING.md").read_text("utf-8"))


def not_found(change, lines):
    """Lines that a change keeps or removes and that are not in a file, in this order."""
    rest = iter(lines)
    expected = [line[1:] for line in change.splitlines() if line[:1] in {" ", "-"}]
    return [line for line in expected if line.strip() and line not in rest]


@pytest.mark.parametrize(("file", "change"), CHANGES, ids=[file for file, _ in CHANGES])
def test_a_worked_example_fits_its_file(file, change):
    assert not_found(change, (ROOT / file).read_text("utf-8").splitlines()) == []


def test_there_are_examples_and_a_wrong_one_is_found():
    assert len(CHANGES) >= 9
    assert not_found("-b\n+x\n c\n", ["a", "b", "c"]) == []
    assert not_found(" c\n-b\n", ["a", "b", "c"]) == ["b"]
