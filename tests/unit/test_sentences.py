"""Sentences of the documentation are short."""

import pytest

from tools.sentences import DOCS, MAX_WORDS, sentences, too_long, words

LEFT = {
    "explanation/calibration.md": 8,
    "explanation/evaluation.md": 1,
    "explanation/fuzzing.md": 2,
    "explanation/georeference.md": 1,
    "explanation/odometry.md": 23,
    "explanation/pose-graph.md": 3,
    "explanation/registration.md": 8,
    "explanation/search.md": 2,
    "explanation/security.md": 2,
    "explanation/simulation.md": 4,
    "explanation/slam2d.md": 4,
    "explanation/surfaces.md": 2,
    "explanation/wuerzburg.md": 4,
    "how-to/access.md": 2,
    "how-to/live.md": 12,
    "how-to/review.md": 7,
    "how-to/server.md": 8,
    "how-to/slices.md": 8,
    "how-to/viewer.md": 3,
    "reference/findings.md": 5,
    "reference/packets.md": 3,
    "reference/recordings.md": 7,
    "reference/report.md": 2,
    "reference/rig.md": 2,
}
"""How many each page still has; a page that is not named has none. The numbers only fall."""


@pytest.fixture(scope="module")
def found():
    return too_long()


def test_no_page_has_more_long_sentences_than_before(found):
    assert {page: long for page, long in found.items() if len(long) > LEFT.get(page, 0)} == {}


def test_the_numbers_that_are_left_are_current(found):
    assert {page: len(found.get(page, [])) for page in LEFT} == LEFT


def test_the_pages_are_read():
    assert len(sentences((DOCS / "explanation" / "odometry.md").read_text("utf-8"))) > 60


@pytest.mark.parametrize(
    ("markdown", "expected"),
    [
        ("One is 2.5 m long. Two (e.g. this)!\n\nThree", 3),
        ("- a point\n- another: with `a. b. C` code\n\n| a | table. B |\n", 2),
        ("Before:\n\n```\nCode. More.\n```\n\n# A heading. No\n\n    Code. Too.\n", 1),
        ("It works: Then more; and so on.", 2),
    ],
)
def test_a_text_is_split_into_sentences(markdown, expected):
    assert len(sentences(markdown)) == expected


def test_words_of_code_and_links_count_once():
    assert words("See [a page](../a/b.md) and `recon4 process --out x`.") == 5
    assert words(" ".join(["word"] * (MAX_WORDS + 1))) == MAX_WORDS + 1
