"""A stage runs once for the same inputs, settings and code version."""

from dataclasses import replace

import pytest

from recon4.errors import Recon4Error
from recon4.model.events import ArtifactDamaged
from recon4.progress import Silent
from recon4.settings import Settings, override, to_json
from recon4.settings.reads import ImportReads, ReadsNothing
from recon4.store.package_versions import versions
from recon4.store.project import Project, read_artifacts, read_stages
from recon4.store.stage import Input, Stage, StageRunner, stage_key
from recon4.workflows.summary import spent
from tests.unit.store.small_pipeline import COUNT, TEXT, results, run_all

SETTINGS = Settings()
TEXT_INPUT = Input(key=TEXT, value=TEXT)


def reused(runner: StageRunner) -> dict[str, bool]:
    return {name: run.reused for name, run in runner.runs.items()}


def test_the_second_run_does_nothing(tmp_path):
    run_all(tmp_path / "p")
    before = results(tmp_path / "p")

    again = run_all(tmp_path / "p")

    assert reused(again) == {"count": True, "scale": True, "total": True}
    assert results(tmp_path / "p") == before


def test_a_changed_setting_reruns_only_what_depends_on_it(tmp_path):
    run_all(tmp_path / "p")

    changed = run_all(tmp_path / "p", override(SETTINGS, ["map.voxel_m=0.5"]))

    assert reused(changed) == {"count": True, "scale": False, "total": False}


def test_a_setting_no_stage_reads_reruns_nothing(tmp_path):
    run_all(tmp_path / "p")

    changed = run_all(tmp_path / "p", override(SETTINGS, ["gnss.enabled=false"]))

    assert all(reused(changed).values())


def test_going_back_to_the_old_setting_finds_the_old_artifacts(tmp_path):
    run_all(tmp_path / "p")
    run_all(tmp_path / "p", override(SETTINGS, ["map.voxel_m=0.5"]))

    back = run_all(tmp_path / "p")

    assert all(reused(back).values())
    scale = back.runs["scale"].artifact
    assert read_artifacts(tmp_path / "p")["scale"] == scale.folder


@pytest.mark.parametrize(
    "other",
    [
        stage_key(replace(COUNT, version=2), SETTINGS, {"text": TEXT_INPUT}),
        stage_key(replace(COUNT, name="other"), SETTINGS, {"text": TEXT_INPUT}),
        stage_key(COUNT, override(SETTINGS, ["ingest.rate_hz=5"]), {"text": TEXT_INPUT}),
        stage_key(COUNT, SETTINGS, {"text": Input(key="other", value=TEXT)}),
        stage_key(COUNT, SETTINGS, {"words": TEXT_INPUT}),
        stage_key(COUNT, SETTINGS, {"text": None}),
    ],
    ids=["version", "name", "setting", "input", "input name", "no input"],
)
def test_the_key_changes_with_whatever_the_result_depends_on(other):
    key = stage_key(COUNT, SETTINGS, {"text": TEXT_INPUT})

    assert other != key
    assert len(key) == 64


def test_the_key_does_not_depend_on_where_the_input_lies():
    here = stage_key(COUNT, SETTINGS, {"text": Input(key="k", value="/here")})

    assert here == stage_key(COUNT, SETTINGS, {"text": Input(key="k", value="/there")})


def test_a_stage_that_reads_a_group_it_did_not_declare_fails_at_once(tmp_path):
    def sly(context):
        (context.out / "x").write_text(str(context.settings.map.voxel_m))

    with Project.open(tmp_path / "p") as project:
        runner = StageRunner(project, SETTINGS, Silent())
        with pytest.raises(AttributeError, match="map"):
            runner.run(Stage("sly", 1, ImportReads, sly))
        assert list(project.artifacts.iterdir()) == []


def test_a_stage_that_fails_leaves_nothing_and_keeps_what_was_finished(tmp_path):
    def fails(context, *, counted):
        (context.out / "half").write_text("half")
        raise Recon4Error("no floor found")

    with Project.open(tmp_path / "p") as project:
        runner = StageRunner(project, SETTINGS, Silent())
        counted = runner.run(COUNT, text=TEXT_INPUT)
        with pytest.raises(Recon4Error, match="no floor found"):
            runner.run(Stage("fails", 1, ReadsNothing, fails), counted=counted)
        assert list(project.artifacts.iterdir()) == [counted.folder]
    assert [row.stage for row in read_stages(tmp_path / "p")] == ["count"]


def test_a_damaged_artifact_is_set_aside_and_made_again(tmp_path):
    first = run_all(tmp_path / "p")
    broken = first.runs["scale"].artifact
    (broken.folder / "0.txt").write_text("longer than it was")
    progress = Silent()

    again = run_all(tmp_path / "p", progress=progress)

    assert reused(again) == {"count": True, "scale": False, "total": True}
    aside = list((tmp_path / "p" / "artifacts").glob("damaged-*"))
    assert [(path / "0.txt").read_text() for path in aside] == ["longer than it was"]
    assert [event.stage for event in progress.events if isinstance(event, ArtifactDamaged)] == [
        "scale"
    ]


def test_an_artifact_somebody_deleted_is_made_again(tmp_path):
    first = run_all(tmp_path / "p")
    gone = first.runs["count"].artifact
    for path in sorted(gone.folder.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    gone.folder.rmdir()

    again = run_all(tmp_path / "p")

    assert reused(again) == {"count": False, "scale": True, "total": True}


def test_the_manifest_tells_what_the_artifact_is_made_of(tmp_path):
    runner = run_all(tmp_path / "p")

    manifest = runner.runs["count"].artifact.manifest()

    assert manifest["recipe"]["inputs"] == {"text": TEXT}
    assert manifest["recipe"]["settings"]["ingest"] == to_json(SETTINGS.ingest)
    assert manifest["figures"] == {"words": 7}
    assert set(manifest["files"]) == {"deep/lengths.json", "range.txt"}
    assert manifest["versions"] == versions()
    assert manifest["done"]["seconds"] > 0.0
    assert manifest["done"]["peak_bytes"] > 1_000_000


def test_the_watcher_hears_of_every_stage(tmp_path):
    run_all(tmp_path / "p")
    progress = Silent()

    run_all(tmp_path / "p", override(SETTINGS, ["map.voxel_m=0.5"]), progress)

    said = [(event.stage, event.state) for event in progress.events]
    assert said == [
        ("count", "running"),
        ("count", "reused"),
        ("scale", "running"),
        ("scale", "done"),
        ("total", "running"),
        ("total", "done"),
    ]


def test_the_time_of_a_repeated_stage_is_counted_each_time(tmp_path):
    with Project.open(tmp_path / "p") as project:
        runner = StageRunner(project, SETTINGS, Silent())
        stage = Stage("odometry", 1, ReadsNothing, lambda context, walk: None)
        first = runner.run(stage, walk=Input("recorded rig", None))
        once = spent(runner.runs["odometry"])
        runner.run(stage, walk=Input("calibrated rig", None))

        again = runner.runs["odometry"]
        assert again.artifact.key != first.key
        twice = spent(again)
        assert twice.seconds == once.seconds + again.done.seconds
        assert twice.cpu_seconds == once.cpu_seconds + again.done.cpu_seconds
        assert twice.peak_bytes >= once.peak_bytes
