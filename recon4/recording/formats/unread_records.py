"""What the captured packets are that cannot be read: for which port, of which protocol."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from recon4.locales.coded import CodedText
from recon4.recording.report import ImportReport

_ETHERTYPES = {0x0806: "ARP", 0x86DD: "IPv6", 0x88CC: "LLDP", 0x88F7: "PTP"}
_PROTOCOLS = {1: "ICMP", 2: "IGMP", 6: "TCP"}
_MOST_KINDS, _LISTED = 256, 3

Numbers = NDArray[np.int64]


@dataclass(slots=True)
class UnreadRecords:
    """Kinds of unread packets of one file; they become details of counts."""

    report: ImportReport
    _cut: Counter[tuple[int, ...]] = field(default_factory=Counter)
    """Destination port (-1 = cut before it) and captured bytes -> packets."""
    _fragments: Counter[tuple[int, ...]] = field(default_factory=Counter)
    """Destination port of first fragments -> packets."""
    _others: Counter[tuple[int, ...]] = field(default_factory=Counter)
    """Ethertype (-1 = of an unknown link type) and protocol -> packets."""

    def add_cut(self, port: Numbers, captured: Numbers) -> None:
        """Datagrams that are longer than what was captured, (N,)."""
        self._add("records_cut", self._cut, port, captured)
        sizes = Counter[int]()
        for (_, size), n in self._cut.items():
            sizes[size] += n
        ports = [port for port in dict.fromkeys(key[0] for key in _common(self._cut)) if port >= 0]
        listed = _listed([str(size) for size, _ in sizes.most_common()])
        to_ports = _to_ports(ports)
        cut = {"ports": to_ports} if to_ports is not None else {}
        code = "detail-cut-ports" if cut else "detail-cut"
        self._say("records_cut", CodedText(code, sizes=listed, **cut))

    def add_fragments(self, port: Numbers) -> None:
        """Parts of datagrams, with the port if it is the first part, else -1, (N,)."""
        self._add("records_fragment", self._fragments, port)
        ports = [key[0] for key in _common(self._fragments) if key[0] >= 0]
        self._say("records_fragment", _to_ports(ports))

    def add_others(self, ethertype: Numbers, protocol: Numbers) -> None:
        """Packets that are no UDP over IPv4, (N,)."""
        self._add("records_not_udp", self._others, ethertype, protocol)
        names = list(dict.fromkeys(_name(*key) for key in _common(self._others)))
        listed = " ".join(names[:_LISTED]) + " …" * (len(names) > _LISTED)
        self._say("records_not_udp", CodedText("detail-protocols", names=listed) if names else None)

    def _add(self, name: str, kinds: Counter[tuple[int, ...]], *columns: Numbers) -> None:
        self.report.count(name, len(columns[0]))
        if not len(columns[0]):
            return
        found, numbers = np.unique(np.stack(columns, axis=1), axis=0, return_counts=True)
        for row, number in zip(found.tolist(), numbers.tolist(), strict=True):
            if tuple(row) in kinds or len(kinds) < _MOST_KINDS:
                kinds[tuple(row)] += number

    def _say(self, name: str, text: CodedText | None) -> None:
        if text is not None and self.report.counts[name]:
            self.report.details[name] = text


def _common(kinds: Counter[tuple[int, ...]]) -> list[tuple[int, ...]]:
    return [key for key, _ in kinds.most_common()]


def _to_ports(ports: list[int]) -> CodedText | None:
    code = "detail-ports" if len(ports) > 1 else "detail-port"
    return CodedText(code, ports=_listed([str(port) for port in ports])) if ports else None


def _listed(texts: list[str]) -> str:
    return ", ".join(texts[:_LISTED]) + " …" * (len(texts) > _LISTED)


def _name(ethertype: int, protocol: int) -> str:
    if ethertype == 0x0800 and protocol < 0:
        return "no-ipv4-header"
    if ethertype == 0x0800:
        return _PROTOCOLS.get(protocol, f"IP/{protocol}")
    if ethertype < 0:
        return "link-type"
    return _ETHERTYPES.get(ethertype, f"ethertype/0x{ethertype:04x}")
