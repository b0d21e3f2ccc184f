"""What a busy computer may add to a deadline before a test calls it missed."""

from __future__ import annotations

#: The deadlines under test end what would else go on for a minute or forever.
BUSY_S = 20.0
