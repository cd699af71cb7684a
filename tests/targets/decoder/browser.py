"""Headless Chromium, for pages that are files on this machine."""

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
    """The browser's program.

    Raises:
        ToolMissing: there is none.
    """
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    raise ToolMissing("Chromium is not installed (apt-get install chromium)")


def dom(url: str, *options: str) -> str:
    """The page's document after its scripts have run."""
    return _run("--dump-dom", "--virtual-time-budget=20000", *options, url)


def result(page: Path) -> Any:
    """What a page's scripts wrote, as JSON, into its ``<pre id="result">``."""
    found = re.search(r'<pre id="result">(.*?)</pre>', dom(page.as_uri()), re.DOTALL)
    assert found is not None, "the page's scripts did not come to their end"
    return json.loads(html.unescape(found.group(1)))


def picture(url: str, path: Path, width: int, height: int, *, dark: bool = False) -> None:
    """A screenshot of a page as a PNG file; a phone's is 390 wide."""
    shades = ["--blink-settings=preferredColorScheme=0"] if dark else []
    size = f"--window-size={width},{height}"
    _run(f"--screenshot={path}", size, "--hide-scrollbars", *shades, url)


def _run(*arguments: str) -> str:
    # Without a sandbox, as CI runs as root; it opens nothing but our own files.
    command = [chromium(), "--headless=new", "--no-sandbox", "--disable-gpu", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=True)
    return done.stdout
