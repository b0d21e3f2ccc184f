"""The notice at the start of a server: written once, to the terminal and to no log."""

from __future__ import annotations

from recon4_app.access.login.login_service import Access
from recon4_app.network.certificate import Certificate


def startup_notice(
    access: Access, url: str, *, others: list[str], certificate: Certificate | None
) -> list[str]:
    """Lines for the person who started the server.

    Args:
        access: Who may sign in.
        url: The best URL of the server.
        others: Its other URLs.
        certificate: The TLS certificate in use; None = without TLS.
    """
    lines = [f"Also at {', '.join(others)}"] if others else []
    if certificate is not None:
        whose = "your" if certificate.own else "a made"
        lines += [
            f"TLS with {whose} certificate; its SHA-256 fingerprint, to compare in the browser:",
            certificate.fingerprint(),
        ]
    if access.login and not access.accounts.has_admin():
        lines += [
            "Nobody can sign in yet. Make the first admin, once, before this server ends:",
            f"{url}login#setup={access.logins.open_setup()}",
            "or on this computer: recon4 users add NAME --role admin",
        ]
    return lines
