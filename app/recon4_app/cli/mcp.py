"""The command ``recon4 mcp``: tools for an assistant, over standard input and output."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.system.stopping import StopSignals

assistant = typer.Typer()

PASSWORD = "RECON4_PASSWORD"


@assistant.command()
def mcp(
    context: typer.Context,
    url: Annotated[
        str,
        typer.Argument(
            help="Address of a recon4 server; with a login https://ACCOUNT@HOST:PORT/, and the "
            "password in RECON4_PASSWORD."
        ),
    ] = "http://127.0.0.1:8000/",
    *,
    certificate: Annotated[
        Path | None, typer.Option(help="The server's own certificate, PEM.")
    ] = None,
    downloads: Annotated[
        Path | None, typer.Option(help="Folder for downloads; without it there are none.")
    ] = None,
    allow_write: Annotated[
        bool, typer.Option("--allow-write", help="Also start and cancel jobs, decide loops.")
    ] = False,
) -> None:
    """Offer a recon4 server to an assistant: tools of the Model Context Protocol over stdio."""
    try:
        from recon4_app.assistant.http_client import ServerClient
        from recon4_app.assistant.server import make_server
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0].startswith("recon4"):
            raise
        raise ConfigError(CodedText("mcp-package", why=str(error.name))) from error

    password = os.environ.get(PASSWORD, "")
    client = ServerClient(url, password=password, certificate=certificate)
    if client.needs_password and not password:
        raise typer.BadParameter(CodedText("mcp-password", password=PASSWORD))
    if downloads is not None and not downloads.is_dir():
        raise typer.BadParameter(CodedText("mcp-downloads", downloads=str(downloads)))
    stop = context.find_object(StopSignals)
    assert stop is not None
    stop.request(lambda: os._exit(stop.exit_code))  # its standard input may stay open
    make_server(client, allow_write=allow_write, downloads=downloads).run("stdio")
