"""What recon4 needs to run must not force its licence on those who use it."""

import itertools
import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from tools.notice import NOTICE, contained, license_of, locked, notice

ROOT = Path(__file__).parents[2]
STRONG_COPYLEFT = re.compile(r"\b(A?GPL|Affero|GNU General Public)", re.IGNORECASE)
LESSER = re.compile(r"\bL(esser )?GPL|Lesser General Public", re.IGNORECASE)


def needed_to_run(direct: list[str]) -> set[str]:
    """Names of all distributions these requirements need, directly or not, extras included."""
    found: set[str] = set()
    open_ends = asked(direct, frozenset())
    while open_ends:
        name, extras = open_ends.pop()
        try:
            requirements = metadata.requires(name) or []
        except metadata.PackageNotFoundError:
            continue  # another system's requirement
        found.add(name)
        open_ends += [one for one in asked(requirements, extras) if one[0] not in found]
    return found


def asked(requirements: list[str], extras: frozenset[str]) -> list[tuple[str, frozenset[str]]]:
    """Those that count on this system with these extras: name and extras of each."""
    parsed = [Requirement(text) for text in requirements]
    return [
        (one.name.lower(), frozenset(one.extras))
        for one in parsed
        if one.marker is None or any(one.marker.evaluate({"extra": e}) for e in extras | {""})
    ]


def licence_of(name: str) -> str:
    about = metadata.metadata(name)
    classifiers = [c for c in about.get_all("Classifier") or [] if c.startswith("License ::")]
    return " | ".join([about.get("License-Expression") or "", *classifiers])


def is_strong_copyleft(licence: str) -> bool:
    return bool(STRONG_COPYLEFT.search(LESSER.sub("", licence)))


def test_nothing_needed_to_run_is_under_the_gpl():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]

    extras = [project["optional-dependencies"][extra] for extra in ("pdf", "dask", "mcp")]

    names = needed_to_run([*project["dependencies"], *itertools.chain(*extras)])

    assert {"numpy", "gtsam", "lazrs", "fastapi", "ezdxf", "mako", "mcp", "httpx2"} <= names
    assert {name: licence_of(name) for name in names if is_strong_copyleft(licence_of(name))} == {}


def test_the_check_itself_knows_the_gpl_from_the_lgpl():
    assert is_strong_copyleft("License :: OSI Approved :: GNU General Public License v3 (GPLv3)")
    assert is_strong_copyleft("GPL-3.0-only")
    assert is_strong_copyleft("GNU Affero General Public License v3")
    assert not is_strong_copyleft("GNU Lesser General Public License v3 (LGPLv3)")
    assert not is_strong_copyleft("LGPL-2.1-or-later")
    assert is_strong_copyleft(licence_of("evo"))


def test_the_notice_names_every_package_of_the_lock_with_its_version():
    rows = re.findall(r"^(\S+) (\S+)  +\S", NOTICE.read_text("utf-8"), re.MULTILINE)

    assert dict(rows) == locked()
    assert len(rows) > 100


def test_the_notice_is_what_the_packages_state_of_themselves():
    assert NOTICE.read_text("utf-8") == notice(), "run `make docs`"


@pytest.mark.parametrize(
    ("name", "expected"),
    [("numpy", "BSD-3-Clause"), ("matplotlib", "Python Software Foundation"), ("certifi", "MPL")],
)
def test_a_license_has_its_name_not_its_text(name, expected):
    assert expected in license_of(name) and "\n" not in license_of(name)


def test_a_package_without_a_known_license_is_refused():
    with pytest.raises(LookupError, match="no-such-package"):
        license_of("no-such-package")


def test_code_of_others_in_the_pages_has_its_license_beside_it():
    folders = [path for path in (ROOT / "web").rglob("vendor") if path.is_dir()]
    others = [child for folder in folders for child in folder.iterdir()]

    assert [one for one in others if not any(one in path.parents for path in contained())] == []


def test_license_and_notice_go_with_every_distribution():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]

    assert project["license-files"] == ["LICENSE", "NOTICE"]
