"""Sentences of the documentation are short."""

import pytest

from tools.sentences import DOCS, MAX_WORDS, sentences, too_long, words


def test_no_page_has_a_sentence_above_the_limit():
    assert too_long() == {}


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
