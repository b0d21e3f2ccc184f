"""`NOTICE`: what recon4 brings along or installs, and its licenses. ``python -m tools.notice``.

Packages are those of `requirements/run.lock`; what each says of its license is read from its
installed metadata. Code of others in `web/` lies in folders with a ``LICENSE`` of their own.
"""

from __future__ import annotations

import re
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parents[1]
NOTICE = ROOT / "NOTICE"
LOCK = ROOT / "requirements" / "run.lock"
_LOCKED = re.compile(r"^([A-Za-z0-9._-]+)==([^\s;\\]+)", re.MULTILINE)
_ELSEWHERE = {"colorama": "BSD-3-Clause", "open3d": "MIT"}
"""Licenses of packages that other systems need; read if they are installed."""
_LONGEST = 40
"""Characters of the name of a license; some packages state the whole text in its place."""
_HEAD = """\
recon4
Copyright 2026 the authors of recon4

recon4 is licensed under the Apache License, Version 2.0; see LICENSE.

Written by `make docs`; do not edit.
"""
_PACKAGES = """\
Packages
--------

recon4 contains none of these packages. It needs them to run, or they need each other; each is
installed from its own distribution, which has the text of its license. The versions are those of
requirements/run.lock, the licenses as the packages state them.
"""
_CONTAINED = """\
Contained in web/
-----------------
"""


def locked() -> dict[str, str]:
    """Names and versions of the packages that recon4 needs to run, by name."""
    return dict(sorted(_LOCKED.findall(LOCK.read_text("utf-8"))))


def license_of(name: str) -> str:
    """What a package says of its license, in a few words.

    Raises:
        LookupError: If it is not installed, and its license is not known otherwise.
    """
    try:
        about = metadata.metadata(name)
    except metadata.PackageNotFoundError:
        if name in _ELSEWHERE:
            return _ELSEWHERE[name]
        raise LookupError(f"{name} is not installed: its license goes into _ELSEWHERE") from None
    classifiers = [
        line.rpartition(" :: ")[2]
        for line in about.get_all("Classifier") or []
        if line.startswith("License ::")
    ]
    fields = [*(about.get_all("License-Expression") or ()), *(about.get_all("License") or ())]
    stated = fields[0] if fields else ""
    if stated and len(stated) <= _LONGEST and stated != "UNKNOWN":
        return stated
    if not classifiers and not stated:
        raise LookupError(f"{name} states no license")
    return " or ".join(classifiers) or stated.splitlines()[0].strip()


def contained() -> list[Path]:
    """Files with the licenses of code of others in `web/`."""
    return sorted((ROOT / "web").rglob("LICENSE*"))


def notice() -> str:
    """The text of `NOTICE`."""
    packages = locked()
    width = max(len(f"{name} {version}") for name, version in packages.items())
    rows = [
        f"{f'{name} {version}':<{width}}  {license_of(name)}" for name, version in packages.items()
    ]
    parts = [_HEAD, _PACKAGES, "\n".join(rows) + "\n"]
    if texts := contained():
        parts.append(_CONTAINED)
        parts += [
            f"{path.parent.relative_to(ROOT).as_posix()}\n\n{path.read_text('utf-8').strip()}\n"
            for path in texts
        ]
    return "\n".join(parts)


if __name__ == "__main__":
    NOTICE.write_text(notice(), encoding="utf-8")
