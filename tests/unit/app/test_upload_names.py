"""Names from browsers, as nasty as they come."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from recon4_app.errors import BadRequest
from recon4_app.uploads.names import another, safe_name, safe_path, slug

FIT = re.compile(r"[A-Za-z0-9_+~-][A-Za-z0-9._+~-]*")


@given(st.text(max_size=300))
def test_whatever_comes_is_a_name_every_system_takes(name):
    safe = safe_name(name)

    assert FIT.fullmatch(safe)
    assert len(safe) <= 100
    assert not safe.endswith(".")
    assert safe_name(safe) == safe


@given(st.text(max_size=300))
def test_a_path_never_leads_out(name):
    try:
        path = safe_path(name)
    except BadRequest:
        return

    assert not path.is_absolute()
    assert ".." not in path.parts
    assert all(FIT.fullmatch(part) for part in path.parts)


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("0000000042.bin", "0000000042.bin"),
        ("Ráno v lese.pcap", "Rano_v_lese.pcap"),
        ("con.TXT", "_con.TXT"),
        (".hidden", "hidden"),
        ("=cmd|' /C calc'!A0.csv", "_cmd_C_calc_A0.csv"),
        ("\u202e\x00", "file_"),
        ("x" * 300 + ".pcap", "x" * 70 + "~" + "x" * 24 + ".pcap"),
    ],
)
def test_names_stay_recognizable(name, safe):
    assert safe_name(name) == safe


def test_files_that_differ_in_case_only_get_a_number():
    taken = {"clouds/a.bin", "clouds/a~2.bin"}

    assert str(another(safe_path("Clouds/A.bin"), taken)) == "Clouds/A~3.bin"


def test_a_slug_is_short_and_without_ending():
    assert slug("Ranní pochůzka 2.pcap") == "ranni-pochuzka-2"
    assert slug("…") == "file"
