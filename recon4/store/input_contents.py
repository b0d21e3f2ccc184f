"""Inputs of a stage by their contents, so that what makes the same again makes nothing else run.

The key of an artifact says what it was made of. A stage that is given a key runs again whenever an
earlier one has run with other inputs, even if it wrote the same bytes as before. A stage that is
given contents does not.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.store.hashing import hash_arrays, hash_json
from recon4.store.stage import Artifact, Input


def files_of(artifact: Artifact, names: tuple[str, ...]) -> Input:
    """Some files of an artifact, as input of a stage that reads no other file of it.

    Args:
        artifact: A finished one.
        names: Of the files; one that the artifact does not have counts as missing.

    Returns:
        The folder of the artifact; its key is the SHA-256 of the hashes of these files.

    Raises:
        StoreError: If its manifest cannot be read.
    """
    files = artifact.manifest()["files"]
    hashes = {name: files[name]["sha256"] if name in files else None for name in names}
    return Input(hash_json(hashes), artifact.folder)


def arrays_of(value: Any, arrays: Mapping[str, NDArray[Any]]) -> Input:
    """A record that was read from an artifact, as input of a stage.

    Args:
        value: The record.
        arrays: All that it holds; they make its key.
    """
    return Input(hash_arrays({name: np.asarray(array) for name, array in arrays.items()}), value)
