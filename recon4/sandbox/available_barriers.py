"""Detects the barriers this computer provides, by confining a child process."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from recon4.sandbox.environment import ONE_THREAD, allowed_environment
from recon4.sandbox.policy import Barrier
from recon4.sandbox.tuning import CONFINEMENT

_TRY = """
import json, logging, sys
from dataclasses import asdict
logging.disable()
from recon4.sandbox import Policy, confine
print(json.dumps([asdict(barrier) for barrier in confine(Policy()).barriers]))
"""


def available_barriers() -> tuple[Barrier, ...]:
    """The barriers around a child confined as far as possible, as it reports them itself."""
    ours = Path(__file__).resolve().parents[2]
    places = [str(ours), *filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))]
    environment = {**allowed_environment(os.environ), **ONE_THREAD}
    environment |= {"PYTHONPATH": os.pathsep.join(places)}
    command = [sys.executable, "-P", "-c", _TRY]
    try:
        answer = subprocess.run(
            command,
            env=environment,
            capture_output=True,
            timeout=CONFINEMENT.tried_within_s,
            check=True,
        )
        return tuple(Barrier(**barrier) for barrier in json.loads(answer.stdout))
    except (OSError, subprocess.SubprocessError, ValueError, TypeError) as error:
        return (Barrier("all", holds=False, detail=f"confining a child failed: {error}"),)
