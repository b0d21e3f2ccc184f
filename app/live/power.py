"""The battery of this computer, which is carried on the walk."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from recon4.live.findings import Finding

SUPPLIES = Path("/sys/class/power_supply")
READ_EVERY_S = 15.0
LITTLE_S, LITTLE_CHARGE = 900.0, 0.15
VERY_LITTLE_S, VERY_LITTLE_CHARGE = 300.0, 0.06


@dataclass(frozen=True, slots=True)
class Battery:
    """What is left in all batteries of a computer together."""

    charge: float
    """Of what they hold when full, 0 to 1."""
    left_s: float | None
    """How long it lasts as now [s]; None = not told, or on mains."""
    mains: bool
    """Whether it is not being emptied."""


class Power:
    """Reads the battery now and then: the kernel may take milliseconds to ask it."""

    def __init__(
        self, read: Callable[[], Battery | None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._read, self._clock = read, clock
        self._battery: Battery | None = None
        self._read_s = float("-inf")

    @property
    def battery(self) -> Battery | None:
        """As it was `READ_EVERY_S` ago at most; None = there is none."""
        if self._clock() - self._read_s >= READ_EVERY_S:
            self._read_s, self._battery = self._clock(), self._read()
        return self._battery


def read_battery(supplies: Path = SUPPLIES) -> Battery | None:
    """The battery as the Linux kernel tells of it; None if there is none, or another system."""
    found = list(_batteries(supplies))
    if not found:
        return None
    now, full = sum(one["now"] for one in found), sum(one["full"] for one in found)
    flow = sum(one["flow"] for one in found)
    mains = not any(one["emptied"] for one in found)
    left_s = 3600.0 * now / flow if flow > 0 and not mains else None
    return Battery(min(max(now / full, 0.0), 1.0), left_s, mains)


def battery_words(battery: Battery | None) -> list[Finding]:
    """What a person must know of it while walking."""
    if battery is None or battery.mains:
        return []
    left_s = float("inf") if battery.left_s is None else battery.left_s
    if left_s >= LITTLE_S and battery.charge >= LITTLE_CHARGE:
        return []
    urgent = left_s < VERY_LITTLE_S or battery.charge < VERY_LITTLE_CHARGE
    left = f", {left_s / 60:.0f} min" if battery.left_s is not None else ""
    text = f"The computer's battery has {100 * battery.charge:.0f} %{left} left"
    return [Finding("bad" if urgent else "care", text)]


def _batteries(supplies: Path) -> Iterator[dict[str, float]]:
    """Content, size, and what flows out of each, in units that go together."""
    for folder in sorted(supplies.glob("*")):
        about = _properties(folder / "uevent")
        if about.get("TYPE") != "Battery" or about.get("SCOPE") == "Device":
            continue  # mains, or the battery of a mouse
        for what, flow in (("ENERGY", "POWER"), ("CHARGE", "CURRENT")):
            if f"{what}_NOW" in about and f"{what}_FULL" in about:
                now, full = float(about[f"{what}_NOW"]), float(about[f"{what}_FULL"])
                out = abs(float(about.get(f"{flow}_NOW", 0)))
                break
        else:
            if "CAPACITY" not in about:
                continue
            now, full, out = float(about["CAPACITY"]), 100.0, 0.0
        emptied = about.get("STATUS") == "Discharging"
        if full > 0:
            yield {"now": now, "full": full, "flow": out if emptied else 0.0, "emptied": emptied}


def _properties(path: Path) -> dict[str, str]:
    try:
        lines = path.read_text("ascii", "replace").splitlines()
    except OSError:
        return {}
    pairs = (line.removeprefix("POWER_SUPPLY_").partition("=") for line in lines)
    return {name: value for name, _, value in pairs}
