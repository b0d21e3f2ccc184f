"""What is installed is what was locked: every version pinned, every file by its hash.

Figures: 0 lines of the locks without hash or with an address, 0 installs in the Makefile that
could take another file, 0 packages below the version that fixed a known vulnerability.
"""

import os
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).parents[2]
LOCKS = ("run", "dev", "tools")
FLOORS = {
    "starlette": "1.0.1",  # CVE-2026-48710: the Host header changes request.url.path
    "h11": "0.16.0",  # CVE-2025-43859: chunked bodies smuggle requests
    "python-multipart": "0.0.30",  # GHSA-vffw-93wf-4j4q: smuggled filename*
    "setuptools": "78.1.1",  # CVE-2025-47273: path traversal
    "pip": "25.3",  # CVE-2025-8869: links in archives of sources
    "jinja2": "3.1.6",  # CVE-2025-27516: sandbox breakout
    "cryptography": "44.0.1",  # CVE-2024-12797: raw public keys in OpenSSL
    "werkzeug": "3.0.6",  # CVE-2024-49767: memory of form parsing
    "requests": "2.32.4",  # CVE-2024-47081: leaks netrc
    "urllib3": "2.6.0",  # CVE-2025-66418: endless decompression
    "pillow": "11.3.0",  # CVE-2025-48379: overflow writing DDS
    "fonttools": "4.60.2",  # CVE-2025-66034: writes any file
}
"""Least versions, as of 2026-11-22; `make audit` is asked about the rest."""
NEVER = {"ray", "joblib", "torch"}
"""Not needed, and each unpickles or opens ports (docs/explanation/security.md)."""
NEVER_BY_DEFAULT = {"dask", "distributed", "cloudpickle"}
"""Only `recon4 batch` with several workers needs these: the extra ``dask``."""


def locked(name):
    """Package -> version and hashes of a lock."""
    text = (ROOT / "requirements" / f"{name}.lock").read_text("utf-8").replace("\\\n", " ")
    found = {}
    for line in text.splitlines():
        requirement, *hashes = line.split("--hash=")
        parsed = Requirement(requirement)
        (pin,) = parsed.specifier
        assert pin.operator == "==", line
        key = canonicalize_name(parsed.name)
        found[key] = (pin.version, [one.strip() for one in hashes])
    return found


def test_an_audit_that_could_not_ask_is_not_taken_for_a_clean_one():
    """Without ``--strict`` pip-audit reports no vulnerabilities when it has no database."""
    (command,) = re.findall(r"\S*bin/pip-audit .*", (ROOT / "Makefile").read_text("utf-8"))

    assert "--strict" in command.split()


@pytest.mark.parametrize("name", LOCKS)
def test_every_package_of_a_lock_has_hashes_and_no_address(name):
    text = (ROOT / "requirements" / f"{name}.lock").read_text("utf-8")

    packages = locked(name)

    assert len(packages) > 20
    wrong = [
        package
        for package, (_, hashes) in packages.items()
        if not hashes or not all(re.fullmatch(r"sha256:[0-9a-f]{64}", one) for one in hashes)
    ]
    assert wrong == []
    assert re.findall(r"\w+://\S+|index-url|find-links| @ ", text) == []


def test_the_locks_hold_what_the_constraints_and_the_project_ask_for():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extras = project["optional-dependencies"]
    pins = dict(
        line.split("==") for line in (ROOT / "constraints.txt").read_text("utf-8").splitlines()
    )
    pins = {canonicalize_name(name): version for name, version in pins.items()}
    wanted = {
        "run": project["dependencies"] + extras["build"],
        "dev": project["dependencies"] + extras["build"] + extras["dev"],
    }

    for name, requirements in wanted.items():
        lock = locked(name)
        for text in requirements:
            one = Requirement(text)
            assert one.specifier.contains(lock[canonicalize_name(one.name)][0]), text
        assert {k: v for k, (v, _) in lock.items() if pins.get(k) != v} == {}
    assert locked("run").items() <= locked("dev").items()


@pytest.mark.parametrize("name", LOCKS)
def test_no_locked_version_has_a_vulnerability_that_was_fixed(name):
    versions = {package: version for package, (version, _) in locked(name).items()}

    below = {
        package: versions[package]
        for package, floor in FLOORS.items()
        if package in versions and Version(versions[package]) < Version(floor)
    }

    assert below == {}
    unwanted = NEVER | (NEVER_BY_DEFAULT if name == "run" else set())
    assert unwanted & versions.keys() == set()


def test_this_environment_has_no_old_packages_either():
    """The environment that `make` made; `python -m venv` brings an old pip and setuptools."""
    stamp, lock = Path(sys.prefix) / "installed-dev", ROOT / "requirements" / "dev.lock"
    if not stamp.exists() or stamp.stat().st_mtime < lock.stat().st_mtime:
        pytest.skip("needs the environment of `make` with the present lock")

    installed = {canonicalize_name(d.name): d.version for d in metadata.distributions()}

    below = {
        package: installed[package]
        for package, floor in FLOORS.items()
        if package in installed and Version(installed[package]) < Version(floor)
    }
    assert below == {}


def planned_installs(tmp_path, *targets):
    """Installations that `make` would run in an empty environment."""
    options = [f"VENV={tmp_path}/venv", f"TOOLS={tmp_path}/tools", f"PYTHON={sys.executable}"]
    environment = {k: v for k, v in os.environ.items() if not k.startswith("MAKE")}
    planned = subprocess.run(
        ["make", "-n", *options, *targets],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    return [line for line in planned.splitlines() if "pip install" in line]


@pytest.mark.parametrize(
    ("targets", "locks"),
    [
        (("demo", "sbom"), ["run"]),
        (("types", "kernels"), ["run", "dev"]),
        (("types", "demo", "site"), ["run", "dev"]),
    ],
)
def test_make_installs_one_lock_after_the_other(targets, locks, tmp_path):
    """``-j`` would run them side by side if the second did not need the first."""
    installs = [line for line in planned_installs(tmp_path, *targets) if "/venv/" in line]

    assert re.findall(r"requirements/(\w+)\.lock", "\n".join(installs)) == locks
    assert len([line for line in installs if line.endswith("-e .")]) == 1


def test_make_installs_only_what_the_lock_names(tmp_path):
    """The commands of `make`, for people and for developers."""
    installs = planned_installs(tmp_path, "demo", "lock", "audit", "sbom")
    installs += planned_installs(tmp_path, "unit")

    assert len(installs) >= 5
    safe = ("--require-hashes -r requirements/", "--no-deps --no-build-isolation -e .")
    assert [line for line in installs if not any(words in line for words in safe)] == []
