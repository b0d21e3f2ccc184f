"""What recon4 needs to run must not force its licence on those who use it."""

import re
from importlib import metadata

from packaging.requirements import Requirement

STRONG_COPYLEFT = re.compile(r"\b(A?GPL|Affero|GNU General Public)", re.IGNORECASE)
LESSER = re.compile(r"\bL(esser )?GPL|Lesser General Public", re.IGNORECASE)


def needed_to_run(package: str) -> set[str]:
    """Names of all distributions the package needs, directly or not, extras included."""
    found: set[str] = set()
    open_ends = [(package, frozenset[str]())]
    while open_ends:
        name, extras = open_ends.pop()
        try:
            requirements = metadata.requires(name) or []
        except metadata.PackageNotFoundError:
            continue  # another system's requirement
        found.add(name)
        for text in requirements:
            requirement = Requirement(text)
            asked = requirement.marker is None or any(
                requirement.marker.evaluate({"extra": extra}) for extra in extras | {""}
            )
            if asked and requirement.name.lower() not in found:
                open_ends.append((requirement.name.lower(), frozenset(requirement.extras)))
    return found


def licence_of(name: str) -> str:
    about = metadata.metadata(name)
    classifiers = [c for c in about.get_all("Classifier") or [] if c.startswith("License ::")]
    return " | ".join([about.get("License-Expression") or "", *classifiers])


def is_strong_copyleft(licence: str) -> bool:
    return bool(STRONG_COPYLEFT.search(LESSER.sub("", licence)))


def test_nothing_needed_to_run_is_under_the_gpl():
    names = needed_to_run("recon4")

    assert {"numpy", "gtsam", "lazrs", "fastapi"} <= names
    assert {name: licence_of(name) for name in names if is_strong_copyleft(licence_of(name))} == {}


def test_the_check_itself_knows_the_gpl_from_the_lgpl():
    assert is_strong_copyleft("License :: OSI Approved :: GNU General Public License v3 (GPLv3)")
    assert is_strong_copyleft("GPL-3.0-only")
    assert is_strong_copyleft("GNU Affero General Public License v3")
    assert not is_strong_copyleft("GNU Lesser General Public License v3 (LGPLv3)")
    assert not is_strong_copyleft("LGPL-2.1-or-later")
    assert is_strong_copyleft(licence_of("evo"))
