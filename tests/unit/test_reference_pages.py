"""The pages of the reference are those of the code, and have all of it."""

import re

import pytest
from typer.main import get_command

from recon4 import api
from recon4.cli.main import app
from recon4.locales.coded import codes
from recon4_app.access.routes_check import declared
from recon4_app.main import create_app
from recon4_app.settings import ServerSettings
from tools.reference_pages import FOLDER, PAGES


@pytest.mark.parametrize("name", PAGES)
def test_a_generated_page_is_current(name):
    assert (FOLDER / name).read_text("utf-8") == PAGES[name](), "run `make docs`"


def test_every_command_has_a_section():
    text = PAGES["cli.md"]()

    assert [one for one in get_command(app).commands if f"\n## recon4 {one}" not in text] == []
    assert "`--out` | required |" in text and "## recon4 users add" in text


def test_every_code_of_an_error_is_listed_with_its_status():
    text = PAGES["problems.md"]()

    assert [code for code in codes() if f"\n| `{code}` |" not in text] == []
    assert "| `project-unknown` | 404 | no project ‹name› |" in text
    assert "| `method-not-allowed` | 405 |" in text


def test_every_name_of_the_interface_has_its_docstring():
    text = PAGES["python-api.md"]()

    assert [one for one in api.__all__ if f"\n## {one}\n" not in text] == []
    assert "evaluate(" in text and "typing." not in text


def test_every_route_of_the_api_has_a_row(tmp_path):
    text = PAGES["http.md"]()
    server = create_app(ServerSettings(root=tmp_path))
    of_files = re.compile(r"/api/uploads/files|:path|/stream$")  # described by their protocols
    paths = {route.path for route in declared(server) if route.path.startswith("/api/")}

    assert len(paths) > 50
    assert [one for one in paths if not of_files.search(one) and f" {one}` |" not in text] == []
