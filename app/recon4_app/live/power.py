"""Battery of this computer, which the operator carries."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from recon4.live.findings import CaptureFinding, capture_texts
from recon4.locales.languages import ENGLISH
from recon4_app.live.tuning import POWER

SUPPLIES = Path("/sys/class/power_supply")


@dataclass(frozen=True, slots=True)
class Battery:
    """Charge of all batteries of a computer together."""

    charge: float
    """Charge level, 0 to 1."""
    left_s: float | None
    """Time until it is empty at the present rate [s]; None = unknown, or on mains."""
    mains: bool
    """Whether the computer runs on mains."""


class Power:
    """Reads the battery at intervals, because a read may take milliseconds."""

    def __init__(
        self, read: Callable[[], Battery | None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._read, self._clock = read, clock
        self._battery: Battery | None = None
        self._read_s = float("-inf")

    @property
    def battery(self) -> Battery | None:
        """The battery, at most `POWER.read_every_s` old; None = there is none."""
        if self._clock() - self._read_s >= POWER.read_every_s:
            self._read_s, self._battery = self._clock(), self._read()
        return self._battery


def read_battery(supplies: Path = SUPPLIES) -> Battery | None:
    """Read the battery from sysfs; None if there is none, or on another system than Linux."""
    found = list(_batteries(supplies))
    if not found:
        return None
    now, full = sum(one["now"] for one in found), sum(one["full"] for one in found)
    flow = sum(one["flow"] for one in found)
    mains = not any(one["emptied"] for one in found)
    left_s = 3600.0 * now / flow if flow > 0 and not mains else None
    return Battery(min(max(now / full, 0.0), 1.0), left_s, mains)


def battery_findings(battery: Battery | None, language: str = ENGLISH) -> list[CaptureFinding]:
    """Warnings about the battery for the operator."""
    if battery is None or battery.mains:
        return []
    left_s = float("inf") if battery.left_s is None else battery.left_s
    if left_s >= POWER.low_s and battery.charge >= POWER.low_charge:
        return []
    critical = left_s < POWER.critical_s or battery.charge < POWER.critical_charge
    say = capture_texts(language)
    if battery.left_s is None:
        text = say("battery", charge=battery.charge)
    else:
        text = say("battery-minutes", charge=battery.charge, minutes=left_s / 60)
    return [CaptureFinding("error" if critical else "warning", text)]


def _batteries(supplies: Path) -> Iterator[dict[str, float]]:
    """Charge, capacity and discharge rate of each battery, in matching units."""
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
