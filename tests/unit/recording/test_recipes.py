"""Points of unknown makers: a recipe says what their columns are, `info` proposes it."""

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.errors import ConfigError, CorruptFile
from recon4.findings.derived import derived_text
from recon4.model.point_recipes import parse_fields_text
from recon4.model.rig import format_rig, load_rig, parse_rig
from recon4.recording.info.describe import describe
from recon4.recording.recipes.apply import as_points
from recon4.recording.recipes.propose import propose, say_doubts
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import RigToComplete, Stream, single_rig
from tests.builders import T0_NS, Bag, bag_path, write_pcd
from tests.unit.recording.point_bags import (
    ROOM,
    STEP_NS,
    read,
    register,
    since_us,
    structures,
    write_points,
)
from tests.warned import K, derivations, warned

STRUCTURES = """std_msgs/Header header
uint64 timebase
my_driver/PointXYZRT[] pts
===
MSG: my_driver/PointXYZRT
int32 px_mm
int32 py_mm
int32 pz_mm
uint8 refl
uint8 laser_id
uint32 t_us
"""
ARRAYS = """std_msgs/Header header
float32[] x
float32[] y
float32[] z
float64[] timestamp
uint8[] channel
float32[] remission
string note
"""
POLAR = """std_msgs/Header header
my_driver/Echo[] echoes
===
MSG: my_driver/Echo
uint16 distance_mm
float32 azimuth
float32 elevation
uint32 sec
uint32 nanosec
uint8 ring
uint16 strength
"""
KINDS = ["bag1", "db3", "mcap"]


def recipe(text):
    return parse_fields_text(text, "fields")


def with_fields(text, topic="/own"):
    return single_rig(Stream(topic, "generic", topic=topic, fields=recipe(text)))


def in_millimeters(store, room, t_ns):
    mm = [np.rint(room[axis] * 1e3).astype(np.int64) for axis in "xyz"]
    rows = [*mm, room["intensity"].astype(int), room["ring"], since_us(room)]
    return t_ns, structures(store, "my_driver/msg/PointXYZRT", rows)


def in_arrays(store, room, t_ns):
    times = (t_ns * 1e-9) + room["time"].astype(np.float64)
    xyz = [room[axis] for axis in "xyz"]
    return *xyz, times, room["ring"].astype(np.uint8), room["intensity"], "text"


def in_angles(store, room, t_ns):
    xyz = np.column_stack([room[axis] for axis in "xyz"]).astype(np.float64)
    azimuth = np.rad2deg(np.arctan2(xyz[:, 1], xyz[:, 0]))
    elevation = np.rad2deg(np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1])))
    at_ns = t_ns + since_us(room).astype(np.int64) * 1000
    rows = [np.rint(np.linalg.norm(xyz, axis=1) * 1e3).astype(np.int64), azimuth, elevation]
    rows += [at_ns // 10**9, at_ns % 10**9, room["ring"], room["intensity"].astype(int)]
    return (structures(store, "my_driver/msg/Echo", rows),)


MADE = {
    "structures": (
        STRUCTURES,
        in_millimeters,
        "x=px_mm:mm,y=py_mm:mm,z=pz_mm:mm,time=t_us:us,ring=laser_id,intensity=refl",
    ),
    "arrays": (
        ARRAYS,
        in_arrays,
        "x=x,y=y,z=z,time=timestamp:s,ring=channel,intensity=remission",
    ),
    "polar": (
        POLAR,
        in_angles,
        "range=distance_mm:mm,azimuth=azimuth:deg,elevation=elevation:deg,"
        "time=sec:s+nanosec:ns,ring=ring,intensity=strength",
    ),
}


@pytest.mark.parametrize(
    ("name", "kind"), [*(("structures", k) for k in KINDS), ("arrays", "bag1"), ("polar", "mcap")]
)
def test_points_of_a_message_are_those_that_its_recipe_says(name, kind, tmp_path):
    definition, fill, text = MADE[name]
    path = write_points(tmp_path, kind, definition, fill)
    _, shots, report = read(path, rig=with_fields(text))

    assert len(shots) == 3
    found, known = shots[1], np.argsort(since_us(ROOM), kind="stable")
    truth = np.column_stack([ROOM[axis] for axis in "xyz"])[known]
    np.testing.assert_allclose(found.xyz, truth, atol=2e-3)
    expected = T0_NS + STEP_NS + since_us(ROOM)[known].astype(np.int64) * 1000
    np.testing.assert_allclose(found.t_ns - T0_NS, expected - T0_NS, atol=1100)
    np.testing.assert_array_equal(found.ring, ROOM["ring"][known])
    assert (found.intensity == 40).all()
    assert not report.findings and not report.counts["clouds_wrong_times"]


@pytest.mark.parametrize("name", MADE)
def test_info_proposes_the_recipe_ready_for_a_rig_file(name, tmp_path):
    definition, fill, text = MADE[name]
    found = describe(write_points(tmp_path, "mcap", definition, fill))

    line = recipe(text).toml()
    assert parse_rig(found.first_rig, where="rig").sensors[0].fields.text() == text
    assert [line in one for one in found.missing if "GNSS" not in one] == [True]
    assert line in "\n".join(found.lines())


def test_a_walk_is_read_with_the_rig_that_info_wrote(tmp_path, capsys):
    path = write_points(tmp_path, "bag1", STRUCTURES, in_millimeters)
    rig = tmp_path / "rig.toml"

    assert main(["info", str(path), "--rig-out", str(rig)]) == 0
    _, shots, _ = read(path, rig=load_rig(rig))
    assert [len(one) for one in shots] == [len(ROOM["x"])] * 3
    text = MADE["structures"][2]
    assert main(["info", str(path), "--fields", text]) == 0
    assert "fields" in capsys.readouterr().out


def test_without_a_recipe_the_points_are_refused_with_the_proposed_one(tmp_path):
    path = write_points(tmp_path, "mcap", STRUCTURES, in_millimeters)

    with pytest.raises(RigToComplete, match=r"/own: fields = \{ x = \"px_mm:mm\""):
        read(path)


def test_what_is_uncertain_is_said_with_its_column(tmp_path):
    table = {f"p{axis}": ROOM[axis] * 1000.0 for axis in "xyz"}
    table |= {"forward": ROOM["x"], "stamp": since_us(ROOM), "i": ROOM["intensity"]}
    proposal = propose("/points", {"points": table}, 0.1)

    assert proposal.recipe.text() == "x=px:mm,y=py:mm,z=pz:mm,time=stamp:us,intensity=i"
    report = ImportReport()
    say_doubts("/points", proposal, report)
    english, german = (
        "\n".join(derived_text(one, language) for one in report.derived)
        for language in ("en", "de")
    )
    assert "Uncertain: /points: x: px, or forward." in english
    assert "time: the unit of stamp is us by its values" in english
    assert "x: the unit of px is mm by its values" in english
    assert "Unsicher: /points: time: die Einheit von stamp ist nach ihren Werten us." in german


def pointcloud2(tmp_path, table, kind="mcap"):
    path = bag_path(tmp_path, kind)
    with Bag(path, kind) as bag:
        for k in range(3):
            bag.cloud("/points", T0_NS + k * STEP_NS, table)
    return path


@pytest.mark.parametrize("kind", ["bag1", "mcap"])
def test_a_cloud_with_unusual_names_is_read_by_its_recipe(kind, tmp_path):
    table = {"px": ROOM["x"], "Py": ROOM["y"], "pz": ROOM["z"], "refl": ROOM["intensity"]}
    table |= {"timestamp_ns": since_us(ROOM).astype(np.float64) * 1e3 + T0_NS}
    path = pointcloud2(tmp_path, table, kind)

    with pytest.raises(RigToComplete, match='x = "px", y = "py", z = "pz", time = "timestamp_ns'):
        read(path)
    text = "x=px,y=Py,z=pz,time=timestamp_ns:ns,intensity=refl"
    _, shots, _ = read(path, rig=with_fields(text, "/points"))
    assert [len(one) for one in shots] == [len(ROOM["x"])] * 3
    np.testing.assert_allclose(np.ptp(shots[0].t_ns), np.ptp(since_us(ROOM)) * 1000.0, atol=2000)


def test_a_column_that_looks_like_the_time_of_a_cloud_that_has_none_is_named(tmp_path):
    table = {axis: ROOM[axis] for axis in "xyz"} | {"point_time_us": since_us(ROOM)}

    found = describe(pointcloud2(tmp_path, table))

    assert any("time = point_time_us:us" in text for text in derivations(found))


def test_seconds_and_nanoseconds_in_two_columns_are_named(tmp_path):
    whole, rest = np.divmod(T0_NS + since_us(ROOM).astype(np.int64) * 1000, 10**9)
    times = {"timestampSec": whole.astype(np.uint32), "timestampNsec": rest.astype(np.uint32)}

    found = describe(pointcloud2(tmp_path, {axis: ROOM[axis] for axis in "xyz"} | times))

    assert any("time = timestampsec:s+timestampnsec:ns" in text for text in derivations(found))


@pytest.mark.parametrize(
    ("name", "wrong", "words"),
    [
        ("structures", ("t_us:us", "t_us:ns"), r"time = 't_us:ns'.*in us they would"),
        ("structures", ("t_us:us", "t_us:ms"), r"spread over 96\.67 s, expected about 0.1 s"),
        ("structures", ("px_mm:mm", "px_mm"), r"x = 'px_mm': half of .*in cm or mm they would be"),
        ("structures", ("time=t_us:us", "time=timebase:ns"), "all points of a cloud have one time"),
        ("structures", ("ring=laser_id", "ring=timebase"), "ring = 'timebase': expected whole"),
        ("structures", ("px_mm", "missing"), "no column 'missing'; there are px_mm, py_mm"),
        ("arrays", ("x=x,y=y,z=z", "x=z,y=y,z=x"), "cones about the column of x, expected about z"),
        ("arrays", ("x=x,y=y,z=z", "x=x,y=z,z=y"), "cones about the column of y, expected about z"),
        ("polar", ("azimuth:deg", "azimuth:rad"), "azimuth = 'azimuth:rad': angles from"),
        ("polar", ("elevation:deg", "elevation:rad"), "elevation = 'elevation:rad': angles from"),
        ("polar", ("distance_mm:mm", "distance_mm:m"), "range = 'distance_mm:m': half of"),
    ],
)
def test_a_wrong_recipe_is_refused_before_anything_is_mapped(name, wrong, words, tmp_path):
    definition, fill, text = MADE[name]
    path = write_points(tmp_path, "mcap", definition, fill)
    changed = text.replace(*wrong)
    if wrong[0].startswith("px_mm"):  # one unit for all axes
        changed = changed.replace("py_mm:mm", "py_mm").replace("pz_mm:mm", "pz_mm")

    with pytest.raises(ConfigError, match=words):
        read(path, rig=with_fields(changed))


def test_points_that_are_mirrored_are_a_warning(tmp_path):
    definition, fill, text = MADE["arrays"]
    path = write_points(tmp_path, "mcap", definition, fill)

    _, _, report = read(path, rig=with_fields(text.replace("x=x,y=y", "x=y,y=x")))
    assert warned(report, K.POINTS_TURN_LEFT)
    _, _, report = read(path, rig=with_fields(text.replace("y=y", "y=-y")))
    assert warned(report, K.POINTS_TURN_LEFT)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x=a,y=b", "lists: x, y, z; range, azimuth, elevation; .*; got x, y"),
        ("x=a,y=b,z=c,range=d", "got x, y, z, range"),
        ("x=a,y=b,z=b", "the column 'b' has two roles"),
        ("x=a:ft,y=b,z=c", "x: expected one of m, cm, mm, or a number of m, got 'ft'"),
        ("x=a,y=b,z=c,ring=d:m", "ring: expected no unit, got 'm'"),
        ("x=a,y=b,z=c,time=s+n", "times may be a sum of up to 3 columns that have units"),
        ("x=a,y=b,z=c,time=-t:s", "time cannot be negative"),
        ("x=a,y=b,z=c,color=d", "a role of x, y, z"),
        ("x=a,x=b", "x is given twice"),
        ("x=a:1e9,y=b,z=c", "got '1e9'"),
        ("nonsense", "expected ROLE=COLUMN"),
    ],
)
def test_a_recipe_that_makes_no_sense_is_refused_with_its_place(text, words):
    with pytest.raises(ConfigError, match=words):
        recipe(text)


def test_a_rig_file_keeps_the_recipe_of_its_sensor():
    text = "range=d:0.004,azimuth=-az:0.01,zenith=polar,time=base:ns+offset:us,ring=beam"
    rig = with_fields(text)

    again = parse_rig(format_rig(rig), where="rig")
    assert again.sensors[0].fields.text() == text
    table = format_rig(rig).replace(recipe(text).toml(), "") + "\n"
    assert "fields" not in table
    with pytest.raises(ConfigError, match=r"rig: sensor 0: fields: unknown \['color2'\]"):
        parse_rig('name="a"\n[[sensor]]\nname="b"\n[sensor.fields]\ncolor2="c"', where="rig")


def test_times_are_sums_of_columns_and_of_numbers_of_the_message():
    lists = {
        "pts": {axis: np.ones(3) for axis in "xyz"} | {"dt": np.array([0, 1, 2], np.uint16)},
        "*": {"base": np.array([7])},
    }
    found = as_points(recipe("x=x,y=y,z=z,time=base:s+dt:us"), lists)

    assert found["time [ns]"].tolist() == [7_000_000_000, 7_000_001_000, 7_000_002_000]


def test_one_of_two_lists_is_chosen_by_its_name():
    axes = {axis: np.ones(2) for axis in "xyz"}
    lists = {"first": axes, "second": {k: 2.0 * v for k, v in axes.items()}}

    assert as_points(recipe("x=second.x,y=second.y,z=second.z"), lists)["x"].tolist() == [2, 2]
    with pytest.raises(CorruptFile, match=r"no column 'third\.x'"):
        as_points(recipe("x=third.x,y=y,z=z"), lists)


def test_a_counter_of_microseconds_that_begins_again_in_a_cloud_goes_on():
    counter = (np.arange(5, dtype=np.int64) * 1000 + 2**32 - 2500).astype(np.uint32)
    axes = {axis: np.ones(5) for axis in "xyz"}
    found = as_points(recipe("x=x,y=y,z=z,time=t:us"), {"p": axes | {"t": counter}})

    assert np.diff(found["time [ns]"]).tolist() == [1_000_000] * 4


def test_a_folder_of_clouds_is_read_by_a_recipe_and_gets_a_proposed_one(tmp_path):
    table = {f"p{axis}": ROOM[axis] for axis in "xyz"} | {"t_us": since_us(ROOM)}
    folder = tmp_path / "clouds"
    folder.mkdir()
    for k in range(3):
        write_pcd(folder / f"{T0_NS + k * STEP_NS}.pcd", table)

    found = describe(folder)
    text = "x=px,y=py,z=pz,time=t_us:us"
    assert parse_rig(found.first_rig, where="rig").sensors[0].fields.text() == text
    rig = single_rig(Stream("clouds", "generic", fields=recipe(text)))
    recording, _, _ = read(folder, rig=rig)
    assert all(len(frame.xyz) == len(ROOM["x"]) for frame in recording.read())


def test_a_recipe_for_columns_that_two_topics_have_needs_a_rig_file(tmp_path):
    path = bag_path(tmp_path, "mcap")
    with Bag(path, "mcap") as bag:
        for topic in ("/left", "/right"):
            bag.cloud(topic, T0_NS, {f"p{axis}": ROOM[axis] for axis in "xyz"})

    with pytest.raises(ConfigError, match="/left, /right have these columns: say in a rig file"):
        describe(path, fields=recipe("x=px,y=py,z=pz"))


def test_lists_that_are_no_points_of_a_lidar_are_not_named_beside_one(tmp_path):
    path = bag_path(tmp_path, "mcap")
    boxes = "std_msgs/Header header\nfloat32[] width\nfloat32[] height\nfloat32[] score\n"
    with Bag(path, "mcap") as bag:
        register(bag.store, "my_driver/msg/Points", boxes)
        for k in range(3):
            bag.cloud("/points", T0_NS + k * STEP_NS, ROOM)
    _, shots, report = read(path)

    assert len(shots) == 3 and not any("not read" in text.lower() for text in derivations(report))
    assert isinstance(report, ImportReport)
