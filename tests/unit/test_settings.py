"""Settings: declared once, changed by assignments, validated with messages."""

import ast
import inspect
import pickle
import re
import typing
from dataclasses import FrozenInstanceError, fields, is_dataclass
from pathlib import Path

import pytest

from recon4 import settings as declared
from recon4.errors import ConfigError, WrongSettings
from recon4.pose_graph.tuning import graph_tuning
from recon4.registration.tuning import (
    OverlapTuning,
    PlaneTuning,
    ScanTuning,
    SegmentTuning,
    registration_tuning,
)
from recon4.settings import PRESETS, Settings, canonical, override, preset, to_json, values_by_group
from recon4.settings.help import describe_settings, differences, markdown
from recon4.settings.renamed import RENAMED, current_values, retired
from recon4.slam2d.tuning import HectorTuning
from tests.tuned import COMPLETE_RECORDS

RECORDS = {
    **COMPLETE_RECORDS,
    "segments": SegmentTuning,
    "overlap": OverlapTuning,
    "planes": PlaneTuning,
    "scans": ScanTuning,
    "hector": HectorTuning,
}
"""Group of earlier versions -> the record that has its values now."""
ROOT = Path(__file__).parents[2]


def test_one_text_changes_one_setting():
    changed = override(Settings(), ["map.voxel_m=0.05"])

    assert differences(changed) == {"map.voxel_m": 0.05}


def test_texts_are_applied_in_order_and_blanks_do_not_matter():
    changed = override(Settings(), ["map.voxel_m = 0.05", " map.voxel_m=0.02 "])

    assert changed.map.voxel_m == 0.02


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("graph.node_stride=3", 3),
        ("graph.exhaustive=true", True),
        ("graph.exhaustive=False", False),
        ("graph.mode=10", "10"),
        ("map.voxel_m=1e-2", 0.01),
        ("gnss.crs=EPSG:5514+8357", "EPSG:5514+8357"),
    ],
)
def test_every_kind_of_value_is_understood(text, value):
    changed = override(Settings(), [text])

    group, name = text.split("=")[0].split(".")
    assert getattr(getattr(changed, group), name) == value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("map.voxel_m", r"expected group\.field=value, got 'map\.voxel_m'"),
        ("voxel_m=1", r"expected group\.field=value"),
        ("maps.voxel_m=1", r"no setting group 'maps'; known: .*'map'"),
        ("map.voxel=1", r"no setting 'map\.voxel'; known in map: .*'voxel_m'"),
        ("map.voxel_m=thick", r"map\.voxel_m must be float, got 'thick'"),
        ("graph.node_stride=2.5", r"graph\.node_stride must be int, got '2\.5'"),
        ("graph.exhaustive=yes", r"graph\.exhaustive must be true or false, got 'yes'"),
        (
            "graph.mode=11",
            r"graph\.mode must be one of 10, overlap, verification, beyond, got '11'",
        ),
        ("ingest.rate_hz=1000", "rate_hz must be 0 to 100, got 1000"),
        ("ingest.rate_hz=0.1", "rate_hz must be 0 or at least 0.5, got 0.1"),
        ("__class__.x=1", "no setting group '__class__'"),
    ],
)
def test_a_wrong_text_is_refused_with_what_was_expected(text, message):
    with pytest.raises(ConfigError, match=message):
        override(Settings(), [text])


def test_all_wrong_settings_are_reported_together():
    texts = [
        "map.voxel_m=thick",
        "maps.x=1",
        "nonsense",
        "segments.azimuth_bins=3",
        "segments.preserved=0",
        "ingest.min_range_m=500",
        "graph.node_stride=2",
    ]

    with pytest.raises(WrongSettings) as refused:
        override(Settings(), texts)

    assert refused.value.problems.keys() == {
        "map.voxel_m",
        "maps.x",
        "nonsense",
        "segments.azimuth_bins",
        "segments.preserved",
        "ingest.min_range_m",
    }
    assert "segments.preserved is no setting anymore: fixed at 5, not 0" in str(refused.value)
    assert "min_range_m must be below max_range_m" in str(refused.value)
    assert str(pickle.loads(pickle.dumps(refused.value))) == str(refused.value)


def test_two_settings_that_only_fit_together_may_be_changed_together():
    changed = override(Settings(), ["ingest.min_range_m=200", "ingest.max_range_m=300"])

    assert changed.ingest.min_range_m == 200.0


def test_an_unknown_preset_is_rejected_with_the_known_ones():
    with pytest.raises(ConfigError, match="there are: hector, indoor, outdoor, thesis"):
        preset("forest")


def test_the_thesis_preset_is_the_documents_algorithm():
    thesis = preset("thesis")

    assert thesis.registration.solver == "svd"
    assert registration_tuning(thesis.registration).max_iterations == 500
    assert graph_tuning(thesis.graph).source_reach == 0
    assert thesis.graph.mode == "verification"
    assert not thesis.odometry.use_imu


def test_an_earlier_preset_is_the_one_with_the_same_settings():
    assert preset("staircase") == preset("indoor")


def test_a_retired_setting_is_accepted_at_its_value_and_refused_at_another_one():
    assert override(Settings(), ["loops2d.revisits=3"]) == Settings()

    with pytest.raises(ConfigError) as refused:
        override(Settings(), ["loops2d.revisits=5", "hector.levels=1"])

    assert "loops2d.revisits is no setting anymore: fixed at 3, not 5 (Largest" in str(
        refused.value
    )
    assert "hector.levels is no setting anymore: fixed at 3, not 1 (Number" in str(refused.value)


def test_every_retired_setting_has_a_text_and_is_no_setting():
    now = {(group.name, s.name) for group in describe_settings() for s in group.settings}

    assert all(fixed.text for fixed in retired().values())
    assert not now & retired().keys()
    assert all((group, new) in {*now, *retired()} for (group, _), new in RENAMED.items())


@pytest.mark.parametrize(
    ("recorded", "topic"),
    [
        ({"lidar_topic": "", "laser_topic": "/scan"}, "/scan"),
        ({"lidar_topic": "/points", "laser_topic": ""}, "/points"),
        ({"laser_topic": "", "lidar_topic": ""}, ""),
    ],
)
def test_of_two_settings_that_are_one_now_the_named_topic_counts(recorded, topic):
    assert current_values("ingest", recorded) == {"lidar_topic": topic}


def test_there_are_at_most_sixty_settings_and_each_is_varied_by_a_preset_or_a_test():
    paths = [s.path for group in describe_settings() for s in group.settings]
    tests = "\n".join(
        path.read_text("utf-8")
        for path in (ROOT / "tests").rglob("*.py")
        if path.name != "test_settings.py"
    )
    preset = {path for settings in PRESETS.values() for path in differences(settings)}
    tested = {path for path in paths if re.search(rf"\b{path.split('.')[1]}=", tests)}

    assert len(paths) <= 60, (
        f"{len(paths)} settings: first make tuning of one that nobody sets (CONTRIBUTING, A "
        f"setting); no preset sets {', '.join(sorted(set(paths) - preset))}"
    )
    alone = set(paths) - preset - tested
    assert not alone, (
        f"add a test with another value than the default, as NAME=VALUE in a settings record, or "
        f"set it in a preset: {', '.join(sorted(alone))}"
    )


def test_the_value_of_each_retired_setting_is_that_of_its_tuning():
    for (group, name), fixed in retired().items():
        assert getattr(RECORDS[group](), name) == fixed.value, f"{group}.{name}"


def test_every_number_has_a_range_that_its_default_and_the_presets_are_in():
    for settings in PRESETS.values():
        values = values_by_group(settings)
        for group in describe_settings():
            for one in group.settings:
                if one.kind in {"int", "float"}:
                    value = values[group.name][one.name]
                    assert one.limits is not None, one.path
                    assert one.limits.low <= value <= one.limits.high, one.path


def test_settings_are_immutable():
    with pytest.raises(FrozenInstanceError):
        Settings().map.voxel_m = 1.0


def test_the_canonical_text_is_equal_for_equal_settings_only():
    a = override(Settings(), ["map.voxel_m=0.5", "graph.node_stride=2"])
    b = override(Settings(), ["graph.node_stride=2", "map.voxel_m=0.5"])

    assert canonical(a) == canonical(b)
    assert canonical(a) != canonical(Settings())
    assert to_json(a)["map"]["voxel_m"] == 0.5


def test_every_numeric_setting_has_a_unit_or_an_explanation():
    units = ("_m", "_s", "_hz", "_rad", "_deg", "_ns", "_m_s2", "_rad_s", "_bins")
    silent = [
        setting.path
        for group in describe_settings()
        for setting in group.settings
        if not setting.text and not setting.name.endswith(units)
    ]

    assert silent == []


def test_the_help_knows_every_setting_and_the_text_under_it():
    found = {s.path: s for group in describe_settings() for s in group.settings}
    all_paths = {
        f"{group.name}.{f.name}"
        for group in fields(Settings)
        for f in fields(typing.get_type_hints(Settings)[group.name])
    }

    assert set(found) == all_paths
    assert "``EPSG:5514+8357``. Empty = UTM zone" in found["gnss.crs"].text
    assert found["map.voxel_m"].default == Settings().map.voxel_m
    assert found["graph.mode"].kind == "`10`, `overlap`, `verification`, `beyond`"


def test_no_text_stands_under_the_wrong_field():
    source = ast.parse(inspect.getsource(declared))
    for node in source.body:
        if isinstance(node, ast.ClassDef) and is_dataclass(getattr(declared, node.name)):
            strings = [
                below
                for below in node.body[1:]
                if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant)
            ]
            after = {
                id(b)
                for a, b in zip(node.body, node.body[1:], strict=False)
                if isinstance(a, ast.AnnAssign)
            }
            assert all(id(string) in after for string in strings), node.name


def test_the_page_about_settings_is_up_to_date():
    page = (ROOT / "docs" / "reference" / "settings.md").read_text("utf-8")

    assert page == markdown(), "run `make docs`"


def test_the_page_names_every_preset_and_what_it_changes():
    page = markdown()

    for name, settings in PRESETS.items():
        assert f"| `{name}` |" in page
        assert all(f"`{path}=" in page for path in differences(settings))
