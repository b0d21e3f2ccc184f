"""The command line: output, error messages and exit codes."""

import json
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from typer.main import get_command

import recon4
from recon4.cli.main import app, main
from recon4.cli.overview import HEADINGS
from recon4.settings import preset, to_json
from recon4.system.doctor import examine
from tests.deadlines import HANG_S
from tests.unit.store.small_pipeline import run_all

ROOT = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def keep_signals():
    before = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, before)


def test_help_is_shown_well_under_a_second():
    # Processor time: other tests run at the same moment.
    assert min(_processor_seconds("--help") for _ in range(3)) < 0.8


def _processor_seconds(argument: str) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-m", "recon4", argument]
    subprocess.run(command, check=True, capture_output=True, cwd=ROOT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def test_every_command_has_one_heading_in_the_help(capsys):
    main(["--help"])
    text = capsys.readouterr().out

    placed = [name for names in HEADINGS.values() for name in names]
    assert sorted(placed) == sorted(get_command(app).commands)
    assert [text.count(f"─ {heading} ─") for heading in HEADINGS] == [1] * len(HEADINGS)
    assert "─ Commands ─" not in text


def test_the_version_is_printed(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"recon4 {recon4.__version__}\n"


def test_control_points_are_noted_in_no_folder_without_a_map(tmp_path, capsys):
    assert main(["control", str(tmp_path), "--apply"]) == 1
    assert str(tmp_path) in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["plan", "orthophoto", "terrain"])
def test_a_command_confines_itself_before_it_loads_kernels(command):
    code = (
        "import sys, recon4.cli.products as products\n"
        "class Confined(Exception): pass\n"
        "def confine(**_):\n"
        "    raise Confined('numba' in sys.modules)\n"
        "products.confine_command = confine\n"
        "from typer.testing import CliRunner\n"
        f"made = CliRunner().invoke(products.products, ['{command}', 'walk', 'a.tif'])\n"
        "assert isinstance(made.exception, Confined), made.exception\n"
        "sys.exit(made.exception.args[0])\n"
    )
    # A confined process may not write the shared cache: kernels that come before it look there.
    subprocess.run([sys.executable, "-c", code], check=True)


def test_no_command_shows_the_help_and_is_wrong_usage(capsys):
    assert main([]) == 2
    assert "doctor" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["fly"], "No such command 'fly'"),
        (["settings", "--loud"], "No such option: --loud"),
        (["verify"], "Missing argument"),
        (["settings", "--set", "map.voxel=1"], "no setting 'map.voxel'"),
        (["settings", "--preset", "forest"], "no preset named 'forest'"),
    ],
)
def test_wrong_usage_exits_with_2_and_a_message(capsys, arguments, message):
    assert main(arguments) == 2

    said = capsys.readouterr()
    assert said.err.startswith("recon4: ")
    assert message in said.err
    assert "--help says what it takes" in said.err
    assert said.out == ""


def test_settings_as_json_are_those_in_force(capsys):
    assert main(["settings", "--preset", "thesis", "--set", "map.voxel_m=0.25", "--json"]) == 0

    found = json.loads(capsys.readouterr().out)
    assert found["map"]["voxel_m"] == 0.25
    assert found["registration"] == to_json(preset("thesis"))["registration"]


def test_settings_for_people_mark_what_was_changed(capsys):
    main(["settings", "--set", "map.voxel_m=0.25"])

    lines = capsys.readouterr().out.splitlines()
    (line,) = [line for line in lines if "map.voxel_m" in line]
    assert line.startswith(" * map.voxel_m")
    assert "0.25" in line
    assert sum(line.startswith(" * ") for line in lines) == 1


def test_verify_reports_no_damage(tmp_path, capsys):
    run_all(tmp_path / "p")

    assert main(["verify", str(tmp_path / "p")]) == 0
    assert capsys.readouterr().out == "8 checked, 0 damaged\n"


def test_verify_reports_damage_and_exits_with_1(tmp_path, capsys):
    runner = run_all(tmp_path / "p")
    (runner.runs["total"].artifact.folder / "total.txt").write_text("?")

    assert main(["verify", str(tmp_path / "p")]) == 1
    assert "total.txt has another size" in capsys.readouterr().out


def test_a_known_error_is_one_line_on_stderr_and_exits_with_1(tmp_path, capsys):
    assert main(["verify", str(tmp_path)]) == 1

    said = capsys.readouterr()
    assert said.out == ""
    assert said.err == f"recon4: {tmp_path} is not a recon4 project: it has no project.json\n"
    assert main(["verify", str(tmp_path / "none.zip")]) == 1
    assert capsys.readouterr().err == f"recon4: {tmp_path / 'none.zip'} does not exist\n"


@pytest.mark.parametrize(
    "arguments",
    [
        ["info", "gone"],
        ["process", "gone", "--out", "project"],
        ["evaluate", "gone", "--truth", "gone"],
        ["export", "gone", "map.laz"],
        ["slice", "gone", "cut.png", "--z", "1"],
        ["doubles", "gone"],
        ["replay", "gone"],
        ["record", "project", "--rig", "gone"],
        ["users", "list", "--root", "gone"],
        ["doctor", "gone"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_missing_input_is_one_line_and_leaves_nothing(tmp_path, monkeypatch, capsys, arguments):
    monkeypatch.chdir(tmp_path)

    assert main(arguments) == 1

    said = capsys.readouterr().err
    assert said.startswith("recon4: ") and said.count("\n") == 1 and "gone" in said
    assert list(tmp_path.iterdir()) == []


def test_the_doctor_checks_the_machine(tmp_path, capsys):
    code = main(["doctor", str(tmp_path), "--json"])

    checks = {check["what"]: check for check in json.loads(capsys.readouterr().out)}
    assert {"recon4", "Python", "cores", "memory", "disk free", "gtsam"} <= set(checks)
    assert code == (0 if all(check["ok"] for check in checks.values()) else 1)


def test_the_doctor_reports_how_to_install_missing_parts(tmp_path, monkeypatch):
    monkeypatch.setattr("recon4.system.doctor._PACKAGES", (("no-such-package", "flying"),))

    check = examine(tmp_path)[-1]

    assert not check.ok
    assert check.advice == "needed for flying: pip install no-such-package"


STUCK = """
import sys, recon4.cli.main, recon4.store.verify
def wait(*a, **k):
    print("running", flush=True)
    sys.stdin.readline()
recon4.store.verify.verify_files = wait
sys.exit(recon4.cli.main.main(["verify", "."]))
"""


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_a_stopped_command_exits_with_128_plus_the_signal_and_names_it(stop):
    with subprocess.Popen(
        [sys.executable, "-c", STUCK],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=ROOT,
    ) as child:
        assert child.stdout.readline() == b"running\n"
        child.send_signal(stop)
        _, err = child.communicate(timeout=HANG_S)

    assert child.returncode == 128 + stop
    assert err == f"recon4: stopped by {stop.name}\n".encode()
