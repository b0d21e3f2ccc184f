"""The commands ``recon4 report`` (for the client) and ``recon4 deliver`` (all in one file)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.exports import DraftOption
from recon4.cli.terminal import write

if TYPE_CHECKING:
    from recon4.delivery.pdf_signature import Organization

delivery = typer.Typer()

CERTIFICATE = "RECON4_CERTIFICATE"
PASSPHRASE = "RECON4_CERTIFICATE_PASSPHRASE"
PASSPHRASE_FILE = "RECON4_CERTIFICATE_PASSPHRASE_FILE"
"""Environment variables: other users of a computer can read the arguments of a command."""
CertificateOption = Annotated[
    Path | None,
    typer.Option(
        envvar=CERTIFICATE,
        help="Certificate of your organization that signs, PKCS#12 (.p12, .pfx). Its passphrase "
        f"is in the environment, {PASSPHRASE}, or in the file named by {PASSPHRASE_FILE}.",
    ),
]


@delivery.command()
def report(
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    *,
    pdf: Annotated[Path | None, typer.Option(help="PDF to write, for the client.")] = None,
    html: Annotated[Path | None, typer.Option(help="HTML to write, with all figures.")] = None,
    certificate: CertificateOption = None,
    draft: DraftOption = False,
) -> None:
    """Write the report of a finished run; the PDF of an approved map is signed.

    It is signed with the key of the server in whose folder the project lies, or with a certificate
    of your organization. A draft says so on every page, and is never signed.
    """
    wanted = [path for path in (pdf, html) if path]
    if not wanted:
        raise typer.BadParameter("name the file to write: --pdf FILE or --html FILE")
    signer = organization(certificate)
    confine_command(write=[path.parent for path in wanted])
    from recon4.delivery.report_files import ReportWish, server_key, write_html, write_pdf

    if html:
        made = write_html(project, html, draft=draft)
        write(f"{html}\n{made.approval.text}")
    if pdf:
        wish = ReportWish(draft=draft, key=signer or server_key(project))
        made = write_pdf(project, pdf, wish)
        write(f"{pdf}, {'signed' if made.signed else 'not signed'}\n{made.approval.text}")


def organization(certificate: Path | None) -> Organization | None:
    """The certificate that signs, with its passphrase from the environment."""
    if certificate is None:
        return None
    from recon4.delivery.pdf_signature import Organization
    from recon4.untrusted.bounded import read_text_limited

    if name := os.environ.get(PASSPHRASE_FILE):
        passphrase = read_text_limited(Path(name), 4096).rstrip("\r\n")
    elif PASSPHRASE in os.environ:
        passphrase = os.environ[PASSPHRASE]
    else:
        raise typer.BadParameter(
            f"the passphrase of {certificate.name} is missing: put it into the environment, "
            f"{PASSPHRASE}, or into a file named by {PASSPHRASE_FILE}"
        )
    return Organization(file=certificate, passphrase=passphrase.encode())
