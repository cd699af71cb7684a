"""Take the pictures of docs/studio.md: python -m studio.pictures FOLDER."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from studio.driven_page import Page, browser
from studio.recordings import record
from studio.studio_server import running

ROWS = "[...document.querySelectorAll('.row:not([hidden])')]"
SETTLED = "new Promise((go) => setTimeout(go, 700))"


def live(page: Page, folder: Path) -> None:
    """Take pictures of an arm on its way to a target: on a wide screen, then on a dark phone."""
    with running("--rate", "20") as studio:
        page.show(1440, 900)
        page.open(studio.url)
        page.control()
        page.send("send_angles", 50, 20, -60, 40, 10, 0, 60)
        page.get(SETTLED)
        page.send("send_angles", -40, -50, -70, 30, 60, 20, 25)
        page.get(SETTLED)
        page.picture(folder / "studio-live.webp")
        page.show(390, 844, dark=True)
        page.send("send_angles", 60, 30, -60, 10, -50, 0, 25)
        page.get(SETTLED)
        page.get("scrollTo(0, 0)")
        page.get(SETTLED)
        page.picture(folder / "studio-phone.webp")


def faults(page: Page, folder: Path) -> None:
    """Take a picture of a fault scenario and of explained noise, in dark mode."""
    with running() as studio:
        page.show(1440, 900, dark=True)
        page.open(studio.url)
        page.control()
        page.show_tab("line")
        page.choose("scenario", "servo-leaks")
        page.click("#begin")
        page.until("document.querySelectorAll('#injected li').length > 11")
        page.choose("by-noise", "servo")
        page.until(f"{ROWS}.length > 5 && {ROWS}.every((row) => row.innerText.includes('servo'))")
        page.get(f"{ROWS}[4].click()")
        page.until("document.getElementById('details').textContent.includes('What to do')")
        page.choose("by-noise", "")
        page.get(SETTLED)
        page.picture(folder / "studio-faults.webp")


def recording(page: Page, folder: Path) -> None:
    """Take a picture of a recording in the middle of a motion."""
    with tempfile.TemporaryDirectory() as place:
        path = record(Path(place) / "arm.pcapng", 8.0)
        with running(str(path)) as studio:
            page.show(1280, 800)
            page.open(studio.url)
            page.choose("scrub", "1.4")
            page.show_tab("line")
            page.until(f"{ROWS}.length > 2")
            page.get(SETTLED)
            page.picture(folder / "studio-recording.webp")


def main() -> None:
    """Take all pictures."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    with browser() as page:
        live(page, folder)
        faults(page, folder)
        recording(page, folder)


if __name__ == "__main__":
    main()
