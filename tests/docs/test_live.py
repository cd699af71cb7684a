"""The page live/ drives a simulated arm in Chromium, and explains bytes as the studio does."""

from __future__ import annotations

import base64
import json
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import live_page
import npm_package
import vectors
from cobotwire import editions
from cobotwire.capture import read
from cobotwire.studio.describing import Describer
from cobotwire.studio.explained import Explainer
from cobotwire.studio.recorded import RecordedSession
from docs.live_site import STOP, LiveSite, serving
from studio.driven_page import Page, browser
from studio.test_page import ANGLES, AXE, ROWS, violation
from targets.decoder.browser import needs_chromium

pytestmark = [
    needs_chromium,
    pytest.mark.skipif(bool(live_page.missing()), reason=live_page.missing()),
]
JOG = bytes.fromhex("FE FE 05 30")
PLUS = "#joints li:nth-child(1) .jog:nth-of-type(2)"
SAID = "document.getElementById('said').textContent"
# Play a recording in Node; print what the page gets, an explanation of each entry, and the export.
NODE = """
import { readFileSync } from "node:fs";
import { read } from "./pcapng.js";
import { Recorded } from "./recorded.js";
const facts = JSON.parse(readFileSync("editions/mycobot280.json", "utf8"));
const module = await import("./cobotwire/editions/mycobot280.js");
const got = { entries: [], samples: [] };
const publish = ({ entries = [], samples = [] }) => {
  got.entries.push(...entries);
  got.samples.push(...samples);
};
const capture = read(readFileSync(process.argv[2]));
const session = await Recorded.make(publish, facts, module, capture);
session.advance(1e9);
const explained = session.entries.map(({ n }) => session.explain(n));
const file = Buffer.from(await (await session.exported({})).arrayBuffer()).toString("base64");
console.log(JSON.stringify({ ...got, explained, file }));
"""


# Save a long recording in Node; print how long another task had to wait, in seconds.
LONG = """
import { written } from "./pcapng.js";
const entry = { t: 1, d: "sent", data: Uint8Array.of(0xfe, 0xfe, 2, 0x20, 0xfa) };
const begun = performance.now();
setTimeout(() => console.log((performance.now() - begun) / 1000), 1);
const port = { url: "port", edition: "mycobot280", baudrate: 1000000, startNs: 0n };
await written(new Array(200_000).fill(entry), () => true, port);
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("site") / "live"
    live_page.build(made, [*vectors.editions().values()])
    return made


@pytest.fixture(scope="module")
def page() -> Iterator[Page]:
    with browser() as found:
        yield found


@pytest.fixture
def site(folder: Path, page: Page) -> Iterator[LiveSite]:
    """Open the page of a new site, which has an arm at its port."""
    with serving(folder) as site:
        _open(page, site.url)
        yield site
        page.tab.open("about:blank")


def _open(page: Page, url: str) -> None:
    page.show()
    page.tab.events.clear()
    page.tab.open(url)
    page.until("document.documentElement.dataset.offered")


def _connect(page: Page) -> None:
    page.click("#connect")
    page.until(f"{SAID}.startsWith('Connected: ')")
    page.until(f"{ANGLES}.length === 6 && {ANGLES}.every(Number.isFinite)")


def _allow(page: Page) -> None:
    page.click("#motion:not(:checked)")
    page.until("!document.getElementById('controls-of-arm').disabled")


def _jog(page: Page, site: LiveSite) -> None:
    """Hold the button that moves the first joint, until it moves."""
    _allow(page)
    page.mouse("mousePressed", *page.middle(PLUS))
    page.until(f"{ANGLES}[0] > 1")
    assert site.sent.count(JOG) == 1
    assert STOP not in site.sent


def _soon(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 5
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_recording_becomes_the_entries_and_samples_of_the_studio(folder: Path) -> None:
    script, path = folder / "play.mjs", folder / "example.pcapng"
    script.write_text(NODE, "utf-8")
    words = ("node", script.name, path.name)
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    session = RecordedSession(str(path), "mycobot280")
    describer, explainer = (
        Describer(session.codec),
        Explainer(editions.load("mycobot280"), session.codec),
    )
    described = [describer.describe(*each) for each in enumerate(session.entries())]
    assert len(described) > 600
    _same(found["entries"], [json.loads(each.entry) for each in described])
    _same(found["samples"], [json.loads(text) for each in described for text in each.samples])
    _same(found["explained"], [explainer.explain(each) for each in session.entries()])
    copy = folder / "copy.pcapng"
    copy.write_bytes(base64.b64decode(found["file"]))
    with read(path) as ours, read(copy) as theirs:
        packets = [[p[:5] for p in sorted(c, key=lambda p: p.time_ns)] for c in (ours, theirs)]
        assert packets[0] == packets[1]
        assert theirs.finished
        assert theirs.interfaces[0].edition == "mycobot280"


def _same(found: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    for one, other in zip(found, expected, strict=True):
        assert one.keys() == other.keys()
        for name, value in one.items():
            loose = name in ("t", "time", "r", "j", "c", "tj", "te")
            assert value == (pytest.approx(other[name], abs=1e-3) if loose else other[name]), name


def test_arm_is_connected_driven_and_saved(site: LiveSite, page: Page, tmp_path: Path) -> None:
    _connect(page)
    assert "Allow motion" in page.text("move-why")
    _allow(page)
    assert page.send("send_angles", 20, 10, 0, 0, 0, 0, 31).startswith("speed is 31")
    assert page.send("send_angles", 20, 10, 0, 0, 0, 0, 30) == "sent"
    page.until(f"Math.abs({ANGLES}[0] - 20) < 0.1")
    page.tab.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    page.click("#save")
    page.until(f"{SAID}.startsWith('live.pcapng, ')")
    _soon(lambda: (tmp_path / "live.pcapng").is_file())
    with read(tmp_path / "live.pcapng") as capture:
        sent = b"".join(packet.data for packet in capture if packet.direction == "sent")
    assert site.sent.startswith(sent)
    assert len(sent) > 100
    assert page.complaints == []


def test_stop_does_not_wait_until_a_long_recording_is_saved(folder: Path) -> None:
    (folder / "long.mjs").write_text(LONG, "utf-8")
    words = ("node", "long.mjs")
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
    assert float(done.stdout) < 0.2


def test_jog_lasts_while_the_button_is_held(site: LiveSite, page: Page) -> None:
    _connect(page)
    _jog(page, site)
    page.mouse("mouseReleased", 0, 0)
    _soon(lambda: site.sent.count(STOP) == 1)
    assert site.sent.rindex(STOP) > site.sent.rindex(JOG)


def test_hanging_page_does_not_keep_the_arm_moving(site: LiveSite, page: Page) -> None:
    _connect(page)
    _jog(page, site)
    hanging = time.monotonic()
    page.get("{ const end = Date.now() + 3000; while (Date.now() < end); }")
    assert time.monotonic() - hanging > 2.9
    stopped = site.stopped_at - hanging
    assert 0.3 < stopped < 1.5


@pytest.mark.parametrize("stop", ["Escape", "click"])
def test_stop_needs_no_permission(site: LiveSite, page: Page, stop: str) -> None:
    _connect(page)
    page.click("#control")
    page.until("document.getElementById('control').textContent === 'Take control'")
    page.press("Escape") if stop == "Escape" else page.click("#stop")
    _soon(lambda: STOP in site.sent)
    page.until("document.getElementById('status').textContent === 'stop was sent'")


@pytest.mark.parametrize("way", ["reload", "close"])
def test_left_page_stops_an_arm_in_motion(site: LiveSite, way: str) -> None:
    with browser() as page:
        _open(page, site.url)
        _connect(page)
        _allow(page)
        assert page.send("send_angles", 160, 0, 0, 0, 0, 0, 10) == "sent"
        assert STOP not in site.sent
        if way == "close":
            page.tab.call("Page.close")
        else:
            page.tab.open(site.url)
        _soon(lambda: STOP in site.sent)


def test_unplugged_arm_is_reported_and_can_be_connected_again(site: LiveSite, page: Page) -> None:
    _connect(page)
    _jog(page, site)
    site.unplug()
    page.until("document.getElementById('status').textContent === 'the port is gone'")
    assert "Stop cannot reach the arm: use its switch." in page.text("move-status")
    assert page.text("move-why") == "The port is gone."
    page.press("Escape")
    page.until("document.getElementById('notice').textContent.startsWith('Stop was NOT sent: ')")
    assert page.get("document.getElementById('motion').checked") is False
    page.click("#again")
    page.until(f"{SAID}.startsWith('Connected: ')")
    page.until("document.getElementById('move-why').textContent.includes('Allow motion')")


def test_page_works_offline_with_a_recording(site: LiveSite, page: Page) -> None:
    page.until("navigator.serviceWorker.controller")
    page.tab.call(
        "Network.emulateNetworkConditions",
        offline=True,
        latency=0,
        downloadThroughput=0,
        uploadThroughput=0,
    )
    try:
        _open(page, site.url)
        page.click("#example")
        page.show_tab("line")
        page.choose("scrub", "3")
        page.until(f"{ROWS}.length && {ANGLES}.every(Number.isFinite)")
        page.click("#play")
        page.until("document.getElementById('play').textContent === 'Pause'")
    finally:
        page.tab.call(
            "Network.emulateNetworkConditions",
            offline=False,
            latency=0,
            downloadThroughput=-1,
            uploadThroughput=-1,
        )


@pytest.mark.usefixtures("site")
def test_page_cannot_request_from_another_host(page: Page) -> None:
    blocked = page.get(
        "new Promise((done) => { addEventListener('securitypolicyviolation', (event) => "
        "done(event.effectiveDirective)); setTimeout(done, 3000, 'nothing'); "
        "fetch('http://127.0.0.2:9').catch(() => {}); })"
    )
    assert blocked == "connect-src"


def test_browser_without_webserial_opens_recordings(folder: Path, page: Page) -> None:
    with serving(folder, "delete Navigator.prototype.serial;\n") as site:
        _open(page, site.url)
        assert "lacks WebSerial" in page.text("connecting")
        assert page.get("document.getElementById('connect')") is None
        page.click("#example")
        page.until(f"{ANGLES}.every(Number.isFinite)")


@pytest.mark.skipif(not AXE.is_file(), reason="axe-core is missing: make front-end")
@pytest.mark.parametrize(("width", "dark"), [(1440, False), (390, True)])
def test_page_fits_and_axe_finds_nothing_serious(
    site: LiveSite, page: Page, width: int, dark: bool
) -> None:
    page.show(width, 844, dark=dark)
    page.get(AXE.read_text())
    for connected in (False, True):
        if connected:
            _connect(page)
        root = "document.documentElement"
        assert page.get(f"{root}.scrollWidth <= {root}.clientWidth")
        rules = "{ resultTypes: ['violations'] }"
        found = page.get(f"axe.run({rules}).then((found) => found.violations)")
        serious = [each for each in found if each["impact"] in ("serious", "critical")]
        assert [violation(each) for each in serious] == []


def test_site_without_node_says_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(npm_package, "missing", lambda: "needs node: not installed")
    live_page.build(tmp_path / "live", [])
    assert "needs node: not installed" in (tmp_path / "live/index.html").read_text("utf-8")
