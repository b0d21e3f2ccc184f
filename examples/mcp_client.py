"""List the projects of a recon4 server with their verdicts, by the tools for assistants.

    export RECON4_TOKEN=...
    python examples/mcp_client.py https://backpack.local:8000/mcp --certificate certificate.pem

The token is made on the page Account; without a login none is needed. ``certificate.pem`` is a
copy of ROOT/.recon4/tls/certificate.pem. It needs the package mcp.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import ssl
import sys
from pathlib import Path

import httpx2
from mcp import Client
from mcp.client.streamable_http import streamable_http_client

ANSWER_S = 300.0
"""Images of large maps take minutes [s]."""


async def print_verdicts(server: str, http: httpx2.AsyncClient) -> None:
    """Print a line for each project: its id, its verdict, the codes of its findings."""
    async with Client(streamable_http_client(server, http_client=http)) as client:
        listed = await client.call_tool("list_projects", {})
        for project in (listed.structured_content or {})["projects"]:
            read = await client.call_tool("project_summary", {"project": project["id"]})
            findings = (read.structured_content or {})["findings"] or []
            codes = ", ".join(finding["kind"] for finding in findings)
            print(f"{project['id']}: {project['usability']} {codes}".rstrip())


async def main() -> int:
    """Connect with the token of the environment."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("server", help="as https://backpack.local:8000/mcp")
    parser.add_argument("--certificate", type=Path, help="the server's own certificate")
    given = parser.parse_args()
    token = os.environ.get("RECON4_TOKEN", "")
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    trust = ssl.create_default_context(cafile=given.certificate)
    async with httpx2.AsyncClient(verify=trust, headers=headers, timeout=ANSWER_S) as http:
        await print_verdicts(given.server, http)
    return 0


if __name__ == "__main__":
    sys.exit(asyncio.run(main()))
