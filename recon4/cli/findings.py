"""The commands ``recon4 audit`` and ``recon4 explain``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.terminal import write
from recon4.locales.languages import of_terminal

findings = typer.Typer()


@findings.command()
def audit(
    project: Annotated[Path, typer.Argument(help="Folder of a finished project.")],
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON for programs.")] = False,
) -> None:
    """Work out the findings of a finished map again, with the witnesses of this version."""
    confine_command(write=[project])
    from recon4.cli.summaries import show_run
    from recon4.cli.terminal import watcher
    from recon4.pipeline import audit as run

    with watcher() as progress:
        summary = run(project, progress=progress)
    show_run(summary, as_json=as_json)


@findings.command()
def explain(
    code: Annotated[
        str, typer.Argument(help="Code of a finding, as GNSS-CLOCK; without it all are listed.")
    ] = "",
) -> None:
    """Explain a finding: what it means, how it is detected, what to do."""
    from recon4.findings.explain import explained, listed

    spoken = of_terminal()
    write(explained(code, spoken) if code else listed(spoken))
