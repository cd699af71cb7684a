"""The page live/ drives a simulated arm in Chromium, and explains bytes as the studio does."""

from __future__ import annotations

import base64
import json
import re
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import live_page
import npm_package
import vectors
from cobotwire import codec, editions
from cobotwire.capture import read
from cobotwire.codec.interface import Frame
from cobotwire.conformance.survey import read_survey
from cobotwire.editions.mycobot280.table import TABLE
from cobotwire.inspect.evidence import ask
from cobotwire.inspect.identification import identify_on
from cobotwire.simulator import MemoryTransport, SimulatedArm, SteppedClock
from cobotwire.studio.describing import Describer
from cobotwire.studio.explained import Explainer
from cobotwire.studio.recorded import RecordedSession
from cobotwire.transport.tapped import borrowed
from codegen.author import samples
from docs.live_site import PORT, STOP, LiveSite, serving
from in_process import cobotwire
from studio.driven_page import Page
from studio.test_page import ANGLES, AXE, ROWS, violation
from targets.decoder.browser import needs_chromium, new_tab
from wrong_arms import without

pytestmark = [
    needs_chromium,
    pytest.mark.skipif(bool(live_page.missing()), reason=live_page.missing()),
]
JOG = bytes.fromhex("FE FE 05 30")
PLUS = "#joints li:nth-child(1) .jog:nth-of-type(2)"
SURVEYED = "document.getElementById('surveyed').textContent"
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

PROGRAM = """<!doctype html><title>Page</title><button>Read</button><output></output>
<script type="module" src="port.mjs"></script><script type="module" src="page.mjs"></script>"""
# In Node, save a long recording, read one with an option that is too short, and save half a frame.
# Print whether another task ran meanwhile, the error, and the sizes of the packets.
FILES = """
import { read, written } from "./pcapng.js";
import { Session, Stream } from "./session.js";
const entry = { t: 1, d: "sent", data: Uint8Array.of(0xfe, 0xfe, 2, 0x20, 0xfa) };
const port = { url: "port", edition: "mycobot280", baudrate: 1000000, startNs: 0n };
let meanwhile = false;
setTimeout(() => (meanwhile = true), 1);
const file = await written(new Array(5000).fill(entry), () => true, port);
const bytes = new Uint8Array(await file.arrayBuffer());
const resolution = Buffer.from(bytes).indexOf(Buffer.of(9, 0, 1, 0));
bytes[resolution + 2] = 0;
let error;
try {
  read(bytes);
} catch (thrown) {
  error = thrown.message;
}
const stream = await Stream.load("received", await import("./cobotwire/editions/mycobot280.js"));
const session = new Session(() => {}, { robot: {} }, [stream], port);
session.add(stream.take(1, entry.data.slice(0, 3)));
session.startNs = 0n;
const half = read(new Uint8Array(await (await session.exported({})).arrayBuffer()));
console.log(JSON.stringify([meanwhile, error, half.packets.map(({ data }) => data.length)]));
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("site") / "live"
    live_page.build(made, lambda: [*vectors.editions().values()])
    return made


@pytest.fixture(scope="module")
def identification(folder: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((folder / "identification.json").read_text("utf-8"))
    return found


@pytest.fixture(scope="module")
def page() -> Page:
    return Page(new_tab())


@pytest.fixture(scope="module")
def served(folder: Path) -> Iterator[LiveSite]:
    with serving(folder) as site:
        yield site


@pytest.fixture
def site(served: LiveSite, page: Page) -> LiveSite:
    """Open the page, and plug in a new arm."""
    page.tab.open("about:blank")
    served.reset()
    _open(page, served.url)
    return served


def _open(page: Page, url: str) -> None:
    page.show()
    page.tab.events.clear()
    page.tab.open(url)
    page.until("document.documentElement.dataset.offered")


def _reopen(page: Page, url: str) -> None:
    """Leave the page, and open it again."""
    page.tab.open("about:blank")
    _open(page, url)


def _connect(page: Page) -> None:
    page.click("#connect")
    page.until(f"{SAID}.startsWith('Connected: ')")
    page.until(f"{ANGLES}.length === 6 && {ANGLES}.every(Number.isFinite)")


def _allow(page: Page) -> None:
    page.click("#motion:not(:checked)")
    page.until("!document.getElementById('controls-of-arm').disabled")


def _jog(page: Page, site: LiveSite) -> None:
    """Hold the button that moves the first joint, until it moves."""
    page.mouse("mousePressed", *page.middle(PLUS))
    _soon(lambda: site.sent.count(JOG) == 1)
    page.until(f"{ANGLES}[0] > 1")
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


def test_arm_is_driven_saved_and_stopped(site: LiveSite, page: Page, tmp_path: Path) -> None:
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
    assert sent in site.sent
    assert len(sent) > 100
    # Stop needs neither permission nor control.
    page.click("#control")
    page.until("document.getElementById('control').textContent === 'Take control'")
    page.click("#stop")
    _soon(lambda: STOP in site.sent)
    page.until("document.getElementById('status').textContent === 'stop was sent'")
    page.press("Escape")
    _soon(lambda: site.sent.count(STOP) == 2)
    assert page.complaints == []


def test_files_are_written_in_steps_with_all_bytes_and_read_with_plain_errors(
    folder: Path,
) -> None:
    (folder / "files.mjs").write_text(FILES, "utf-8")
    words = ("node", "files.mjs")
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
    error = "the recording is damaged: an option is too short"
    assert json.loads(done.stdout) == [True, error, [3]]


def test_jog_lasts_while_the_button_is_held_and_the_page_does_not_hang(
    site: LiveSite, page: Page
) -> None:
    _connect(page)
    _allow(page)
    _jog(page, site)
    page.mouse("mouseReleased", 0, 0)
    _soon(lambda: site.sent.count(STOP) == 1)
    assert site.sent.rindex(STOP) > site.sent.rindex(JOG)
    site.sent.clear()
    _jog(page, site)
    hanging = time.monotonic()
    page.get("{ const slow = new XMLHttpRequest(); slow.open('GET', 'slow', false); slow.send(); }")
    assert time.monotonic() - hanging > 1.1
    assert 0.3 < site.stopped_at - hanging < 1.1


@pytest.mark.parametrize("way", ["reload", "close"])
def test_leaving_the_page_stops_an_arm_in_motion(site: LiveSite, page: Page, way: str) -> None:
    _connect(page)
    _allow(page)
    assert page.send("send_angles", 160, 0, 0, 0, 0, 0, 10) == "sent"
    assert STOP not in site.sent
    if way == "close":
        page.tab.call("Page.close")
        page.tab.renew()
    else:
        page.tab.open(site.url)
    _soon(lambda: STOP in site.sent)


def test_unplugged_arm_is_reported_and_can_be_connected_again(site: LiveSite, page: Page) -> None:
    site.silent_after = 0
    page.click("#connect")
    _soon(lambda: bool(site.sent))
    site.unplug()
    page.until(f"{SAID}.includes('lost')")
    site.silent_after = None
    _connect(page)
    _allow(page)
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


def test_new_version_waits_for_the_old_page_and_works_offline(
    site: LiveSite, page: Page, folder: Path
) -> None:
    site.instead.clear()
    titles, names = "document.getElementById('edition').textContent", "caches.keys()"
    # When the page is closed, the waiting version becomes active.
    _reopen(page, site.url)
    page.until(f"{names}.then((found) => found.length === 1)")
    page.until("navigator.serviceWorker.getRegistration().then(({ waiting }) => waiting)")
    _reopen(page, site.url)
    page.until("navigator.serviceWorker.controller")
    text = (folder / "editions.json").read_text("utf-8")
    site.instead["editions.json"] = text.replace("today's firmware", "a newer title")
    service = (folder / "service.js").read_text("utf-8")
    site.instead["service.js"] = service.replace('"cobotwire-live-", "', '"cobotwire-live-", "new')
    page.get("navigator.serviceWorker.getRegistration().then((found) => found.update())")
    page.until("navigator.serviceWorker.getRegistration().then(({ waiting }) => waiting)")
    assert "today's firmware" in page.get("fetch('editions.json').then((old) => old.text())")
    _reopen(page, site.url)
    assert "a newer title" in page.get(titles)
    assert page.get(f"{names}.then((found) => found.length)") == 1
    limits = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
    page.tab.call("Network.emulateNetworkConditions", offline=True, **limits)
    try:
        _open(page, site.url)
        page.click("#example")
        page.show_tab("line")
        page.choose("scrub", "3")
        page.until(f"{ROWS}.length && {ANGLES}.every(Number.isFinite)")
        page.click("#play")
        page.until("document.getElementById('play').textContent === 'Pause'")
    finally:
        page.tab.call("Network.emulateNetworkConditions", offline=False, **limits)
        page.get("navigator.serviceWorker.getRegistration().then((found) => found.unregister())")


@pytest.mark.usefixtures("site")
def test_page_cannot_request_from_another_host(page: Page) -> None:
    blocked = page.get(
        "new Promise((done) => { addEventListener('securitypolicyviolation', (event) => "
        "done(event.effectiveDirective)); setTimeout(done, 3000, 'nothing'); "
        "fetch('http://127.0.0.2:9').catch(() => {}); })"
    )
    assert blocked == "connect-src"


def test_browser_without_webserial_opens_recordings(site: LiveSite, page: Page) -> None:
    _reopen(page, f"{site.url}#none")
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
            page.click("#run")
            page.until(f"{SURVEYED}.includes('got a reply')")
        root = "document.documentElement"
        assert page.get(f"{root}.scrollWidth <= {root}.clientWidth")
        rules = "{ resultTypes: ['violations'] }"
        found = page.get(f"axe.run({rules}).then((found) => found.violations)")
        serious = [each for each in found if each["impact"] in ("serious", "critical")]
        assert [violation(each) for each in serious] == []


def test_wrong_edition_is_named_and_among_possible_ones_the_user_must_choose(
    site: LiveSite, page: Page
) -> None:
    page.choose("edition", "mycobot")
    page.click("#connect")
    page.until(f"{SAID}.startsWith('the arm speaks mycobot280, not mycobot: ')")
    assert page.get("document.querySelector('main').hidden") is True
    site.table = editions.load("mercury_a1").TABLE
    page.choose("edition", "")
    page.click("#connect")
    page.until(f"{SAID}.includes('several editions, mercury_a1, mercury_b1, mercury_x1: ')")
    assert "116 of their 159 commands are the same; these differ: " in page.text("said")
    # Between frames of two formats, the page sends bytes that end an incomplete frame.
    assert b"\xfa\x00\xfe\xfe" in site.sent
    page.choose("edition", "mercury_x1")
    lock = "navigator.locks.request('arm', () => new Promise((done) => (self.free = done)))"
    page.get(f"void {lock}")
    page.click("#connect")
    page.until(f"{SAID}.startsWith('another page of this site uses an arm')")
    page.get("free()")
    page.click("#connect")
    page.until(f"{SAID}.startsWith('Connected: edition mercury_x1, as you chose; ')")
    page.until("document.getElementById('source').textContent.endsWith('edition mercury_x1')")


def test_arm_with_another_baud_rate_is_found(site: LiveSite, page: Page) -> None:
    site.table = editions.load("mycobot280_rdkx5").TABLE
    page.choose("edition", "mycobot280_rdkx5")
    page.click("#connect")
    page.until(f"{SAID}.startsWith('Connected: edition mycobot280_rdkx5')")
    assert site.baudrate == 1_000_000


@pytest.mark.parametrize("edition", editions.names())
def test_decision_tree_leads_to_the_editions_that_identify_finds(
    identification: list[dict[str, Any]], edition: str
) -> None:
    table = editions.load(edition).TABLE

    def arm() -> MemoryTransport:
        clock = SteppedClock()
        return MemoryTransport(SimulatedArm(table, clock=clock), clock)

    # The first tree has the queries of each edition.
    transport, near, node = arm(), identification[0]["near"], identification[0]["tree"]
    while "query" in node:
        if node["fill"]:
            transport.write(bytes.fromhex(node["fill"]))
        with editions.load(node["edition"]).CLIENT(borrowed(transport)) as client:
            command = editions.load(node["edition"]).TABLE.command(node["query"])
            reply = ask(client, command, "", *node["given"].values())
        assert command.safety == "query"
        after = node["silent"]
        for limit, found in node["replied"] if reply.replied else ():
            after = found if not limit or abs(limit - reply.result) <= near else after
        node = after
    assert tuple(node["editions"]) == identify_on(arm()).candidates


def test_survey_sends_only_queries_and_its_file_is_validated(
    site: LiveSite, page: Page, tmp_path: Path
) -> None:
    lacks = {
        "is_moving",
        "get_servo_speeds",
        "get_servo_voltages",
        "get_servo_status",
        "get_servo_temps",
    }
    site.table = without(TABLE, lambda command: command.name in lacks)
    _connect(page)
    _allow(page)
    before = len(site.sent)
    page.click("#run")
    # Three queries in a row got no reply, but another one shows that the arm is still connected.
    page.until(f"{SURVEYED}.startsWith('98 queries were sent, and 93 got a reply')")
    assert page.get("document.getElementById('motion').checked") is False
    events = codec.load(TABLE).framer("request").feed(bytes(site.sent[before:]))
    sent = [event.message.typed for event in events if isinstance(event, Frame)]
    assert len(events) == len(sent)
    assert {TABLE.command(request.command).safety for request in sent} == {"query"}
    file, judged = _kept(page, tmp_path, "survey-mycobot280.pcapng"), tmp_path / "survey.zip"
    whole = tmp_path / "whole.zip"
    assert cobotwire("survey", "--from", file, "--real-arm", "-o", judged).returncode == 1
    assert cobotwire("survey", "--simulated", "-o", whole).returncode == 0
    found, expected = (
        {each["fact"]: each["verdict"] for each in read_survey(path)[0]["facts"]}
        for path in (judged, whole)
    )
    wrong = {fact.split("/")[1] for fact in found if found[fact] == "contradicted"}
    assert wrong == lacks
    # Queries that need the position of the arm are not sent.
    differ = {fact.split("/")[1] for fact in found if found[fact] != expected[fact]}
    positions = {"is_in_position", "angles_to_coords", "solve_inv_kinematics", "get_coords"}
    assert differ <= positions | lacks
    assert list(found.values()).count("confirmed") > 150
    root = str(npm_package.ROOT)
    added = samples.run(Path(root), "evidence", "add", str(judged), "--dry-run", "--root", root)
    assert f"facts confirmed, {len(lacks)} contradicted" in added.stdout


def test_survey_that_ends_early_says_why_and_its_file_contradicts_nothing(
    site: LiveSite, page: Page, tmp_path: Path
) -> None:
    def survey(why: str, end: Callable[[], object] = bool) -> None:
        # After 8 writes the arm is silent, as if its firmware lacked the next commands.
        site.silent_after = 8
        page.click("#run")
        _soon(lambda: (site.silent_after or 0) < 0)
        end()
        page.until(f"/^The survey ended early: .*{why}/.test({SURVEYED})")
        site.silent_after = None

    _connect(page)
    # Stop also ends a survey that still checks whether the arm moves.
    site.silent_after = 0
    page.click("#run")
    page.press("Escape")
    page.until(f"{SURVEYED} === 'you ended the survey'")
    site.silent_after = None

    def stop() -> None:
        assert page.send("is_paused").startswith("end the survey before you send")
        page.press("Escape")

    survey("you ended it", stop)
    _soon(lambda: STOP in site.sent)
    survey("the arm no longer replies")
    file = _kept(page, tmp_path, "survey-mycobot280.pcapng")
    shown = cobotwire("survey", "--from", file, "-o", tmp_path / "survey.zip").stdout
    assert re.search(r"facts: \d\d+ confirmed, 0 contradicted", shown), shown
    survey("lost", site.unplug)


def test_survey_refuses_a_command_that_is_not_a_query(
    site: LiveSite, page: Page, folder: Path
) -> None:
    facts = json.loads((folder / "editions/mycobot280.json").read_text("utf-8"))
    facts["survey"]["questions"].insert(3, ["power_off", {}])
    site.instead["editions/mycobot280.json"] = json.dumps(facts)
    _connect(page)
    page.click("#run")
    page.until(f"{SURVEYED}.startsWith('The survey ended early: power_off is not a query (power)')")
    assert bytes.fromhex("FE FE 02 11 FA") not in site.sent


@pytest.mark.parametrize("edition", editions.names())
def test_questions_of_a_survey_are_queries_of_the_page(folder: Path, edition: str) -> None:
    facts = json.loads((folder / f"editions/{edition}.json").read_text("utf-8"))
    names = {name for name, _ in facts["survey"]["questions"]}
    table = editions.load(edition).TABLE
    assert {table.command(name).safety for name in names} == {"query"}
    assert names <= {form["name"] for form in facts["forms"]}
    assert not names & facts["survey"]["leftOut"].keys()


def test_program_of_the_docs_reads_an_arm_in_a_page(
    site: LiveSite, page: Page, folder: Path
) -> None:
    (folder / "program.html").write_text(PROGRAM, "utf-8")
    (folder / "page.mjs").write_text(npm_package.program("page.mjs"), "utf-8")
    (folder / "port.mjs").write_text(PORT, "utf-8")
    page.tab.open(f"{site.url}program.html")
    page.click("button")
    page.until("document.querySelector('output').value === '0,0,0,0,0,0'")
    assert site.baudrate == 115200
    # The program closes the port.
    _soon(lambda: not site.plugged)


def _kept(page: Page, folder: Path, name: str) -> Path:
    """Save the survey, and return its file."""
    page.tab.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder))
    page.click("#keep")
    _soon((folder / name).is_file)
    return folder / name


def test_site_without_node_says_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(npm_package, "missing", lambda: "needs node: not installed")
    live_page.build(tmp_path / "live", list)
    assert "needs node: not installed" in (tmp_path / "live/index.html").read_text("utf-8")
