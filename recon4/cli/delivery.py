"""The commands ``recon4 report`` (for the client) and ``recon4 deliver`` (all in one file)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.exports import DraftOption
from recon4.cli.terminal import in_terminal, say, say_approval, write, write_json
from recon4.locales.coded import CodedText
from recon4.locales.languages import of_terminal

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
    client: Annotated[
        Path | None,
        typer.Option("--client", "--pdf", help="For the client: PDF, or HTML by its ending."),
    ] = None,
    html: Annotated[Path | None, typer.Option(help="HTML to write, with all figures.")] = None,
    certificate: CertificateOption = None,
    draft: DraftOption = False,
) -> None:
    """Write the report of a finished run; the PDF of an approved map is signed.

    It is signed with the key of the server in whose folder the project lies, or with a certificate
    of your organization. A draft says so on every page, and is never signed.
    """
    wanted = [path for path in (client, html) if path]
    if not wanted:
        raise typer.BadParameter(CodedText("report-name"))
    spoken = of_terminal()
    signer = organization(certificate)
    confine_command(write=[path.parent for path in wanted])
    from recon4.delivery import report_files

    wish = report_files.ReportWish(
        draft=draft, key=signer or report_files.server_key(project), language=spoken
    )
    if html:
        made = report_files.write_html(project, html, wish)
        write(str(html))
        say_approval(made.approval)
    if client:
        page = client.suffix.lower() in (".html", ".htm")
        write_client = report_files.write_client_html if page else report_files.write_pdf
        made = write_client(project, client, wish)
        say("written-report", file=str(client), signed=_yes(made.signed))
        say_approval(made.approval)


@delivery.command()
def deliver(
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    out: Annotated[Path, typer.Argument(help="ZIP file to write.")],
    *,
    files: Annotated[
        list[str] | None,
        typer.Option(
            help="What is in it, with commas: copc.laz, laz, ply, pcd, xyz, e57, plan.dxf, "
            "plan.geojson, orthophoto.tif, dtm.tif, dsm.tif, contours.dxf, poses.txt, "
            "layers.gpkg, findings.csv, findings.geojson; default: copc.laz, findings.csv. Reports "
            "are always in it."
        ),
    ] = None,
    crs: Annotated[str, typer.Option(help="As EPSG:5514+8357; default: the map's.")] = "",
    license_: Annotated[
        Path | None, typer.Option("--license", help="Text file: how the data may be used.")
    ] = None,
) -> None:
    """Pack a map, its report, hashes and signature into one file for the client.

    `recon4 verify FILE.zip` checks it on any computer. A map that is not approved is packed as a
    draft, and not signed.
    """
    spoken = of_terminal()
    signer = organization(Path(name) if (name := os.environ.get(CERTIFICATE)) else None)
    confine_command(write=[out.parent])
    from recon4.cli.terminal import watcher
    from recon4.delivery.package import DeliveryWish, chosen_files
    from recon4.delivery.package import deliver as pack
    from recon4.delivery.report_files import server_key

    wish = DeliveryWish(
        files=chosen_files(files or []),
        crs=crs,
        license=license_,
        key=server_key(project),
        certificate=signer,
        language=spoken,
    )
    with watcher() as progress:
        made = pack(project, out, wish, progress=progress)
    say(
        "written-delivery",
        count=len(made.files),
        bytes=made.bytes,
        folder=str(out),
        signed=_yes(made.signed),
    )
    say_approval(made.approval)


def _yes(signed: bool) -> str:
    return "yes" if signed else "no"


def is_delivery(path: Path) -> bool:
    """Whether a path is a file, or an unpacked delivery."""
    return path.is_file() or (path / "manifest.json").is_file()


def show_checked(path: Path, *, as_json: bool, accept: bool = False) -> None:
    """Verify a delivery or a signed report, and say what is intact and whose signature it is.

    Raises:
        typer.BadParameter: If its files are to be accepted as they are.
        typer.Exit: If not all is as it was sent, or the signature does not count.
    """
    if accept:
        raise typer.BadParameter(CodedText("accept-projects"))

    confine_command()
    from recon4.cli.terminal import watcher
    from recon4.delivery.check import check_file

    with watcher() as progress:
        found = check_file(path, progress=progress)
    if as_json:
        write_json(found)
    else:
        parts = (("intact", found.intact), ("altered", found.altered))
        for part, names in (*parts, ("missing", found.missing), ("added", found.added)):
            for name in names:
                say(f"verify-{part}", name=name)
        for text in filter(None, (found.says, found.doubt)):
            write(in_terminal(text))
        if found.signer and not found.altered:
            say("verify-signer", signer=found.signer)
    if not found.whole:
        raise typer.Exit(1)


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
            CodedText(
                "passphrase-missing",
                certificate=certificate.name,
                passphrase=PASSPHRASE,
                passphrase_file=PASSPHRASE_FILE,
            )
        )
    return Organization(file=certificate, passphrase=passphrase.encode())
