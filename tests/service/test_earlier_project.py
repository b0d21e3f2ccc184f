"""A project that an earlier version made and approved still opens.

`project-format1.tar.xz` is a small walk of 92 multiframes, processed, reviewed and approved by
version 0.1.0 before projects had seals and approvals named the manifests.
"""

import json
import tarfile
from pathlib import Path

import pytest

from recon4.cli.main import main
from recon4.errors import Cancelled
from recon4.model.events import StageChanged, Warned
from recon4.pipeline import remake
from recon4.progress import Silent
from recon4.store.project import read_artifacts
from tests.service.running import server_thread

SIGNER = "0a5bf0639cc2939158dcc2f82c27995a755021f45d521d59a423cd32bae1ff50"
"""Public key of the server that signed it."""
ARCHIVE = Path(__file__).parents[1] / "data" / "project-format1.tar.xz"


def extracted(folder):
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(folder, filter="data")
    return folder / "format1"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    folder = tmp_path_factory.mktemp("earlier")
    extracted(folder)
    (folder / ".recon4").mkdir()
    main(["keys", "add", "Server before", SIGNER, "--root", str(folder)])
    return folder


@pytest.fixture(scope="module")
def server(root):
    with server_thread(root) as running:
        yield running


def test_it_is_listed_with_its_figures(server):
    (card,) = server.get("/api/projects").json()

    assert card["finished"] and card["problem"] == ""
    assert card["points"] > 10_000 and card["path_length_m"] == pytest.approx(9.2, abs=0.2)


def test_its_loops_and_decisions_are_there(server):
    review = server.get("/api/projects/format1/review").json()
    queue = server.get("/api/projects/format1/review/queue").json()

    assert [(one["frame_i"], one["frame_j"]) for one in review["standing"]] == [(20, 90)]
    assert review["approval"]["text"] == "Approved v1 · anna · 2026-11-22"
    assert len(queue["rows"]) > 50


def test_its_map_can_be_sliced_and_names_its_approver(server, root, capsys):
    out = root / "slice.csv"

    assert main(["slice", str(root / "format1"), str(out), "--z", "0.5"]) == 0
    stamp = out.read_text().splitlines()[1]
    assert '"who": "anna"' in stamp
    assert '"verdict"' not in stamp and '"why"' not in stamp  # it was signed without them


def test_nothing_of_it_counts_as_damaged(root, capsys):
    assert main(["verify", str(root / "format1")]) == 0
    assert "version 1, approved by anna" in capsys.readouterr().out


class Warnings(Silent):
    """Keeps the warnings; ends the run at its first stage that is not there yet, if wanted."""

    def __init__(self, *, ends):
        self.texts, self._ends = [], ends

    def event(self, event):
        if isinstance(event, Warned):
            self.texts.append(event.text)
        if self._ends and isinstance(event, StageChanged) and event.state == "running":
            raise Cancelled("enough is known")


def retire(project, group, name, value):
    """Have the latest map made with another value of a setting that is fixed now."""
    path = read_artifacts(project)["level"] / "manifest.json"
    manifest = json.loads(path.read_text())
    manifest["recipe"]["settings"][group][name] = value
    path.write_text(json.dumps(manifest))


@pytest.mark.parametrize(
    ("value", "warnings"),
    [
        (0.01, []),  # as it is fixed
        (
            0.05,
            [
                "gnss.min_sd_m is no setting anymore: fixed at 0.01, not 0.05 "
                "(Smallest standard deviation of a fix, whatever the receiver reports [m].)"
            ],
        ),
    ],
)
def test_making_its_map_again_names_the_settings_that_are_fixed_now(tmp_path, value, warnings):
    project = extracted(tmp_path)
    retire(project, "gnss", "min_sd_m", value)
    said = Warnings(ends=True)

    with pytest.raises(Cancelled):
        remake(project, progress=said)

    assert said.texts == warnings


@pytest.mark.study
def test_its_map_is_made_again(tmp_path):
    """It has none of the arrays that later versions state of the odometry."""
    summary = remake(extracted(tmp_path), progress=Silent())

    assert summary.points > 10_000
    assert summary.path_length_m == pytest.approx(9.2, abs=0.2)
