"""Help and wrong usage of every command are in the language of the terminal."""

import pytest
import typer

from recon4.cli.main import app, main
from recon4.cli.spoken import all_below, paragraphs, speak
from recon4.locales.languages import ENGLISH, ENVIRONMENT, ROOT
from recon4.locales.texts import Texts, messages_of
from tools.command_texts import FILE, generated

WRONG = {
    "usage-invalid-value": ["serve", "--port", "x"],
    "usage-invalid": ["settings", "--preset", "forest"],
    "usage-missing-option": ["process", "a"],
    "usage-missing-argument": ["verify"],
    "usage-no-option-but": ["process", "--rigg", "x"],
    "usage-no-option": ["settings", "--loud"],
    "usage-no-command-but": ["proces"],
    "usage-no-command": ["fly"],
    "usage-value-missing": ["settings", "--set"],
    "usage-values-missing": ["evaluate", "x", "--markers", "a"],
    "usage-no-value": ["settings", "--json=1"],
    "usage-extra": ["settings", "more"],
}
"""What is wrong -> a command line with it."""


def test_the_english_sentences_are_those_of_the_commands():
    assert FILE.read_text("utf-8") == generated(), "run: make docs"


def test_no_help_has_an_english_sentence_in_german():
    root = typer.main.get_command(app)
    speak(root.make_context("recon4", ["doctor"]), "de")
    english, german = Texts(ENGLISH, "help"), Texts("de", "help")
    only_english = {english(one) for one in english.names()} - {
        german(one) for one in german.names()
    }

    shown = [
        text
        for _, command in all_below(root)
        for one in (command, *command.params)
        for text in paragraphs(getattr(one, "help", None))
    ]
    speak(root.make_context("recon4", ["doctor"]), ENGLISH)

    assert len(shown) > 200 and set(shown) & only_english == set()


def test_the_help_is_in_the_language_of_the_option_or_of_the_environment(monkeypatch, capsys):
    assert main(["--language", "de", "settings", "--help"]) == 0
    asked = capsys.readouterr().out
    assert main(["settings", "--help"]) == 0  # the option has set the environment
    assert capsys.readouterr().out == asked

    assert "Aufruf: recon4 settings [OPTIONEN]" in asked and "[Vorgabe: indoor]" in asked
    monkeypatch.setenv(ENVIRONMENT, ENGLISH)
    assert main(["settings", "--help"]) == 0
    english = capsys.readouterr().out
    assert "Usage: recon4 settings [OPTIONS]" in english and "[default: indoor]" in english


@pytest.mark.parametrize("code", WRONG)
def test_wrong_usage_is_said_in_the_language(monkeypatch, capsys, code):
    monkeypatch.setenv(ENVIRONMENT, ENGLISH)
    assert main(WRONG[code]) == 2
    english = capsys.readouterr().err
    monkeypatch.setenv(ENVIRONMENT, "de")
    assert main(WRONG[code]) == 2
    german = capsys.readouterr().err

    begin = Texts("de", "usage")(code, **dict.fromkeys(WORDS, "…")).partition("…")[0]
    assert german.startswith(f"recon4: {begin}")
    assert not {*english.splitlines()} & {*german.splitlines()}


WORDS = ("hint", "why", "option", "options", "name", "names", "count", "arguments")
"""What the texts quote."""


def test_all_that_is_recognized_was_tried():
    assert {*messages_of(ROOT / ENGLISH / "usage.ftl")} == {*WRONG, "usage-help"}


def test_a_refused_value_is_said_as_a_field_of_a_page(monkeypatch, capsys):
    monkeypatch.setenv(ENVIRONMENT, "de")

    assert main(["serve", "--points", "3"]) == 2
    assert "'--points': muss mindestens 50000 sein" in capsys.readouterr().err
