"""Fuzz the API with requests generated from its OpenAPI description; none may cause an error 500.

Needs ``schemathesis`` (``pip install schemathesis``, best in an environment of its own), and a
processed project, of which a copy is attacked::

    python -m tests.benchmarks.fuzz_api PROJECT --seconds 240

Ends with 1 if a request was answered with a server error. 507 is one for the tool, but right:
uploads that are announced larger than the disk. Requests that delete are left out, else the others
would soon find nothing; so is the start of a capture, which would outlive the server.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.service.running import end_workers, server_process

LEFT_OUT = ("--exclude-method", "DELETE", "--exclude-path-regex", "trash|clone|uploads$|live$")


def main() -> None:
    """Copy, serve, attack."""
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("project", type=Path)
    ask.add_argument("--seconds", type=int, default=240)
    ask.add_argument("--tool", default="schemathesis", help="path of schemathesis")
    given = ask.parse_args()
    if shutil.which(given.tool) is None:
        sys.exit("schemathesis is not here: pip install schemathesis, or --tool PATH")
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder) / "projects"
        shutil.copytree(given.project, root / "office")
        (Path(folder) / "fuzz.toml").write_text('[parameters]\nproject_id = "office"\n')
        with server_process(root) as (server, _):
            attack = [
                *(given.tool, "--config-file", f"{folder}/fuzz.toml"),
                *("run", f"{server.url}/openapi.json", "--request-timeout", "60"),
                *("--phases", "coverage,fuzzing", "--checks", "not_a_server_error"),
                *("--workers", "2", "--max-time", str(given.seconds), *LEFT_OUT),
            ]
            done = subprocess.run(attack, check=False)
        end_workers(root)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
