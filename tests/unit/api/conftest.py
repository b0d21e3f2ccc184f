"""A folder with a recording of some seconds and its project, as the examples expect it."""

import shutil

import pytest

from tests.made_once import made_once
from tools.example_programs import run


@pytest.fixture(scope="session")
def processed(short_recording, office_recording, tmp_path_factory):
    """Folder after the first example, and what that printed (in ``printed``)."""

    def make(folder):
        shutil.copytree(short_recording, folder / "recording")
        for name in ("truth.tum", "model.ply"):
            shutil.copyfile(office_recording / name, folder / "recording" / name)
        (folder / "printed").write_text(run("process", folder), "utf-8")

    return made_once(tmp_path_factory, "processed-example", make)


@pytest.fixture(scope="module")
def here(processed, tmp_path_factory):
    """A copy to work in."""
    folder = tmp_path_factory.mktemp("examples") / "here"
    shutil.copytree(processed, folder)
    return folder
