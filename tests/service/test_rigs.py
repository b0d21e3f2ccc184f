"""Rigs over HTTP: list, create, change, versions, uses, calibrated rigs."""

import json
from base64 import b64encode

import numpy as np
import pytest

from recon4.model.rig import format_rig, load_rig
from recon4.recording.packets.companions import described_in
from recon4.recording.packets.ouster.encode import metadata_json
from tests.ouster_models import nominal_metadata
from tests.project_builder import build_project
from tests.rig_projects import TOML, calibrated_project, tilted
from tests.served import served
from tests.service.running import server_thread
from tests.service.secure import secure_server
from tests.unit.recording.hesai_mirrors import mirror_table

server = served(fresh=True)


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """A server with one rig, for requests that change nothing."""
    with server_thread(tmp_path_factory.mktemp("rigs")) as running:
        created(running)
        yield running


def created(server, rig_id="field", **body):
    answer = server.post("/api/rigs", json={"id": rig_id, **(body or {"toml": TOML})})
    assert answer.status_code == 201, answer.text
    return answer.json()


def content_of(server, rig_id="field", **query):
    answer = server.get(f"/api/rigs/{rig_id}", params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()["content"]


def changed(server, content, **body):
    return server.post("/api/rigs/field/versions", json={"content": content, **body})


def test_shipped_rigs_are_listed_and_read(shared):
    rigs = {rig["id"]: rig for rig in shared.get("/api/rigs").json()}

    assert rigs["4recon"]["shipped"] and rigs["4recon"]["path"] == "4recon"
    assert rigs["4recon"]["sensors"] == ["horizontal", "vertical"]
    vertical = content_of(shared, "4recon")["sensors"][1]
    assert vertical["rpy_deg"] == [0.0, 90.0, 0.0]
    assert vertical["xyz_m"] == [-0.12, 0.0, 0.0]
    exported = shared.get("/api/rigs/4recon/versions/0/file")
    assert exported.text == format_rig(load_rig("4recon"))


def test_an_imported_rig_keeps_its_text_and_is_offered_to_captures(server):
    assert created(server) == {"id": "field", "version": 1}

    view = server.get("/api/rigs/field").json()
    assert [sensor["name"] for sensor in view["content"]["sensors"]] == ["top", "back"]
    assert view["content"]["sensors"][0]["rpy_deg"] == pytest.approx([1.0, 2.0, 3.0])
    assert view["content"]["sensors"][1]["rpy_deg"] == pytest.approx([10.0, 90.0, 0.0])
    assert view["versions"][0]["who"] == "local"
    assert server.get("/api/rigs/field/versions/1/file").text == TOML
    choices = server.get("/api/live/choices").json()["rigs"]
    assert choices[0]["name"] == "field backpack (field-v1.toml)"
    assert choices[0]["rig"] == view["versions"][0]["path"]


def test_a_change_is_a_new_version_and_the_first_stays(server):
    created(server)
    content = content_of(server)
    content["sensors"][0]["xyz_m"] = [0.01, 0.0, 0.3]

    answer = changed(server, content, note="bracket replaced", after=1)

    assert answer.json() == {"id": "field", "version": 2}
    assert content_of(server)["sensors"][0]["xyz_m"] == [0.01, 0.0, 0.3]
    assert content_of(server, version=1)["sensors"][0]["xyz_m"] == [0.0, 0.0, 0.3]
    assert server.get("/api/rigs/field/versions/1/file").text == TOML
    versions = server.get("/api/rigs/field").json()["versions"]
    assert [(one["number"], one["note"]) for one in versions] == [(2, "bracket replaced"), (1, "")]
    rig = load_rig(versions[0]["path"])
    before = load_rig(versions[1]["path"])
    for k in (0, 1):
        angle = (rig.sensors[k].T_body_sensor.inverse() @ before.sensors[k].T_body_sensor).angle()
        assert angle < 1e-9
    offered = [one["rig"] for one in server.get("/api/live/choices").json()["rigs"]]
    assert versions[0]["path"] in offered and versions[1]["path"] not in offered


def test_a_change_of_an_outdated_version_is_rejected(server):
    created(server)
    content = content_of(server)
    assert changed(server, content, after=1).status_code == 201

    answer = changed(server, content, after=1)

    assert answer.status_code == 409
    assert "has version 2 by now" in answer.json()["detail"]
    assert len(server.get("/api/rigs/field").json()["versions"]) == 2


@pytest.mark.parametrize(
    ("field", "value", "place", "text"),
    [
        ("port", 70000, "sensors.0.port", "top: port must be 0 to 65535, got 70000"),
        ("model", "VLP-17", "sensors.0.model", "got 'VLP-17'"),
        ("address", "192.168.1.256", "sensors.0.address", "like 192.168.1.201"),
        ("xyz_m", [12.0, 0.0, 0.0], "sensors.0.xyz_m", "within ±10 m"),
        ("rpy_deg", [0.0, 400.0, 0.0], "sensors.0.rpy_deg", "within ±360°"),
        ("name", "back", "sensors.1.name", "another sensor has this name"),
        ("name", "  ", "sensors.0.name", "needs a name"),
        ("head_rate_deg_s", 9.0, "sensors.0.head_topic", "only a profiler"),
    ],
)
def test_an_invalid_field_is_named(shared, field, value, *, place, text):
    content = content_of(shared)
    content["sensors"][0][field] = value

    check = shared.post("/api/rigs/check", json=content).json()
    answer = changed(shared, content)

    assert list(check["problems"]) == [place]
    assert text in check["problems"][place]
    assert answer.status_code == 422
    assert answer.json()["problems"] == check["problems"]
    assert len(shared.get("/api/rigs/field").json()["versions"]) == 1


def test_only_a_serial_device_is_stored_as_receiver(shared):
    content = content_of(shared)

    def problems(serial):
        content["gnss"]["serial"] = serial
        return shared.post("/api/rigs/check", json=content).json()["problems"]

    assert "with a serial device" in problems("/dev/pts/3:9600")["gnss.serial"]
    assert changed(shared, content).status_code == 422
    assert not problems("/dev/ttyUSB0:115200")


def test_malformed_requests_name_the_field(shared):
    content = content_of(shared)
    content["sensors"][0]["xyz_m"] = [0.0, 1.0]

    assert "sensors.0.xyz_m" in changed(shared, content).json()["detail"]
    assert shared.post("/api/rigs", json={"id": "field 2", "toml": TOML}).status_code == 422
    assert shared.post("/api/rigs", json={"id": "b"}).status_code == 400
    both = {"id": "b", "toml": TOML, "copy_of": "4recon"}
    assert shared.post("/api/rigs", json=both).status_code == 400
    assert changed(shared, None).status_code == 400


@pytest.mark.parametrize(
    ("toml", "text"),
    [
        ("", "at least one [[sensor]]"),
        ("[[sensor]\n", "not a TOML file"),
        (TOML.replace("VLP-16", "VLP-17"), "model must be one of"),
        (TOML.replace("0.3]", "nan]"), "xyz_m must be 3 finite numbers"),
        (TOML + "x = " + "[" * 5000, "nested too deeply"),
        (TOML + '[gnss]\nserial = "/dev/pts/3:9600"\n', "with a serial device"),
    ],
)
def test_a_file_that_is_no_rig_is_rejected(shared, toml, text):
    answer = shared.post("/api/rigs", json={"id": "other", "toml": toml})

    assert answer.status_code == 422
    assert text in answer.json()["detail"]
    assert "other" not in [rig["id"] for rig in shared.get("/api/rigs").json()]


def beside(*files):
    return [{"name": n, "content": b64encode(content).decode()} for n, content in files]


def test_files_imported_with_a_rig_file_describe_its_lidars(server):
    toml = 'name = "r"\n[[sensor]]\nname = "top"\nmodel = "OS0-32"\naddress = "10.0.0.1"\n'
    toml += '[[sensor]]\nname = "side"\nmodel = "AT128"\naddress = "10.0.0.2"\n'
    metadata = metadata_json(nominal_metadata("OS0-32", profile="LEGACY"))
    files = beside(("sensor.json", metadata), ("angles.dat", mirror_table().content))

    created(server, toml=toml, beside=files)

    stored = load_rig(server.root / "rigs/field/1/field-v1.toml")
    assert [one.content for one in described_in(stored)] == [metadata, mirror_table().content]


@pytest.mark.parametrize(
    ("files", "text"),
    [
        (beside(("notes.json", b"{}")), "notes.json: describes none of the LiDARs of the rig"),
        ([{"name": "a.json", "content": "abcde"}], "beside.0.content"),
    ],
)
def test_a_file_beside_a_rig_file_that_is_of_no_use_is_refused(shared, files, text):
    answer = shared.post("/api/rigs", json={"id": "other", "toml": TOML, "beside": files})

    assert answer.status_code == 422
    assert text in answer.json()["detail"]


def test_names_that_are_taken_are_refused(shared):
    assert shared.post("/api/rigs", json={"id": "field", "toml": TOML}).status_code == 409
    assert shared.post("/api/rigs", json={"id": "4recon", "toml": TOML}).status_code == 409
    assert shared.get("/api/rigs/other").status_code == 404
    assert shared.get("/api/rigs/field", params={"version": 7}).status_code == 404
    assert shared.get("/api/rigs/field/versions/7/file").status_code == 404
    assert shared.get("/rigs/other/", headers={"Accept": "text/html"}).status_code == 404
    assert shared.get("/rigs/field/").status_code == 200


def test_a_rig_is_duplicated(server):
    created(server)
    created(server, "copy", copy_of="field")
    created(server, "shipped-copy", copy_of="4recon")

    assert server.get("/api/rigs/copy/versions/1/file").text == TOML
    assert content_of(server, "shipped-copy") == content_of(server, "4recon")


def test_two_sensors_on_one_port_are_a_warning(shared):
    content = content_of(shared, "4recon")
    content["sensors"][1]["port"] = 2368

    check = shared.post("/api/rigs/check", json=content).json()

    assert check["problems"] == {}
    assert "all send to port 2368" in check["warnings"][0]


def test_a_damaged_version_is_shown_with_its_problem(server):
    created(server)
    (server.root / "rigs/field/1/version.json").write_text("{")
    (server.root / "rigs/field/1/field-v1.toml").write_text("no rig")

    card = server.get("/api/rigs").json()[0]
    assert card["id"] == "field" and "version.json" in card["problem"]
    assert server.get("/api/rigs/field").status_code == 422


def test_links_are_not_followed(server, tmp_path_factory):
    created(server)
    outside = tmp_path_factory.mktemp("outside") / "1"
    outside.mkdir()
    (outside / "linked-v1.toml").write_text(TOML)
    (server.root / "rigs" / "linked").symlink_to(outside.parent)

    assert "linked" not in [rig["id"] for rig in server.get("/api/rigs").json()]
    assert server.get("/api/rigs/linked").status_code == 404


def test_a_project_named_rigs_is_left_alone(server):
    build_project(server.root / "rigs", with_map=False)

    answer = server.post("/api/rigs", json={"id": "field", "toml": TOML})

    assert answer.status_code == 409
    assert "rigs is a project" in answer.json()["detail"]
    assert not (server.root / "rigs" / "field").exists()


def test_only_those_who_process_change_rigs_and_the_audit_log_tells(tmp_path):
    with secure_server(tmp_path) as server:
        with server.signed_in("vera") as viewer:
            assert viewer.get("/api/rigs").status_code == 200
            assert viewer.post("/api/rigs", json={"id": "a", "toml": TOML}).status_code == 403
        with server.signed_in("otto") as operator:
            answer = operator.post("/api/rigs", json={"id": "a", "toml": TOML})
            assert answer.status_code == 201, answer.text
            assert operator.get("/api/rigs/a").json()["versions"][0]["who"] == "otto"
        with server.signed_in("anna") as admin:
            rows = admin.get("/api/audit").json()["entries"]
    assert ("otto", "save rig", "a, version 1") in [
        (row["person"], row["action"], row["object"]) for row in rows
    ]


def test_a_rig_names_the_projects_that_used_it(server):
    created(server)
    path = server.get("/api/rigs/field").json()["versions"][0]["path"]
    calibrated_project(server.root / "walk", rig=load_rig(path), found=None)
    calibrated_project(server.root / "other", rig=load_rig("4recon"), found=None)

    assert server.get("/api/rigs/field").json()["uses"] == [
        {"project": "walk", "name": "walk", "version": 1}
    ]
    assert [one["project"] for one in server.get("/api/rigs/4recon").json()["uses"]] == ["other"]
    assert server.get("/api/projects/walk/calibration").json()["rig"] == {
        "id": "field",
        "version": 1,
    }


def test_a_calibrated_rig_becomes_a_version_with_its_evidence(server):
    created(server, copy_of="4recon")
    path = server.get("/api/rigs/field").json()["versions"][0]["path"]
    rig = load_rig(path)
    calibrated_project(server.root / "walk", rig=rig, found=tilted(rig))
    view = server.get("/api/projects/walk/calibration").json()
    assert view["applied"] and view["saved"] is None
    assert view["rig"]["id"] in ("field", "4recon")
    assert view["parameters"][-1]["status"] == "not observable"
    assert view["after"] == {"rms_m": 0.0061, "offset_m": 0.0012, "imu_rms": None}

    answer = server.post(
        "/api/projects/walk/calibration/rig", json={"rig": "field", "note": "after the repair"}
    )

    assert answer.json() == {"id": "field", "version": 2}
    newest = server.get("/api/rigs/field").json()["versions"][0]
    assert newest["note"] == "after the repair"
    assert "vertical rotation y: +1.358° ± 0.020°" in newest["evidence"]
    assert "Not observable: imu position z." in newest["evidence"]
    assert "common planes: 18.3 mm before, 6.1 mm after" in newest["evidence"]
    before, after = load_rig(path).sensors[1], load_rig(newest["path"]).sensors[1]
    angle = (before.T_body_sensor.inverse() @ after.T_body_sensor).angle()
    assert np.rad2deg(angle) == pytest.approx(1.36)
    saved = server.get("/api/projects/walk/calibration").json()["saved"]
    assert saved == {"id": "field", "version": 2}


def test_projects_without_a_calibrated_rig(server):
    build_project(server.root / "half", with_map=False)
    calibrated_project(server.root / "walk", rig=load_rig("4recon"), found=None)

    assert server.get("/api/projects/half/calibration").json() is None
    assert server.get("/api/projects/walk/calibration").json()["applied"] is False
    body = {"rig": "field", "create": True}
    assert server.post("/api/projects/walk/calibration/rig", json=body).status_code == 404
    assert server.get("/api/projects/none/calibration").status_code == 404


def test_a_damaged_audit_is_reported(server):
    calibrated_project(server.root / "walk", rig=load_rig("4recon"), found=None)
    (path,) = (server.root / "walk").glob("artifacts/*/calibration.json")
    found = json.loads(path.read_text())
    found["figures"]["parameters"][0]["change"] = "much"
    path.write_text(json.dumps(found))

    answer = server.get("/api/projects/walk/calibration")

    assert answer.status_code == 422
    assert "parameters.0.change" in answer.json()["detail"]
