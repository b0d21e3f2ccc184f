"""The counts of an import in words: the same in `recon4 info`, the report and the verdict."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from recon4.locales.languages import ENGLISH
from recon4.model.count_meanings import COUNT_MEANINGS, CountKind, CountMeaning
from recon4.model.tuning import LOSSES

if TYPE_CHECKING:
    from recon4.locales.texts import Texts


@dataclass(frozen=True, slots=True)
class Loss:
    """A count of data that is not used, or was repaired."""

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
        """How many of how many, what became of them, and the detail; in English."""
        return self.said(ENGLISH)

    def said(self, language: str) -> str:
        """The same in a language; a detail without a code as it is."""
        texts = _texts(language)
        number = str(self.number)
        if self.total:
            number = texts("counts-of", number=self.number, total=self.total)
        detail = f" ({_said(self.detail, language)})" if self.detail else ""
        return f"{number} {count_label(self.name, language)}{detail}"

    @property
    def is_warned(self) -> bool:
        """Whether it is a warning of its own: large, and nobody else says it."""
        return not meaning(self.name).stated and not self.ratio < LOSSES.warned_ratio


def meaning(name: str) -> CountMeaning:
    """What a count means.

    Raises:
        KeyError: If it is not listed.
    """
    return COUNT_MEANINGS[_listed(name)[0]]


def _listed(name: str) -> tuple[str, str]:
    """A count as it is listed, and the sensor it is of; empty = of all."""
    if name in COUNT_MEANINGS:
        return name, ""
    for start in COUNT_MEANINGS:
        if start.endswith("_") and name.startswith(start):
            return start, name[len(start) :]
    raise KeyError(name)


def count_label(name: str, language: str = ENGLISH) -> str:
    """What a count counts, such as ``points: a time …, dropped``; its name if it is not listed."""
    try:
        listed, sensor = _listed(name)
    except KeyError:
        return name.replace("_", " ")
    if COUNT_MEANINGS[listed].kind is CountKind.READ:
        return _text(listed, language)
    of_sensor = f" ({sensor})" if sensor else ""
    return f"{_noun(listed, language)}: {_text(listed, language)}{of_sensor}"


def count_noun(name: str, language: str = ENGLISH) -> str:
    """What is counted, such as ``scans of the 2-D laser``; its name if it is not listed."""
    return _own_noun(name, language) if name in COUNT_MEANINGS else name.replace("_", " ")


def count_fate(name: str, language: str = ENGLISH) -> str:
    """What became of what is counted; the name of the count if it is not listed."""
    try:
        return _text(_listed(name)[0], language)
    except KeyError:
        return name.replace("_", " ")


def count_text(
    name: str, counts: Mapping[str, int], *, detail: str = "", language: str = ENGLISH
) -> str:
    """A count as text, such as ``3 of 30000 points: a time …, dropped``.

    Args:
        name: Of the count.
        counts: All counts.
        detail: What the reader knows besides, such as a port.
        language: Of the text.
    """
    return Loss(name, counts.get(name, 0), _total(name, counts), detail).said(language)


def ratio_text(name: str, ratio: float, language: str = ENGLISH) -> str:
    """A part of all as text, such as ``12 % of the data packets: received twice, …``.

    Args:
        name: Of a count with words.
        ratio: Of all, 0 to 1.
        language: Of the text.
    """
    listed, _ = _listed(name)
    what = {"noun": _noun(listed, language), "text": _text(listed, language)}
    return _texts(language)("counts-ratio", ratio=ratio, **what)


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


def repairs(counts: Mapping[str, int]) -> list[Loss]:
    """All counts of repaired data, in the order in which they were counted."""
    return [_loss(name, counts, {}) for name in _of_kind(counts, CountKind.REPAIRED)]


def _of_kind(counts: Mapping[str, int], kind: CountKind) -> Iterator[str]:
    for name, number in counts.items():
        found = _meaning(name)
        if number and found is not None and found.kind is kind:
            yield name


def _loss(name: str, counts: Mapping[str, int], details: Mapping[str, str]) -> Loss:
    return Loss(name, counts[name], _total(name, counts), details.get(name, ""))


def _total(name: str, counts: Mapping[str, int]) -> int:
    """How many there were in all; 0 = unknown."""
    found = _meaning(name)
    if found is None or not found.of:
        return 0
    left_out = counts[name] if found.apart else 0
    return max(counts.get(found.of, 0) + left_out, counts[name])


def _meaning(name: str) -> CountMeaning | None:
    try:
        return meaning(name)
    except KeyError:
        return None


def _noun(listed: str, language: str) -> str:
    return _own_noun(COUNT_MEANINGS[listed].of or listed, language)


def _own_noun(listed: str, language: str) -> str:
    texts, message = _texts(language), f"count-{listed}"
    part = "noun" if "noun" in texts.parts(message) else ""
    return texts.part(message, part, {})


def _text(listed: str, language: str) -> str:
    return _texts(language)(f"count-{listed}")


def _said(detail: str, language: str) -> str:
    from recon4.locales.coded import said

    return said(detail, language)


def _texts(language: str) -> Texts:
    from recon4.locales.texts import texts  # readers count without a word: no parser for them

    return texts(language, "counts")
