"""Every program in `examples/` runs, and its page shows it and what it prints."""

import pytest

from tools.example_programs import (
    FOLDER,
    LOCAL,
    REMOTE,
    page,
    page_path,
    run,
    without_figures,
)


def shown(text):
    return without_figures(text).splitlines()


def test_every_program_is_run_by_a_test():
    assert {path.stem for path in FOLDER.glob("*.py")} == {*LOCAL, *REMOTE}


def test_the_page_of_the_first_program_shows_what_it_prints(processed):
    printed = (processed / "printed").read_text("utf-8")

    assert shown(page_path("process").read_text("utf-8")) == shown(page("process", printed))


@pytest.mark.parametrize("name", [name for name in LOCAL if name != "process"])
def test_a_program_runs_and_prints_what_its_page_shows(name, here):
    printed = run(name, here)

    assert shown(page_path(name).read_text("utf-8")) == shown(page(name, printed))


@pytest.mark.parametrize("name", REMOTE)
def test_the_page_of_a_client_shows_it(name):
    assert page_path(name).read_text("utf-8") == page(name, "")
