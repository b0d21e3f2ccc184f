"""What the page of a new project says that is derived, in the language of its reader."""

from recon4.model.rig import format_rig, load_rig
from recon4_app.projects.inspect_recording import inspect_recording
from tests.builders import write_room_pcap


def test_what_is_derived_is_in_the_language_of_the_page_and_a_rig_beside_wins(tmp_path):
    path = write_room_pcap(tmp_path / "room.pcap", seconds=0.3)
    rig = tmp_path / "rig.toml"

    found = inspect_recording(path, (), "de")
    rig.write_text(format_rig(load_rig("4recon")), "utf-8")
    beside = inspect_recording(path, (rig,), "de")

    assert any(text.startswith("Kein Rig angegeben: ein VLP-16") for text in found.derived)
    assert beside.rig == str(rig)
    assert not any("Kein Rig" in text for text in beside.derived)
    assert set(beside.derived) < set(found.derived)
