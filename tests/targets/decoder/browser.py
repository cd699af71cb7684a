"""Run headless Chromium, which all tests of a process share, since it starts slowly."""

from __future__ import annotations

import atexit
import json
import os
import select
import shutil
import signal
import subprocess
from contextlib import ExitStack
from functools import lru_cache
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pytest

from targets.comparison import ToolMissing

NAMES = ("chromium", "chromium-browser", "google-chrome")
SECONDS = 120
# No sandbox, since CI runs as root; Chromium opens only our own files.
OPTIONS = ("--headless=new", "--no-sandbox", "--disable-gpu")

# Use the page as a person does: choose, paste, wait, and keep what it shows each time.
SHOWN = """
async function shown(state) {
  const root = document.getElementById("decoder");
  for (const [name, value] of Object.entries(state || {})) {
    root.querySelector(`[name=${name}]`).value = value;
  }
  if (state) root.dispatchEvent(new Event("input"));
  await answered(root);
  return root.querySelector(".output").outerHTML;
}
async function answered(root) {
  while (root.querySelector(".output[aria-busy]")) await new Promise((go) => setTimeout(go, 1));
}
"""


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


needs_chromium = pytest.mark.skipif(
    not any(map(shutil.which, NAMES)), reason="Chromium is not installed"
)


@lru_cache
def _shared() -> Tab:
    stack = ExitStack()
    atexit.register(stack.close)
    return stack.enter_context(Tab())


def new_tab() -> Tab:
    """Return a new page of the browser that tests share; the page before becomes blank."""
    tab = _shared()
    tab.open("about:blank")
    tab.renew()
    tab.events.clear()
    return tab


class Tab:
    """A page in a browser that takes commands of the DevTools protocol on descriptors 3 and 4."""

    def __init__(self) -> None:
        self._count = 0
        self._session: dict[str, str] = {}
        # What the page reported, such as what it logged, once its domain is enabled.
        self.events: list[dict[str, Any]] = []

    def __enter__(self) -> Self:
        theirs_in, ours_out = os.pipe()
        ours_in, theirs_out = os.pipe()
        command = [chromium(), *OPTIONS, "--remote-debugging-pipe", "about:blank"]
        script = f'exec "$@" 3<&{theirs_in} 4>&{theirs_out}'
        self._process = subprocess.Popen(
            ["bash", "-c", script, "bash", *command],
            pass_fds=(theirs_in, theirs_out),
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        os.close(theirs_in)
        os.close(theirs_out)
        self._in, self._out = open(ours_in, "rb", buffering=0), open(ours_out, "wb", buffering=0)
        self._read = b""
        self.renew()
        return self

    def renew(self) -> None:
        """Use a new page of the browser from now on."""
        self._session = {}
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = {"sessionId": attached["sessionId"]}
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        # The browser has its own process group.
        os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._in.close()
        self._out.close()

    def open(self, url: str) -> None:
        """Go to a page, and wait until it is loaded."""
        self.call("Page.navigate", url=url)
        while self._message().get("method") != "Page.loadEventFired":
            pass

    def evaluate(self, expression: str) -> Any:
        """Return the value of an expression, or of its promise."""
        found = self.call(
            "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Run a command of the DevTools protocol; return its result."""
        self._count += 1
        request = {"id": self._count, "method": method, "params": parameters, **self._session}
        data = json.dumps(request).encode() + b"\0"
        while data:
            data = data[self._out.write(data) or 0 :]
        while (answer := self._message()).get("id") != self._count:
            self.events.append(answer)
        assert "error" not in answer, answer
        return dict(answer["result"])

    def _message(self) -> dict[str, Any]:
        while b"\0" not in self._read:
            ready, _, _ = select.select([self._in], [], [], SECONDS)
            data = self._in.read(1 << 20) if ready else b""
            assert data, "the browser does not answer"
            self._read += data
        message, _, self._read = self._read.partition(b"\0")
        return dict(json.loads(message))


def picture(url: str, path: Path, width: int, height: int, *, dark: bool = False) -> None:
    """Write a screenshot of a page to a PNG file; 390 is the width of a phone."""
    shades = ["--blink-settings=preferredColorScheme=0"] if dark else []
    size = (f"--window-size={width},{height}", "--hide-scrollbars")
    command = [chromium(), *OPTIONS, f"--screenshot={path}", *size, *shades, url]
    subprocess.run(command, capture_output=True, timeout=SECONDS, check=True)
