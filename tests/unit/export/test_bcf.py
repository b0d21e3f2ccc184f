"""Notes as BCF 3.0: the elements that its schemas require, in their order, and the camera."""

import io
import re
import zipfile
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from recon4.export import bcf
from recon4.export.bcf import BcfNote, NoteCamera, notes_bcf

GUID = re.compile(r"[a-f0-9]{8}-[a-f0-9]{4}-[a-f0-9]{4}-[a-f0-9]{4}-[a-f0-9]{12}")
TIME = "2026-11-27T10:00:00.000+00:00"
TOPIC = ["Title", "Index", "CreationDate", "CreationAuthor", "ModifiedDate", "ModifiedAuthor"]
TOPIC += ["Description", "Viewpoints"]
"""Elements of a topic in the order of markup.xsd."""


def note(**more):
    given = dict(id="a1", text="a crack", status="open", who="Eva", time=TIME, changed_by="Eva")
    return BcfNote(**{**given, "changed": TIME, "p_map": (1.0, 2.0, 3.0), **more})


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Writes notes of a map that is not georeferenced; name -> bytes."""
    monkeypatch.setattr(bcf, "read_artifacts", lambda project: {})

    def write(*notes):
        with zipfile.ZipFile(io.BytesIO(notes_bcf(tmp_path, "Office & co", notes))) as archive:
            assert archive.testzip() is None
            return {name: archive.read(name) for name in archive.namelist()}

    return write


def xml_of(files, name):
    (found,) = [data for path, data in files.items() if path.split("/")[-1] == name]
    return ET.fromstring(found)


def vector(root, name):
    return np.array([float(root.find(f".//{name}/{axis}").text) for axis in "XYZ"])


def test_a_file_has_what_the_schemas_require(written):
    files = written(note(changed="2026-11-27T11:00:00.000+00:00", changed_by="Jan", status="done"))

    assert xml_of(files, "bcf.version").attrib == {"VersionId": "3.0"}
    extensions = xml_of(files, "extensions.xml")
    assert [one.tag for one in extensions] == [
        *("TopicTypes", "TopicStatuses", "Priorities", "TopicLabels", "Users"),
        *("SnippetTypes", "Stages"),
    ]
    assert [one.text for one in extensions.find("Users")] == ["Eva", "Jan"]
    assert xml_of(files, "project.bcfp").findtext("Project/Name") == "Office & co"
    (topic,) = xml_of(files, "markup.bcf")
    assert [one.tag for one in topic] == TOPIC
    assert topic.attrib["TopicType"] in [one.text for one in extensions.find("TopicTypes")]
    assert topic.attrib["TopicStatus"] == "Closed"
    assert topic.attrib["TopicStatus"] in [one.text for one in extensions.find("TopicStatuses")]
    assert f"{topic.attrib['Guid']}/markup.bcf" in files and GUID.fullmatch(topic.attrib["Guid"])
    view = topic.find("Viewpoints/ViewPoint")
    shown = xml_of(files, view.findtext("Viewpoint"))
    assert shown.attrib["Guid"] == view.attrib["Guid"] and view.find("Snapshot") is None
    assert [one.tag for one in shown] == ["Components", "PerspectiveCamera"]
    assert [one.tag for one in shown[1]] == [
        *("CameraViewPoint", "CameraDirection", "CameraUpVector", "FieldOfView", "AspectRatio"),
    ]


def test_without_a_camera_the_place_is_in_the_middle_of_the_view(written):
    root = xml_of(written(note()), "viewpoint.bcfv")

    eye, ahead = vector(root, "CameraViewPoint"), vector(root, "CameraDirection")
    to_place = np.array([1.0, 2.0, 3.0]) - eye
    np.testing.assert_allclose(ahead, to_place / np.linalg.norm(to_place), atol=1e-12)
    up = vector(root, "CameraUpVector")
    assert abs(up @ ahead) < 1e-12 and up[2] > 0.0


def test_the_camera_and_the_photo_are_those_of_the_author(written):
    seen = NoteCamera((0.0, 0.0, 9.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0), True, 12.0, 1.5)
    files = written(note(camera=seen, photo=b"jpeg"))

    root = xml_of(files, "viewpoint.bcfv")
    assert root.findtext("OrthogonalCamera/ViewToWorldScale") == "12.0"
    assert root.findtext("OrthogonalCamera/AspectRatio") == "1.5"
    np.testing.assert_array_equal(vector(root, "CameraDirection"), (0.0, 0.0, -1.0))
    (topic,) = xml_of(files, "markup.bcf")
    name = topic.findtext("Viewpoints/ViewPoint/Snapshot")
    assert files[f"{topic.attrib['Guid']}/{name}"] == b"jpeg"


def test_a_georeferenced_map_turns_the_camera_into_its_grid(tmp_path, monkeypatch):
    class Grid:
        """East of the map is north of the grid, 1000 m away."""

        def to_crs(self, p_map):
            turned = np.column_stack([-p_map[:, 1], p_map[:, 0], p_map[:, 2]])
            return turned + np.array([500_000.0, 5_000_000.0, 100.0])

    monkeypatch.setattr(bcf, "read_artifacts", lambda project: {"level": tmp_path})
    monkeypatch.setattr(bcf, "read_crs", lambda folder: Grid())
    seen = NoteCamera((10.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    with zipfile.ZipFile(io.BytesIO(notes_bcf(tmp_path, "x", [note(camera=seen)]))) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}

    root = xml_of(files, "viewpoint.bcfv")
    np.testing.assert_allclose(
        vector(root, "CameraViewPoint"), (500_000.0, 5_000_010.0, 101.0), atol=1e-6
    )
    np.testing.assert_allclose(vector(root, "CameraDirection"), (0.0, 1.0, 0.0), atol=1e-6)


def test_any_text_is_well_formed_and_the_same_notes_are_the_same_bytes(written):
    text = "a <b> & \x0b ]]> \ud83d" + "x" * 200 + "\nsecond line"
    text = text.encode("utf-8", "replace").decode()

    files = written(note(text=text))

    (topic,) = xml_of(files, "markup.bcf")
    assert topic.findtext("Description").startswith("a <b> & \N{REPLACEMENT CHARACTER} ]]>")
    assert len(topic.findtext("Title")) == 80
    assert files == written(note(text=text))


def test_no_text_is_blank_as_the_schemas_forbid(written):
    files = written(note(text=" \n", who=" ", changed_by="", changed="2026-11-27T11:00:00Z"))

    (topic,) = xml_of(files, "markup.bcf")
    users = [one.text for one in xml_of(files, "extensions.xml").find("Users")]
    assert topic.findtext("CreationAuthor") == "unknown" and users == ["unknown"]
    assert topic.findtext("Title") == "Note"
    leaves = [one for name in files for one in ET.fromstring(files[name]).iter() if not len(one)]
    assert [one.tag for one in leaves if one.text is not None and not one.text.strip()] == []
    assert {"Description", "ModifiedAuthor"}.isdisjoint(one.tag for one in topic)
