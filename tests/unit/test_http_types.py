"""The pages are checked against the server as it is."""

from tools.http_types import TYPES, http_types


def test_the_types_of_the_pages_are_those_of_the_server():
    assert TYPES.read_text("utf-8") == http_types(), "python -m tools.http_types writes them"
