"""Words the project does not use, and what to use instead: ``python -m tools.language [PATH…]``.

`docs/reference/glossary.md` is the list for people; this is what a test can check.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
SUFFIXES = {".py", ".js", ".html", ".css", ".md", ".jinja", ".toml"}
ALLOWED = {
    "tools/language.py",
    "web/shared/vendor/three/three.module.min.js",
    "docs/reference/glossary.md",
    "recon4/settings/renamed.py",
    "recon4/store/earlier_names.py",
}
"""Files that have to name what was retired, or are of others."""

RETIRED = {
    ("told",): (r"\btold\b|_told\b", "given, reported, message, record"),
    ("anew",): (r"\banew\b", "again, from scratch"),
    ("so many", "so often"): (r"\bso (?:many|often)\b", "n, how many, this many, count"),
    (" down", "_down"): (r"\bturn(?:s|ed|ing)? down\b|\bturned_down\b", "reject(ed)"),
    (" back", "_back"): (
        r"\bt(?:ake|akes|aken|aking|ook) (?:it |them )?back\b|\btaken_back\b",
        "undo, revert",
    ),
    ("wild",): (r"\bwild\b", "outlier, gross error"),
    ("share",): (
        r"\bshares? of\b|\b(?:a|an|the|this|that|which|matched|smaller|larger|same) share\b"
        r"|_shares?\b|\bshare_(?!button|tunnel)",
        "ratio, fraction",
    ),
    ("doorkeeper", "patience", "seat"): (
        r"\bdoorkeeper\b|\bpatience\b|\bseats?\b",
        "the glossary's web terms",
    ),
    ("guess",): (
        r"\bguess(?:es|ed|ing)?\b|_guess(?:es)?\b|\bguess_",
        "prediction, hypothesis, detect",
    ),
    ("believ",): (r"\bbeliev\w*|\bunbeliev\w*", "consistent, plausible, accepted, trusted"),
    ("let",): (
        r"\blet(?:s|ting)? (?:somebody |them |it |him |in )?in\b",
        "sign in, admit, accept",
    ),
    ("picture",): (
        r"\bpictures?\b|_pictures?\b|\bpictures?_|(?<=\w)picture\b",
        "preview, thumbnail, image, chart",
    ),
    (
        "levell",
        "metre",
        "colour",
        "normalis",
        "grey",
        "centre",
        "neighbour",
        "behaviour",
        "analys",
    ): (
        r"\b(?<!\")levell\w*|\bmetre\b|metres\b|\bcolour\w*|\bnormalis\w*|\bgrey\w*|\bcentre\w*"
        r"|\bneighbour\w*|\bbehaviour\w*|\banalys(?:e|ed|es|ing)\b",
        "American spelling",
    ),
    ("way",): (
        r"\bway_m\b|\bthe way\b(?! (?:to|it|they|that|a|in which)\b)|\bof way\b",
        "path, path length",
    ),
    ("whoever",): (r"\bwhoever\b", "the person who, anyone who"),
    ("so-manieth", "seems_still", "hold_still", "gap_m"): (
        r"\b(?:so-manieth|seems_still|hold_still|gap_m)\b",
        "the glossary's terms",
    ),
}
"""What is in each place of a retired word, which is fast to find; the word; what to use."""
IN_FOLDER = {
    ("desk",): (r"\bdesks?\b", ("app/recon4_app/", "web/")),
    ("door",): (r"\bdoors?\b", ("app/recon4_app/", "web/")),
    ("hear",): (r"\bhear[ds]?\b", ("app/recon4_app/", "recon4/live/")),
}
"""Words with a meaning of their own elsewhere."""
FOREIGN = ('found["guesses"]', '"levelling"', '"levelled_by"', '"metre"', "node a; metres;")
"""Names of other libraries, and keys of stored files."""


def listed(paths: list[str]) -> list[str]:
    """Files below some paths, all without any: those that git tracks, and new ones."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *paths]
    found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in found.stdout.splitlines() if (ROOT / name).is_file()]


def lines_with(paths: list[str]) -> Iterator[tuple[str, int, str, str]]:
    """File, line number, the word found and what to use instead."""
    everywhere = [(parts, re.compile(word), fix) for parts, (word, fix) in RETIRED.items()]
    local = [(parts, re.compile(word), at) for parts, (word, at) in IN_FOLDER.items()]
    for name in listed(paths):
        if name in ALLOWED or Path(name).suffix not in SUFFIXES:
            continue
        here = [(parts, rx, "a plain verb") for parts, rx, at in local if name.startswith(at)]
        text = (ROOT / name).read_text("utf-8")
        for own_name in FOREIGN:
            text = text.replace(own_name, "")
        text = text.lower()  # twice as fast as to ignore case
        rules = [
            (rx, fix)
            for parts, rx, fix in everywhere + here
            if any(part in text for part in parts) and rx.search(text)
        ]
        for number, line in enumerate(text.splitlines() if rules else (), 1):
            for rx, fix in rules:
                for found in rx.finditer(line):
                    yield name, number, found.group(), fix


def main() -> None:
    """Print what is left; exit code 1 if there is any."""
    found = list(lines_with(sys.argv[1:]))
    for name, number, word, fix in found:
        print(f"{name}:{number}: {word!r} -> {fix}")
    print(f"{len(found)} retired words")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
