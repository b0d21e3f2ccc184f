"""Progress of a whole run from the events of its worker."""

import pytest

from recon4.locales.coded import CodedText
from recon4.workflows.lidar import LIDAR
from recon4.workflows.planar import PLANAR
from recon4.workflows.profiler import PROFILER
from recon4_app.jobs.events import event_of
from recon4_app.jobs.run_progress import STAGE_PERCENT, RunProgress, after, stage_weight
from recon4_app.jobs.supervisor import exit_reason
from recon4_app.projects.model import stage_order
from tools.structure import ROOT


def fold(*events):
    progress = RunProgress()
    for event in events:
        progress = after(progress, event_of(event))
    return progress


def stage(name, state, t):
    return {"kind": "stage", "stage": name, "state": state, "t": t}


def piece(what, done, t):
    return {"kind": "progress", "what": what, "done": done, "total": 100, "seconds": 1.0, "t": t}


RUN = {"kind": "run", "t": 100.0}


def test_half_of_the_first_stage_adds_half_of_its_weight():
    progress = fold(
        RUN,
        stage("frames", "running", 101.0),
        piece("frames", 0, 101.0),
        piece("frames", 50, 104.0),
    )

    assert progress.fraction == pytest.approx(stage_weight("hash") + 0.49 * stage_weight("frames"))


def test_the_remaining_time_follows_from_the_work_without_reused_stages():
    """Half of the run was reused: a tenth in 10 s leaves four tenths for 40 s."""
    progress = RunProgress(began_s=0.0, now_s=10.0, past=0.6, reused=0.5)

    assert progress.eta_s == pytest.approx(40.0)


def test_the_remaining_time_is_unknown_at_the_beginning():
    assert fold(RUN).eta_s is None


def test_the_fraction_never_falls_and_ends_at_one():
    events = [RUN, piece("hash walk.pcap", 0, 100.0), piece("hash walk.pcap", 100, 101.0)]
    for name in ("frames", "odometry", "graph"):
        events += [stage(name, "running", 102.0)]
        for _ in range(4):  # the search goes over the pairs again and again
            events += [piece("pairs", done, 103.0) for done in (0, 30, 100)]
        events += [stage(name, "done", 104.0)]
    events += [piece("results", 0, 105.0), piece("results", 100, 106.0)]
    fractions = [fold(*events[: k + 1]).fraction for k in range(len(events))]

    assert fractions == sorted(fractions)
    assert fractions[-1] < 1.0
    assert RunProgress(over=True).fraction == 1.0


def test_another_worker_resets_the_progress():
    assert fold(RUN, stage("map", "running", 101.0), {"kind": "run", "t": 200.0}) == RunProgress(
        began_s=200.0, now_s=200.0
    )


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (-11, "SIGSEGV"),
        (-9, "memory of the computer"),
        (-99, "signal 99"),
        (3, "exit code 3"),
        (None, "no server"),
    ],
)
def test_exit_reasons(code, words):
    how, number = exit_reason(code)

    assert words in CodedText("worker-continues", how=how, number=number, stage="", what="")


@pytest.mark.parametrize("workflow", [LIDAR, PROFILER, PLANAR], ids=lambda one: one.name)
def test_pages_know_every_stage_of_a_walk(workflow):
    names = [one.name for one in workflow.stages]
    texts = (ROOT / "recon4/locales/en/projects.ftl").read_text("utf-8")

    assert [name for name in stage_order() if name in names] == names
    wordless = [name for name in names if f"\nstage-{name.replace('_', '-')} = " not in texts]
    assert not wordless, f"projects.ftl has no words, stage-NAME, of {wordless}"
    timeless = set(names) - {"review"} - set(STAGE_PERCENT)
    assert workflow is not LIDAR or not timeless, f"say what percent of the time: {timeless}"
