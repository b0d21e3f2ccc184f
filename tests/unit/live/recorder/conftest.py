"""A capture session in a temporary folder."""

import pytest

from recon4.live.session import CaptureSession
from tests.loopback import an_address


@pytest.fixture
def session(tmp_path):
    address = an_address()
    session = CaptureSession(project=tmp_path / "walk", address=address, least_free_bytes=0)
    session.capture.parent.mkdir(parents=True)
    session.save()
    session.rig.write_text('name = "test"\n[[sensor]]\nname = "lidar"\n')
    return session
