"""Every text has a translation that quotes the same values, and a language is only a folder."""

import re
from pathlib import Path

import pytest
from fluent.syntax import FluentParser, ast

from recon4.cli.main import main
from recon4.errors import ConfigError
from recon4.locales import languages as module
from recon4.locales.languages import ENGLISH, ROOT, best_of, languages, of_terminal
from recon4.locales.texts import Texts, messages_of, quoted_by

REPOSITORY = Path(__file__).parents[2]
FILES = sorted(path.stem for path in (ROOT / ENGLISH).glob("*.ftl"))
TRANSLATED = [(language, file) for language in languages()[1:] for file in FILES]
CODE = [REPOSITORY / room for room in ("recon4", "app", "web")]
MADE = re.compile(
    r"(command|heading|typer|usage|count|headline|word|unobserved|remark|why|state|dance|clock|about|field|approve-reason)-"
    r"|(scans|lines)-damaged$"
    r"|[A-Z][A-Z0-9-]+$"
)
"""Names that code puts together, of findings and counts; their own tests compare them."""
NAMED = re.compile(r'\b(?:NAMED|COUNTED)\(\$\w+, of: "([a-z-]+)"\)')
"""Of names that texts put together."""
WORD = re.compile(r"[\w-]+")
PREFIX = re.compile(
    r'(?:\bword(?:Of|_of)\(\s*"|_choice\("[a-z-]+", ")([a-z-]+)"|(?:\bt\(`|\bf")([a-z-]+)-\$?\{'
)
"""Of names that pages and the viewer put together."""


def parts(message):
    """Names of the parts of a message that code asks for, and the values that each quotes.

    What `WORD` says for a value is the matter of each language.
    """
    found = {one.id.name: one.value for one in message.attributes}
    found |= {"": message.value} if message.value else {}
    return {
        name: quoted_by(pattern) for name, pattern in found.items() if not name.startswith("word-")
    }


@pytest.mark.parametrize(
    "path", sorted(ROOT.glob("*/*.ftl")), ids=lambda path: f"{path.parts[-2:]}"
)
def test_a_file_of_texts_parses(path):
    found = FluentParser().parse(path.read_text("utf-8")).body
    names = [one.id.name for one in found if isinstance(one, ast.Message)]

    assert [one.content for one in found if isinstance(one, ast.Junk)] == []
    assert len(names) == len(set(names)), "a message is there twice"
    one_by_one = messages_of(path)
    assert [*one_by_one] == names
    assert all(
        one_by_one[one.id.name].equals(one, ignored_fields=["comment", "span"])
        for one in found
        if isinstance(one, ast.Message)
    )


@pytest.mark.parametrize(("language", "file"), TRANSLATED)
def test_every_message_is_translated_and_quotes_the_same_values(language, file):
    english = messages_of(ROOT / ENGLISH / f"{file}.ftl")
    own = messages_of(ROOT / language / f"{file}.ftl")

    missing, unknown = english.keys() - own.keys(), own.keys() - english.keys()
    assert not missing, f"{language}/{file}.ftl lacks {missing}: English words will do for a start"
    assert not unknown, f"{language}/{file}.ftl has {unknown}, which English has not"
    assert {name: parts(own[name]) for name in own} == {
        name: parts(english[name]) for name in english
    }


def test_every_message_is_used():
    code = "".join(
        path.read_text("utf-8")
        for room in CODE
        for path in room.rglob("*")
        if path.suffix in {".py", ".js", ".html", ".jinja", ".typ"} and "vendor" not in path.parts
    )
    texts = "".join(path.read_text("utf-8") for path in (ROOT / ENGLISH).glob("*.ftl"))
    made = tuple(f"{one[0] or one[1]}-" for one in PREFIX.findall(code))
    made += tuple(f"{one}-" for one in NAMED.findall(texts))
    names = [name for file in FILES for name in messages_of(ROOT / ENGLISH / f"{file}.ftl")]
    fixed = [name for name in names if not MADE.match(name) and not name.startswith(made)]

    words = set(WORD.findall(code))  # nearly all stand alone: a search of the code takes long

    assert [name for name in fixed if name not in words and name not in code] == []


def test_a_language_needs_a_folder_and_no_code(tmp_path, monkeypatch):
    for language, text in (
        ("en", "{ $count } points\na = b"),
        ("fr", "{ DECIMAL($count, digits: 1) } points"),
    ):
        (tmp_path / language).mkdir()
        (tmp_path / language / "findings.ftl").write_text(f"points = {text}\n", "utf-8")

    french = Texts("fr", "findings", root=tmp_path)

    assert not messages_of(tmp_path / "fr" / "rigs.ftl"), "a file that it lacks has no texts"
    assert languages(tmp_path) == ("en", "fr")
    assert french("points", count=1.5) == "1,5 points"
    assert french("a") == "b", "English where there is no translation"
    with pytest.raises(KeyError, match="count"):
        french("points")


def test_a_browser_gets_the_best_language_that_there_is():
    assert best_of("de-AT,de;q=0.9,en;q=0.8") == "de"
    assert best_of("fr,en;q=0.5,de;q=0.7") == "de"
    assert best_of("en-GB,de;q=0.9") == best_of("xx") == best_of("") == "en"
    assert best_of("de;q=0,en;q=nan") == best_of("de;q=1.2.3") == "en"


def test_a_terminal_is_asked_by_option_and_environment(monkeypatch, capsys):
    monkeypatch.setenv(module.ENVIRONMENT, "de")

    assert of_terminal() == "de"
    assert main(["--language", "en", "explain", "MIRROR"]) == 0
    assert of_terminal() == "en" and "Detected:" in capsys.readouterr().out
    monkeypatch.setenv(module.ENVIRONMENT, "xx")
    with pytest.raises(ConfigError, match="'xx': expected one of en, de"):
        of_terminal()
