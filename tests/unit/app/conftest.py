"""What tests of access and pairing share."""

from __future__ import annotations

import pytest

from recon4_app.access.login.login_service import LoginService, open_access


class Clock:
    """Time as the test sets it."""

    now_s = 1_000_000.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def access(tmp_path, clock, monkeypatch):
    # One round of little memory: what is tested here is not how dear a hash is.
    monkeypatch.setattr(
        "recon4_app.access.login.passwords.hashed", lambda password: f"hash of {password}"
    )
    monkeypatch.setattr(
        "recon4_app.access.login.passwords.matches",
        lambda password, stored: stored == f"hash of {password}",
    )
    opened = open_access(tmp_path, login=True, clock=clock)
    yield opened
    opened.close()


@pytest.fixture
def logins(access, clock):
    return LoginService(access.accounts, access.sessions, clock=clock)
