"""The program for a page, as docs/typescript.md shows it, in Chromium with a port that replies."""

from __future__ import annotations

import re
import shutil
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

import npm_package
from targets.decoder.browser import evaluate, needs_chromium
from targets.typescript.comparison import package

pytestmark = [
    needs_chromium,
    pytest.mark.skipif(bool(npm_package.missing()), reason=npm_package.missing()),
]
POLICY = "default-src 'none'; connect-src 'self'; script-src 'self' 'wasm-unsafe-eval'"
HTML = """<!doctype html><title>Page</title><button>Read</button><output></output>
<script type="module" src="port.mjs"></script><script type="module" src="page.mjs"></script>"""
# A port that replies to get_angles with j1 = 1.4 degrees, and counts how often it is closed.
PORT = """
const reply = Uint8Array.of(0xfe, 0xfe, 14, 0x20, 0, 140, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xfa);
let replies;
const port = {
  async open() {
    port.readable = new ReadableStream({ start: (controller) => (replies = controller) });
    port.writable = new WritableStream({ write: () => replies.enqueue(reply.slice()) });
  },
  async close() { globalThis.closings = (globalThis.closings ?? 0) + 1; },
};
Object.defineProperty(navigator, "serial", { value: { requestPort: async () => port } });
"""
SHOWN = """
(async () => {
  document.querySelector("button").click();
  for (let waits = 0; waits < 500 && !globalThis.closings; waits += 1) {
    await new Promise((go) => setTimeout(go, 20));
  }
  return [document.querySelector("output").value, globalThis.closings];
})()
"""


class _Files(SimpleHTTPRequestHandler):
    def end_headers(self) -> None:
        self.send_header("Content-Security-Policy", POLICY)
        super().end_headers()

    def log_message(self, format: str, *args: object) -> None:
        """Log nothing."""


@pytest.fixture
def url(tmp_path: Path) -> Iterator[str]:
    """Serve the page with the two folders of the package that it needs."""
    for folder in ("dist", "editions"):
        shutil.copytree(package() / folder, tmp_path / "cobotwire" / folder)
    text = (npm_package.ROOT / "docs/typescript.md").read_text(encoding="utf-8")
    program = re.search(r"<!-- file: page.mjs -->\n```js\n(.*?)```", text, re.DOTALL)
    assert program is not None
    for name, content in (("index.html", HTML), ("port.mjs", PORT), ("page.mjs", program[1])):
        (tmp_path / name).write_text(content, encoding="utf-8")
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(_Files, directory=tmp_path)) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()
        thread.join()


def test_program_of_the_docs_reads_an_arm_in_a_page_with_a_strict_policy(url: str) -> None:
    assert evaluate(url, SHOWN) == [["1.4,0,0,0,0,0", 1]]
