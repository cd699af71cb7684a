"""Gets the pages of the conformance test suite from the package.

The generator does not import the package. It runs the package in a process of its own, so that the
pages are made from the files as they are now.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path, PurePosixPath

from cobotwire_codegen.render import Files

MODULE = "cobotwire.conformance.catalogue"
HISTORY = "python/cobotwire/conformance/catalogue/history.py"


class SuiteError(Exception):
    """The pages of the test suite cannot be made; the text says why, and what to do."""


def suite_pages(root: Path) -> Files:
    """Return the pages of the catalogue of test cases, below the folder of the reference.

    A project without a test suite has none.

    Raises:
        SuiteError: the test cases have changed and the catalogue has no new version, or they cannot
            be listed.
    """
    if not (root / HISTORY).is_file():
        return {}
    package = str((root / "python").resolve())
    path = os.pathsep.join([package, *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(  # noqa: S603  (the project's own package)
        [sys.executable, "-m", MODULE],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise SuiteError(done.stderr.strip().rpartition("\n")[2])
    pages = json.loads(done.stdout)
    return {PurePosixPath("test-suite", name): text for name, text in pages.items()}
