"""One language: no retired word, and one class for each class name."""

import re
import subprocess
from collections import defaultdict

from tests.source_trees import sources
from tools.language import ROOT, lines_with

WORD = "".join(("an", "ew"))
CLASS = re.compile(r"^ *class (\w+)[(:\[]", re.MULTILINE)


def test_no_retired_word_is_used():
    assert list(lines_with([])) == []


def test_the_search_finds_retired_words(tmp_path, monkeypatch):
    monkeypatch.setattr("tools.language.ROOT", tmp_path)
    monkeypatch.setattr("tools.language.listed", lambda paths: ["page.md"])
    (tmp_path / "page.md").write_text(f"The program was {WORD} so.\nFine.\nA {WORD}er.\n")

    assert [(number, word) for _, number, word, _ in lines_with([])] == [(1, WORD)]


def test_a_new_file_is_searched_before_it_is_committed(tmp_path, monkeypatch):
    monkeypatch.setattr("tools.language.ROOT", tmp_path)
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    (tmp_path / "page.md").write_text(f"{WORD}\n")

    assert [name for name, *_ in lines_with([])] == ["page.md"]


def test_each_class_name_stands_for_one_idea():
    places = defaultdict(set)
    for path in sources("recon4", "app"):
        for name in CLASS.findall(path.read_text("utf-8")):
            places[name].add(path.relative_to(ROOT).as_posix())

    assert {name: at for name, at in places.items() if len(at) > 1} == {}
