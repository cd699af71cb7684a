"""The output targets, generated once for each test run into a temporary folder."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import lru_cache
from pathlib import Path

import vectors
from cobotwire_codegen.emit import write
from cobotwire_codegen.project import products


@lru_cache
def built(target: str) -> Path:
    """Return a folder with the generated files of an output target, such as ``wireshark``."""
    root = Path(tempfile.mkdtemp(prefix=f"cobotwire-{target}-"))
    atexit.register(shutil.rmtree, root, ignore_errors=True)
    [made] = products(root, [*vectors.editions().values()], [f"targets/{target}"])
    write(made)
    return made.folder
