"""The wheel alone: nothing of the checkout can be imported where it is installed."""

import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from contextlib import contextmanager
from pathlib import Path
from shutil import copyfile, copytree
from urllib.parse import urljoin

import httpx
import pytest

from recon4.sandbox.private_cache import KERNELS
from tests.deadlines import HANG_S
from tests.service.running import ROOT, WITHOUT_TLS
from tests.service.viser_client import camera, viewing
from tools.site import COMPILED_KERNELS

pytestmark = pytest.mark.slow

SOURCES = (
    *("pyproject.toml", "zensical.toml", "README.md", "LICENSE", "NOTICE"),
    *("recon4", "app", "web", "docs", "tools"),
)
PAGES = ("/", "/docs/", "/docs/reference/recordings.html", "/live", "/rigs")
ADDRESS = re.compile(r'(?:href|src)="([^"#]+)')
CHECKOUT = """
import importlib.util, recon4, recon4_app
assert importlib.util.find_spec("tests") is None and importlib.util.find_spec("tools") is None
print(recon4.__file__, recon4_app.__file__)
"""


COMMAND_WITH_KERNELS = """
import atexit, sys
from recon4.__main__ import main

@atexit.register
def kernels_that_no_installation_compiles():
    from recon4.kernels.signatures import kernel_name, kernels
    modules = [m for name, m in sys.modules.items() if name.startswith("recon4.kernels.")]
    used = {one for m in modules for one in vars(m).values() if hasattr(one, "overloads")}
    listed = {name: kernel.signatures for name, kernel in kernels().items()}
    for one in used:
        for signature in set(one.overloads) - set(listed.get(kernel_name(one), ())):
            print(kernel_name(one), *signature, file=sys.stderr)
    print(f"{len(used)} kernels seen", file=sys.stderr)

main()
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Built from a copy: the site of the checkout is served by other tests meanwhile."""
    folder, source = tmp_path_factory.mktemp("wheel"), tmp_path_factory.mktemp("source")
    for name in SOURCES:
        path = ROOT / name
        (copytree if path.is_dir() else copyfile)(path, source / name)
    pip("wheel", "--no-build-isolation", "--wheel-dir", folder, source)
    (built,) = folder.glob("recon4-*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """An environment with the wheel; libraries are those of the tests, without the checkout.

    A folder that a ``.pth`` file names is searched, but the ``.pth`` files in it are not read.
    """
    place = tmp_path_factory.mktemp("installed")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", place], check=True)
    python = place / "bin" / "python"
    pip("--python", python, "install", "--no-compile", wheel)
    (packages,) = place.glob("lib/python*/site-packages")
    (packages / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return place / "bin"


@pytest.fixture(scope="module")
def demo(installed, tmp_path_factory):
    """A folder in which the demo has run, and what it wrote."""
    folder = tmp_path_factory.mktemp("demo")
    command = [installed / "python", "-P", "-c", COMMAND_WITH_KERNELS]
    arguments = ["demo", "--headless", "--seconds", "5"]
    return folder, run([*command, *arguments], folder)


def pip(*arguments):
    ours = {COMPILED_KERNELS: str(KERNELS / "__pycache__"), "PIP_CONFIG_FILE": os.devnull}
    env = {**os.environ, **ours, "PIP_NO_INDEX": "1", "PIP_NO_DEPS": "1"}
    command = [sys.executable, "-m", "pip", "-q", "--disable-pip-version-check"]
    subprocess.run([*command, *map(str, arguments)], env=env, check=True)


def alone():
    """The environment without the checkout, which tests put in front of everything."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def recon4(installed, folder, *arguments):
    return run([installed / "recon4", *arguments], folder).stdout


def run(command, folder):
    done = subprocess.run(command, cwd=folder, env=alone(), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done


@contextmanager
def serving(installed, folder):
    """``recon4 serve`` on a folder; its address."""
    command = [installed / "recon4", "serve", "demo", "--port", "0"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, cwd=folder, env=alone(), stdout=pipe, text=True) as server:
        try:
            yield re.search(r"http://[^ ]*(?=/)", server.stdout.readline())[0]
        finally:
            server.terminate()
    assert server.returncode == 0


def test_all_it_puts_beside_other_packages_begins_with_recon4(wheel):
    with zipfile.ZipFile(wheel) as file:
        first = {name.split("/")[0] for name in file.namelist()}

    assert {"recon4", "recon4_app", "recon4_web"} < first
    assert [name for name in first if not name.startswith("recon4")] == []


def test_the_help_is_that_of_the_installed_package(installed, tmp_path):
    found = subprocess.run(
        [installed / "python", "-c", CHECKOUT], cwd=tmp_path, env=alone(), capture_output=True
    )

    assert found.returncode == 0, found.stderr
    for place in found.stdout.decode().split():
        assert Path(place).is_relative_to(installed.parent)
    assert "demo" in recon4(installed, tmp_path, "--help")


def test_the_demo_makes_a_map(demo):
    folder, done = demo

    assert "50 multiframes (0 lost)" in done.stdout
    assert (folder / "demo" / "office" / "map.laz").stat().st_size > 1_000_000


def test_the_wheel_brings_the_kernels_so_that_nothing_is_compiled(wheel, installed, demo):
    with zipfile.ZipFile(wheel) as file:
        brought = {name for name in file.namelist() if name.endswith((".nbi", ".nbc"))}
    packages = next(installed.parent.glob("lib/python*/site-packages"))
    found = {str(path.relative_to(packages)) for path in packages.glob("recon4/kernels/*/*.nb?")}

    assert len(brought) > 200
    assert found == brought
    assert "compiling the kernels" not in demo[1].stderr


def test_an_installation_compiles_every_kernel_that_a_map_calls(demo):
    said = demo[1].stderr.splitlines()
    kernels = [line for line in said if re.match(r"[a-z0-9_]+\.[a-z0-9_]+ ", line)]

    assert re.search(r"[1-9]\d\d kernels seen", demo[1].stderr)
    assert kernels == [], "python -m tools.kernel_signatures"


def test_pages_documentation_and_viewer_are_served(installed, demo):
    folder, _ = demo
    with (
        serving(installed, folder) as url,
        httpx.Client(
            base_url=url, verify=WITHOUT_TLS, timeout=HANG_S, follow_redirects=True
        ) as client,
    ):
        pages = {page: client.get(page) for page in PAGES}
        linked = {
            urljoin(str(page.url), at)
            for page in pages.values()
            for at in ADDRESS.findall(page.text)
        }
        ours = sorted(at.removeprefix(url) for at in linked if at.startswith(f"{url}/"))
        answers = pages | {address: client.get(address) for address in ours}
        projects = client.get("/api/projects").json()
        with viewing(url) as browser:
            browser.send(camera())
            browser.until(lambda shown: "/grid" in shown.nodes)

    files = {re.sub("^/web/[0-9a-f]{16}/", "", at) for at in answers}
    assert {"projects/index.js", "shared/base.css"} < files
    assert {at: one.status_code for at, one in answers.items() if one.status_code != 200} == {}
    assert "office" in str(projects)
