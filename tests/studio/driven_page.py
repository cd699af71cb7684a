"""Drive the page in Chromium: wait for what it shows, press keys, take pictures."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from targets.decoder.browser import Tab

SECONDS = 30
KEYS = {"Tab": 9, "Enter": 13, "Escape": 27, " ": 32, "End": 35, "Home": 36, "ArrowUp": 38}
KEYS |= {"ArrowDown": 40, "ArrowLeft": 37, "ArrowRight": 39}
# Wait in the page itself, since each evaluation from here costs a round trip.
UNTIL = """
async (look) => {
  const end = Date.now() + %d;
  for (;;) {
    const found = await look();
    if (found || Date.now() > end) return typeof found === "object" ? Boolean(found) : found;
    await new Promise((go) => setTimeout(go, 30));
  }
}
"""


class Page:
    """A page of the studio in a browser."""

    def __init__(self, tab: Tab) -> None:
        self.tab = tab

    def show(self, width: int = 1280, height: int = 900, *, dark: bool = False) -> None:
        """Set the size of the screen, and its colours."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
        self.tab.call("Emulation.setDeviceMetricsOverride", **size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.tab.call("Emulation.setEmulatedMedia", features=[scheme])

    def open(self, url: str) -> None:
        """Open a page of the studio, and wait until it is connected."""
        self.tab.open("about:blank")
        # Discard what an earlier page reported.
        self.tab.events.clear()
        self.tab.open(url)
        self.until("document.documentElement.dataset.ready")

    def get(self, expression: str) -> Any:
        """Return the value of an expression, or of its promise."""
        return self.tab.evaluate(expression)

    def text(self, id: str) -> str:
        """Return the text of an element."""
        return str(self.get(f"document.getElementById({json.dumps(id)}).textContent"))

    def until(self, expression: str) -> Any:
        """Wait until an expression is true, and return its value."""
        waiting = UNTIL % (1000 * SECONDS)
        found = self.get(f"({waiting})(() => ({expression}))")
        assert found, f"{expression} stays {found!r}"
        return found

    def click(self, selector: str) -> None:
        """Click an element, as soon as it is there and can be clicked."""
        element = f"document.querySelector({json.dumps(selector)})"
        self.until(f"{element} && !{element}.disabled")
        self.get(f"{element}.click()")

    def show_tab(self, panel: str) -> None:
        """Show the panel of a tab."""
        self.click(f"[role=tab][aria-controls={panel}]")

    def middle(self, selector: str) -> tuple[float, float]:
        """Return where the middle of an element is on the screen, after scrolling to it."""
        x, y = self.get(
            f"(() => {{ const found = document.querySelector({json.dumps(selector)});"
            " found.scrollIntoView({ block: 'nearest' });"
            " const box = found.getBoundingClientRect();"
            " return [box.x + box.width / 2, box.y + box.height / 2]; })()"
        )
        return x, y

    def mouse(self, kind: str, x: float, y: float) -> None:
        """Move the mouse, or press or release its left button: ``mouseMoved`` and so on."""
        held = 0 if kind == "mouseReleased" else 1
        button = {"button": "left", "buttons": held, "clickCount": 1}
        self.tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **button)

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        """Touch the screen: ``touchStart`` and ``touchMove`` with points, ``touchEnd`` without."""
        at = [{"x": x, "y": y} for x, y in points]
        self.tab.call("Input.dispatchTouchEvent", type=kind, touchPoints=at)

    def choose(self, id: str, value: str) -> None:
        """Write a value into a box, or choose it."""
        self.get(
            f"(() => {{ const box = document.getElementById({json.dumps(id)});"
            f" box.value = {json.dumps(value)};"
            " box.dispatchEvent(new Event('input', { bubbles: true })); })()"
        )

    def press(self, key: str) -> None:
        """Press a key where the focus is."""
        self.key("keyDown", key)
        self.key("keyUp", key)

    def key(self, kind: str, key: str) -> None:
        """Press or release a key: ``keyDown`` or ``keyUp``."""
        event: dict[str, Any] = {"key": key, "code": "Space" if key == " " else key}
        event |= {"windowsVirtualKeyCode": KEYS[key]}
        text = {"text": "\r" if key == "Enter" else " "} if key in ("Enter", " ") else {}
        event |= text if kind == "keyDown" else {}
        self.tab.call("Input.dispatchKeyEvent", type=kind, **event)

    def send(self, command: str, *numbers: float) -> str:
        """Send a command through the form; return what the page says about it."""
        self.until(f"document.querySelector('#command option[value={command}]')")
        self.choose("command", command)
        boxes = "document.querySelectorAll('#form .boxes input')"
        for at, number in enumerate(numbers):
            self.get(f"{boxes}[{at}].value = '{number}'")
        self.click("#form .primary")
        result = "document.querySelector('#form .result').textContent"
        return str(self.until(f"{result} !== 'sending' && {result}"))

    def control(self) -> None:
        """Wait for control and motion, which the first page of a simulated arm has."""
        self.until("document.getElementById('motion').checked")

    def picture(self, path: Path) -> None:
        """Write a picture of what the window shows: a .png or .webp file."""
        found = self.tab.call("Page.captureScreenshot", format=path.suffix[1:], quality=80)
        path.write_bytes(base64.b64decode(found["data"]))

    @property
    def complaints(self) -> list[str]:
        """What the browser logged: errors of scripts, and violations of the policy."""
        return [
            json.dumps(event)
            for event in self.tab.events
            if event.get("method") in ("Runtime.exceptionThrown", "Log.entryAdded")
        ]

    @property
    def hosts(self) -> set[str]:
        """The hosts from which the page requested something."""
        requests = [e for e in self.tab.events if e.get("method") == "Network.requestWillBeSent"]
        urls = [str(event["params"]["request"]["url"]) for event in requests]
        return {url.split("/")[2] for url in urls if url.startswith(("http:", "https:", "ws:"))}


@contextmanager
def browser() -> Iterator[Page]:
    """Run a browser with one page."""
    with Tab() as tab:
        yield Page(tab)
