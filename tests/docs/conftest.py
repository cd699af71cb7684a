"""The docs site, built once for all tests, with the pages of a sample of the editions.

``make docs`` builds the pages of all editions; there, a warning is an error too.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import npm_package
from targets.typescript.comparison import package
from vectors import NOT_ON_SITE, ROOT

# As `make docs`, but without garbage collection, which takes a fifth of the time.
BUILD = "import gc, sys; gc.disable(); from sphinx.cmd.build import main; sys.exit(main())"


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site with a proxy that leads nowhere, so that nothing can be fetched."""
    if not npm_package.missing():
        package()  # the page that decodes bytes needs it
    folder = tmp_path_factory.mktemp("site")
    nowhere = {f"{way}_proxy": "http://127.0.0.1:9" for way in ("http", "https")}
    command = [sys.executable, "-c", BUILD, "-q", "-W", "--keep-going", "-b", "html"]
    left_out = [
        page for name in NOT_ON_SITE for page in (f"reference/{name}/*", f"robots/{name}.md")
    ]
    command += ["-D", f"exclude_patterns={','.join(['_build', *left_out])}"]
    done = subprocess.run(
        [*command, str(ROOT / "docs"), str(folder)],
        capture_output=True,
        text=True,
        env={
            "PATH": "/usr/bin:/bin",
            "HOME": str(folder),
            "PYTHONPATH": os.environ.get("PYTHONPATH", ""),
            **nowhere,
        },
    )
    assert (done.returncode, done.stderr) == (0, "")
    return folder
