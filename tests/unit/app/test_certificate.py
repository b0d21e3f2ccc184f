"""The certificate of this computer: made once, replaced when damaged."""

import pytest

from recon4.errors import ConfigError
from recon4_app.network.certificate import made_certificate, own_certificate
from recon4_app.network.hosts import own_names


def test_a_certificate_is_made_once_for_this_computers_names(tmp_path):
    made = made_certificate(tmp_path / "tls", own_names())
    again = made_certificate(tmp_path / "tls", own_names())

    assert made.fingerprint() == again.fingerprint()
    assert len(made.fingerprint()) == 95
    assert {"localhost", "127.0.0.1", "::1"} <= made.names()
    assert made.key.stat().st_mode & 0o777 == 0o600


def test_a_damaged_certificate_is_made_anew(tmp_path):
    first = made_certificate(tmp_path / "tls", frozenset({"localhost"})).fingerprint()
    (tmp_path / "tls" / "key.pem").write_text("broken")

    assert made_certificate(tmp_path / "tls", frozenset({"localhost"})).fingerprint() != first


def test_a_certificate_and_a_key_that_do_not_fit_are_refused(tmp_path):
    one = made_certificate(tmp_path / "one", frozenset({"localhost"}))
    two = made_certificate(tmp_path / "two", frozenset({"localhost"}))

    with pytest.raises(ConfigError, match="not a certificate and its key"):
        own_certificate(one.chain, two.key)
    with pytest.raises(ConfigError, match="no file"):
        own_certificate(tmp_path / "none.pem", one.key)
    assert own_certificate(one.chain, one.key).own
