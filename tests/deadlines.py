"""How long tests wait on a busy computer."""

from __future__ import annotations

BUSY_S = 20.0
"""What may be added to a deadline under test before it counts as missed; such deadlines end what
would else go on for a minute or forever."""
HANG_S = 300.0
"""For what has no deadline, as the start of a process: what takes longer hangs. The worker of a job
is the last one to get a processor."""
