"""Run headless Chromium on pages that are local files."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

from targets.comparison import ToolMissing

NAMES = ("chromium", "chromium-browser", "google-chrome")
SECONDS = 120


def chromium() -> str:
    """Return the path of the browser.

    Raises:
        ToolMissing: Chromium is not installed.
    """
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    raise ToolMissing("Chromium is not installed (apt-get install chromium)")


def dom(url: str, *options: str) -> str:
    """Return the page's document after its scripts have run."""
    return _run("--dump-dom", "--virtual-time-budget=20000", *options, url)


def result(page: Path) -> Any:
    """Return what a page's scripts wrote, as JSON, into its ``<pre id="result">``."""
    found = re.search(r'<pre id="result">(.*?)</pre>', dom(page.as_uri()), re.DOTALL)
    assert found is not None, "the page's scripts did not run to their end"
    return json.loads(html.unescape(found.group(1)))


def picture(url: str, path: Path, width: int, height: int, *, dark: bool = False) -> None:
    """Write a screenshot of a page to a PNG file; 390 is the width of a phone."""
    shades = ["--blink-settings=preferredColorScheme=0"] if dark else []
    size = f"--window-size={width},{height}"
    _run(f"--screenshot={path}", size, "--hide-scrollbars", *shades, url)


def _run(*arguments: str) -> str:
    # No sandbox, since CI runs as root; Chromium opens only our own files.
    command = [chromium(), "--headless=new", "--no-sandbox", "--disable-gpu", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=True)
    return done.stdout
