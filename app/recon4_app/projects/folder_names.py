"""Folder names of new projects, made from the titles that people give.

A title is any line of text ("Office Brno, 2nd floor"); it stays the display name of the project.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable

from recon4_app.projects.tuning import FOLDER_NAMES


def folder_name(title: str) -> str:
    """The title in lower-case letters without accents, digits and dashes.

    ``project`` if the title has no letter or digit of the Latin alphabet.
    """
    plain = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode()
    return (
        re.sub(r"[^a-z0-9]+", "-", plain.lower()).strip("-")[: FOLDER_NAMES.longest].rstrip("-")
        or "project"
    )


def free_folder_name(title: str, is_taken: Callable[[str], bool]) -> str:
    """The folder name of a title, numbered if a project or another folder has it.

    Args:
        title: What a person calls the project.
        is_taken: Whether a name is in use.
    """
    name = folder_name(title)
    found, n = name, 2
    while is_taken(found):
        found, n = f"{name}-{n}", n + 1
    return found
