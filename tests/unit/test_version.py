"""The version is the same wherever it is stated."""

import re
import tomllib

from typer.testing import CliRunner

import recon4
from recon4.cli.main import app
from tools.structure import ROOT


def test_package_project_and_changelog_state_the_same_version():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    headings = re.findall(r"^## \[([^\]]+)\]", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.M)

    released = [one for one in headings if one != "Unreleased"]
    assert recon4.__version__ == project["version"] == released[0]
    assert "Unreleased" not in headings[1:]
    assert re.fullmatch(r"\d+\.\d+\.\d+", recon4.__version__)


def test_the_command_prints_it():
    result = CliRunner().invoke(app, ["--version"])

    assert result.output == f"recon4 {recon4.__version__}\n"


def test_the_versions_of_the_changelog_go_down():
    text = (ROOT / "CHANGELOG.md").read_text("utf-8")
    found = [tuple(map(int, one.split("."))) for one in re.findall(r"^## \[([\d.]+)\]", text, re.M)]

    assert len(found) >= 2
    assert found == sorted(found, reverse=True)
