"""Folder names made from titles of people."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from recon4_app.projects.store import PROJECT_ID, folder_name, free_folder_name


@pytest.mark.parametrize(
    ("title", "name"),
    [
        ("Office Brno, 2nd floor", "office-brno-2nd-floor"),
        ("Brno, Veveří 2. patro", "brno-veveri-2-patro"),
        ("工場", "project"),
        ("../../etc", "etc"),
        ("v1.5 / hall", "v1-5-hall"),
    ],
)
def test_a_title_becomes_a_plain_folder_name(title, name):
    assert folder_name(title) == name


@given(st.text(max_size=300))
def test_every_title_has_a_folder_name_that_the_server_accepts(title):
    name = free_folder_name(title, lambda name: not re.search(r"-3$", name))

    assert PROJECT_ID.fullmatch(name)
