"""The counts of an import in words: the same in `recon4 info`, the report and the verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from recon4.model.count_words import COUNT_WORDINGS, CountKind, CountWording
from recon4.model.tuning import LOSSES


@dataclass(frozen=True, slots=True)
class Loss:
    """A count of data that is not used."""

    name: str
    number: int
    total: int
    """Of all of its kind; 0 = unknown."""
    detail: str
    """What the reader knows besides, such as a port."""

    @property
    def ratio(self) -> float:
        """Of all of its kind, 0 to 1; NaN = unknown."""
        return self.number / self.total if self.total else float("nan")

    @property
    def text(self) -> str:
        """How many of how many, what became of them, and the detail."""
        return _counted(self.name, self.number, total=self.total, detail=self.detail)

    @property
    def is_warned(self) -> bool:
        """Whether it is a warning of its own: large, and nobody else says it."""
        return not wording(self.name)[0].stated and not self.ratio < LOSSES.warned_ratio


def wording(name: str) -> tuple[CountWording, str]:
    """The words of a count, and the sensor it is of; empty = of all.

    Raises:
        KeyError: If it has none.
    """
    if name in COUNT_WORDINGS:
        return COUNT_WORDINGS[name], ""
    for start, found in COUNT_WORDINGS.items():
        if start.endswith("_") and name.startswith(start):
            return found, name[len(start) :]
    raise KeyError(name)


def count_label(name: str) -> str:
    """What a count counts, such as ``points: a time …, dropped``; its name if it has no words."""
    try:
        words, sensor = wording(name)
    except KeyError:
        return name.replace("_", " ")
    if words.kind is CountKind.READ:
        return words.text
    return f"{_noun(words)}: {words.text}{f' ({sensor})' if sensor else ''}"


def count_noun(name: str) -> str:
    """What is counted, such as ``scans of the 2-D laser``; its name if it has no words."""
    words = COUNT_WORDINGS.get(name)
    return name.replace("_", " ") if words is None else words.noun or words.text


def count_fate(name: str) -> str:
    """What became of what is counted; the name of the count if it has no words."""
    words = _words(name)
    return name.replace("_", " ") if words is None else words.text


def count_text(name: str, counts: Mapping[str, int], *, detail: str = "") -> str:
    """A count as text, such as ``3 of 30000 points: a time …, dropped``.

    Args:
        name: Of the count.
        counts: All counts.
        detail: What the reader knows besides, such as a port.
    """
    return _counted(name, counts.get(name, 0), total=_total(name, counts), detail=detail)


def _counted(name: str, number: int, *, total: int, detail: str) -> str:
    of_all = f" of {total}" if total else ""
    return f"{number}{of_all} {count_label(name)}{f' ({detail})' if detail else ''}"


def ratio_text(name: str, ratio: float) -> str:
    """A part of all as text, such as ``12 % of the data packets: received twice, …``.

    Args:
        name: Of a count with words.
        ratio: Of all, 0 to 1.
    """
    words, _ = wording(name)
    return f"{100.0 * ratio:.0f} % of the {_noun(words)}: {words.text}"


def losses(counts: Mapping[str, int], details: Mapping[str, str] | None = None) -> list[Loss]:
    """All counts of data that is not used, the largest ratio first.

    Args:
        counts: Of an import; names of other versions are passed over.
        details: What the reader knows of a count besides.
    """
    return _largest_first(counts, CountKind.LOST, details or {})


def replaced(counts: Mapping[str, int], details: Mapping[str, str] | None = None) -> list[Loss]:
    """All counts of data that something worse stands in for, the largest ratio first."""
    return _largest_first(counts, CountKind.REPLACED, details or {})


def _largest_first(
    counts: Mapping[str, int], kind: CountKind, details: Mapping[str, str]
) -> list[Loss]:
    found = [_loss(name, counts, details) for name in _of_kind(counts, kind)]
    return sorted(found, key=lambda loss: -loss.ratio if loss.ratio == loss.ratio else -1.0)


def repairs(counts: Mapping[str, int]) -> list[str]:
    """All counts of repaired data, in words."""
    return [count_text(name, counts) for name in _of_kind(counts, CountKind.REPAIRED)]


def _of_kind(counts: Mapping[str, int], kind: CountKind) -> Iterator[str]:
    for name, number in counts.items():
        found = _words(name)
        if number and found is not None and found.kind is kind:
            yield name


def _loss(name: str, counts: Mapping[str, int], details: Mapping[str, str]) -> Loss:
    return Loss(name, counts[name], _total(name, counts), details.get(name, ""))


def _total(name: str, counts: Mapping[str, int]) -> int:
    """How many there were in all; 0 = unknown."""
    words = _words(name)
    if words is None or not words.of:
        return 0
    left_out = counts[name] if words.apart else 0
    return max(counts.get(words.of, 0) + left_out, counts[name])


def _words(name: str) -> CountWording | None:
    try:
        return wording(name)[0]
    except KeyError:
        return None


def _noun(words: CountWording) -> str:
    if not words.of:
        return words.noun
    return COUNT_WORDINGS[words.of].noun or COUNT_WORDINGS[words.of].text
