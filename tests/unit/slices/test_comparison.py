"""Comparison of maps with references, and alignment of references with maps."""

import re
from dataclasses import asdict, replace

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText, StoredText
from recon4.slices.align import align_by_icp, align_by_pairs, align_level_pairs, floor_offset
from recon4.slices.compare import compare, to_csv, usual_planes
from recon4.slices.reference import alignment_text, load_reference, read_facts
from recon4.slices.reference_import import import_reference, set_alignment, undo_alignment
from recon4.slices.slice_plane import SlicePlane
from recon4.store.atomic import write_json
from tests.unit.slices.room_map import wall, write_map
from tests.unit.slices.test_references import BOX, reference_wall, write_mesh

X_M = 62 * 2.0**-11
"""A place of a wall that a tile stores exactly, about 3 cm."""


def test_the_table_says_how_far_the_map_is_off_and_to_which_side(tmp_path):
    p, normal = wall(np.random.default_rng(2), 20_000, x_m=X_M, sigma_m=0.0)
    tiles = write_map(tmp_path / "map", p, normal=normal.astype(np.float16))
    reference = reference_wall(tmp_path)

    found = compared(
        tiles, [SlicePlane.horizontal(0.5, thickness_m=0.2), SlicePlane.horizontal(9.0)], reference
    )

    first, second = found.slices
    assert first.mean_m == pytest.approx(X_M, abs=1e-4)
    assert (first.ratio_within_2cm, first.ratio_within_5cm) == (0.0, 1.0)
    assert first.signed.mean_m == pytest.approx(X_M, abs=1e-4)  # towards the one who saw it
    assert first.signed.sd_m < 1e-4 and first.signed.points == first.points
    assert first.signed.shift_m == (pytest.approx(X_M, abs=1e-4), None, None)
    assert second.mean_m is second.signed.mean_m is None
    assert found.point_weighted.mean_m == pytest.approx(found.plain_mean_m)
    at = int(np.argmax(found.histogram))
    assert found.histogram[at] == first.points
    assert at * found.histogram_step_m - found.histogram_end_m == pytest.approx(0.03, abs=0.003)
    rows = to_csv(found).splitlines()
    assert "# against wall.xyz: ✓ The reference fits" in to_csv(found)
    assert rows[1].split(",")[3:] == [
        *("3.03", "0.00", "100.00", str(first.points), "3.03", "0.00", "3.03", "–", "–"),
    ]
    assert rows[2] == "z = 9.000 m,0,0,–,–,–,0,–,–,–,–,–"


def test_the_table_says_how_the_reference_was_read_and_aligned(tmp_path):
    p, normal = wall(np.random.default_rng(2), 5000, x_m=0.03, sigma_m=0.0)
    tiles = write_map(tmp_path / "map", p, normal=normal.astype(np.float16))
    reference = reference_wall(tmp_path)
    facts = read_facts(reference.folder)
    feet = CodedText("note-unit-converted", unit="US survey feet")
    notes = (StoredText.of(feet), StoredText(text="As a later version may say."))
    write_json(reference.folder / "reference.json", asdict(replace(facts, notes=notes)))
    by_icp = CodedText("alignment-icp", near=0.9, on=0.8, mean_m=0.004)
    set_alignment(reference.folder, SE3.identity(), steps=(CodedText("alignment-by-hand"), by_icp))

    found = compared(
        tiles, [SlicePlane.horizontal(0.5)], load_reference(reference.folder, method="point")
    )

    remarks = [line for line in to_csv(found).splitlines() if line.startswith("# ")]
    assert remarks[1:5] == [
        "# distances: to its nearest point (V)",
        "# alignment of the reference: moved by hand; ICP, point to plane: 90 % of the map near "
        "it, of these 80 % on it, 0.4 cm from it on average",
        "# reference: Coordinates in US survey feet, converted to meters.",
        "# reference: As a later version may say.",
    ]


def test_statements_of_an_earlier_version_stay_as_they_were_written(tmp_path):
    folder = reference_wall(tmp_path).folder
    record = asdict(read_facts(folder))
    old = {"T_map_reference": record["T_map_reference"], "alignment": "none"}
    written = {"alignment": "ICP, mean 4 mm", "fit": "✓ It fits", "notes": ["In\u202efeet."]}
    write_json(folder / "reference.json", record | written | {"earlier": old})

    facts = read_facts(folder)

    assert alignment_text(facts.alignment, "de") == "ICP, mean 4 mm"
    assert [one.text for one in (*facts.fit, *facts.notes)] == ["✓ It fits", "In<U+202E>feet."]
    assert facts.fits is None and undo_alignment(folder).alignment == ()


def test_what_is_said_of_a_reference_is_german_with_german_numbers(tmp_path):
    p, normal = wall(np.random.default_rng(2), 5000, x_m=X_M, sigma_m=0.0)
    tiles = write_map(tmp_path / "map", p, normal=normal.astype(np.float16))
    reference = reference_wall(tmp_path)

    found = compared(tiles, [SlicePlane.horizontal(0.5)], reference, language="de")

    assert found.alignment == "keine"
    assert re.match(r"✓ Die Referenz passt: .* 100 % der Wände näher als 10 cm ", found.fit.text)
    pairs = CodedText("alignment-pairs", pairs=3, largest_m=0.042, each_cm="1.0 4.2 0.3")
    assert pairs.said("de") == ("3 Paare, größter Restfehler 4,2 cm (je Paar [cm]: 1,0; 4,2; 0,3)")
    far = CodedText("align-far", near=0.005, limit_cm=50)
    assert far.said("de").startswith("ICP: ✕ Die Referenz passt nicht: 0,5 % der Karte liegen ")


def compared(tiles, planes, reference, **options):
    return compare(tiles, planes, reference, rng=np.random.default_rng(1), **options)


def seen_box(rng, *, T=None, noise_m=0.005):
    """Points inside the box as seen from its middle, with normals, moved by ``T``."""
    T = T or SE3.identity()
    low, high = BOX.bounds()
    points, normals = [], []
    for axis in range(3):
        for end, sign in ((low[axis], 1.0), (high[axis], -1.0)):
            side = low + rng.uniform(size=(6000, 3)) * (high - low)
            side[:, axis] = end + noise_m * rng.standard_normal(len(side))
            points.append(side)
            normals.append(np.tile(sign * np.eye(3)[axis], (len(side), 1)))
    return T @ np.concatenate(points), np.concatenate(normals) @ T.R.T


@pytest.mark.parametrize(
    "shift_m", [(0.03, 0.0, 0.0), (0.0, -0.02, 0.0), (0.01, 0.0, -0.04)], ids=["x", "y", "xz"]
)
@pytest.mark.parametrize("method", ["plane", "point"])
@pytest.mark.study
def test_a_shifted_map_is_known_by_its_shift_though_its_signs_cancel(tmp_path, shift_m, method):
    p, normal = seen_box(np.random.default_rng(2), T=SE3(np.eye(3), np.array(shift_m)))
    tiles = write_map(tmp_path / "map", p, normal=normal.astype(np.float16))
    cloud, _ = seen_box(np.random.default_rng(3), noise_m=0.0)
    np.savetxt(tmp_path / "cloud.xyz", cloud, fmt="%.4f")
    import_reference(tmp_path / "cloud.xyz", tmp_path / "reference")

    found = compared(
        tiles,
        usual_planes(tiles, thickness_m=0.2),
        load_reference(tmp_path / "reference", method=method),
    )

    together = found.point_weighted.signed
    assert together.shift_m == pytest.approx(shift_m, abs=0.003)
    assert abs(together.mean_m) < 0.004 and together.sd_m > 0.005
    assert found.fit.fits and found.fit.walls_ratio > 0.9


def test_a_map_that_is_larger_than_the_reference_has_a_signed_mean_and_no_shift(
    tmp_path, box_reference
):
    p, normal = seen_box(np.random.default_rng(2))
    tiles = write_map(tmp_path / "map", p - 0.02 * normal, normal=normal.astype(np.float16))

    found = compared(tiles, usual_planes(tiles, thickness_m=0.2), box_reference)

    assert found.point_weighted.signed.mean_m == pytest.approx(-0.02, abs=0.002)
    assert found.point_weighted.signed.shift_m == pytest.approx((0.0, 0.0, 0.0), abs=0.002)
    assert [one.position.text for one in found.slices] == [one.name for one in found.slices]
    assert {one.position.azimuth_deg for one in found.slices} == {0.0, 90.0}
    assert found.point_weighted.position is None


def test_a_map_without_normals_has_distances_without_sign(tmp_path, box_reference):
    p, _ = seen_box(np.random.default_rng(2))

    found = compared(write_map(tmp_path / "map", p), [SlicePlane.horizontal(1.0)], box_reference)

    assert found.point_weighted.mean_m < 0.01 and found.point_weighted.signed.mean_m is None
    assert found.fit.fits is None and found.fit.text.startswith("– Not judged")


@pytest.mark.parametrize(
    ("moved", "fits"),
    [
        (SE3.identity(), True),
        (SE3(np.eye(3), np.array([0.05, 0.0, 0.0])), True),
        (SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[3.5, -0.5, 0.0]), False),
        (SE3(np.eye(3), np.array([30.0, 0.0, 0.0])), False),
        (SE3(np.eye(3), np.array([0.0, 0.0, 0.3])), False),
    ],
    ids=["in place", "5 cm", "turned by 90 degrees", "elsewhere", "higher"],
)
def test_a_reference_that_does_not_fit_is_named(tmp_path, box_reference, moved, fits):
    p, normal = seen_box(np.random.default_rng(2))
    tiles = write_map(tmp_path / "map", p, normal=normal.astype(np.float16))
    set_alignment(tmp_path / "reference", moved)

    found = compared(tiles, [SlicePlane.horizontal(1.0)], load_reference(tmp_path / "reference"))

    assert found.fit.fits is fits
    assert ("does not fit" in found.fit.text) is not fits
    assert found.fit.text in to_csv(found)


def test_a_reference_of_one_room_of_the_map_fits(tmp_path, box_reference):
    p, normal = seen_box(np.random.default_rng(2))
    other = np.add(p, (20.0, 0.0, 0.0))
    tiles = write_map(
        tmp_path / "map",
        np.concatenate([p, other]),
        normal=np.concatenate([normal, normal]).astype(np.float16),
    )

    assert compared(tiles, [SlicePlane.horizontal(1.0)], box_reference).fit.fits


def test_eight_slices_are_spread_over_the_map(tmp_path):
    tiles = write_map(tmp_path, np.array([[0.0, 0.0, 0.0], [8.0, 8.0, 8.0]]))

    planes = usual_planes(tiles)

    assert [plane.origin_m[2] for plane in planes[:4]] == pytest.approx([1.0, 3.0, 5.0, 7.0])
    assert len(planes) == 8 and all(plane.thickness_m == 0.02 for plane in planes)


def test_pairs_of_points_lay_a_reference_onto_the_map():
    T = SE3.from_rpy(0.02, 0.01, 1.0, t=[3.0, 2.0, 1.0])
    q = np.array([[0, 0, 0], [4, 0, 0], [0, 3, 0], [1, 1, 2.0]])

    found, left_m = align_by_pairs(T @ q, q)

    assert np.abs(found.matrix() - T.matrix()).max() < 1e-9 and left_m.max() < 1e-9


def test_pairs_from_above_keep_the_reference_level_and_lay_floor_on_floor(tmp_path, box_reference):
    rng = np.random.default_rng(3)
    T = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[7.0, -3.0, 1.3])
    p, normal = seen_box(rng, T=T)
    tiles = write_map(tmp_path / "map", p, normal=normal.astype(np.float16))
    q = np.array([[0.0, 0.0, 0.3], [4.0, 0.0, 1.9], [0.0, 3.0, 1.0]])
    picked = T @ q + [[0.02, 0.0, 0.9], [0.0, -0.03, -0.7], [0.0, 0.0, 0.5]]  # any height

    up_m = floor_offset(tiles, box_reference, picked, p_reference=q, rng=rng)
    found, left_m = align_level_pairs(picked, q, up_m=up_m)

    assert up_m == pytest.approx(1.3, abs=0.01)
    assert np.abs(found.R[2] - [0.0, 0.0, 1.0]).max() < 1e-12
    assert np.abs((found @ BOX.vertices_m) - (T @ BOX.vertices_m)).max() < 0.05
    assert 0.0 < left_m.max() < 0.03


@pytest.mark.parametrize("q", [np.zeros((3, 3)), np.eye(3)[:2]])
def test_pairs_from_above_at_one_place_are_refused(q):
    with pytest.raises(ConfigError):
        align_level_pairs(q, q, up_m=0.0)


def test_a_turned_reference_is_not_aligned_by_its_floor(tmp_path, box_reference):
    rng = np.random.default_rng(3)
    p, normal = seen_box(rng, noise_m=0.003)
    inside = np.add(p, (0.0, 0.0, 0.0))
    tiles = write_map(tmp_path / "map", inside, normal=normal.astype(np.float16))
    turned = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[3.5, -0.5, 0.0])
    set_alignment(tmp_path / "reference", turned)

    with pytest.raises(ConfigError, match="use Align by pairs"):
        align_by_icp(tiles, load_reference(tmp_path / "reference"), rng=rng)


def test_an_alignment_is_undone_and_redone(tmp_path, box_reference):
    folder = tmp_path / "reference"
    T = SE3.from_rpy(0.0, 0.0, 0.3, t=[1.0, 0.0, 0.0])
    with pytest.raises(ConfigError, match="nothing to undo"):
        undo_alignment(folder)
    set_alignment(folder, T, steps=(CodedText("alignment-by-hand"),), fit="✓")

    undone, redone = undo_alignment(folder), undo_alignment(folder)

    assert (undone.alignment, undone.fit) == ((), ())
    assert alignment_text(redone.alignment, "de") == "von Hand verschoben"
    assert redone.fit == (StoredText(text="✓"),)
    assert np.abs(load_reference(folder).T_map_reference.matrix() - T.matrix()).max() < 1e-12


@pytest.mark.parametrize("q", [np.eye(3)[:2], np.outer(np.arange(4), [1.0, 2.0, 3.0])])
def test_pairs_that_leave_the_turn_open_are_refused(q):
    with pytest.raises(ConfigError):
        align_by_pairs(q + 1.0, q)


@pytest.fixture
def box_reference(tmp_path):
    write_mesh(tmp_path / "box.ply")
    import_reference(tmp_path / "box.ply", tmp_path / "reference")
    return load_reference(tmp_path / "reference")


def three_sides(rng, *, noise_m=0.0):
    sides = [rng.uniform(size=(8000, 3)) * [4, 3, 2] for _ in range(3)]
    for axis, side in enumerate(sides):
        side[:, axis] = noise_m * rng.standard_normal(len(side))
    return np.concatenate(sides)


def test_icp_finds_a_small_offset_and_says_what_remains(tmp_path, box_reference):
    rng = np.random.default_rng(3)
    T = SE3.from_rpy(0.0, 0.0, 0.02, t=[0.05, -0.03, 0.04])
    elsewhere = np.add(rng.uniform(size=(24_000, 3)), [9.0, 0.0, 0.0])
    p = np.concatenate([three_sides(rng, noise_m=0.01), elsewhere])
    tiles = write_map(tmp_path / "map", T @ p)

    found = align_by_icp(tiles, box_reference, rng=rng)

    assert np.abs(found.T_map_reference.matrix() - T.matrix()).max() < 2e-3
    assert found.near_ratio == pytest.approx(0.5, abs=0.02) and found.inlier_ratio > 0.99
    assert found.mean_m == pytest.approx(0.01 * np.sqrt(2.0 / np.pi), abs=0.001)
    assert "0.8 cm from it on average" in found.description


def test_icp_onto_something_else_is_refused(tmp_path, box_reference):
    rng = np.random.default_rng(3)
    bush = rng.uniform(size=(5_000, 3)) * [4, 3, 2]
    tiles = write_map(tmp_path / "map", bush)

    with pytest.raises(ConfigError, match="did not align the reference with the map"):
        align_by_icp(tiles, box_reference, rng=rng)


def test_icp_over_a_distance_is_refused(tmp_path, box_reference):
    rng = np.random.default_rng(3)
    tiles = write_map(tmp_path / "map", np.add(three_sides(rng), [20.0, 0.0, 0.0]))

    with pytest.raises(ConfigError, match=r"0\.0 % of the map is within 50 cm"):
        align_by_icp(tiles, box_reference, rng=rng)
