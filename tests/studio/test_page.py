"""Drive the page in Chromium on a simulated arm, and compare what it says with a client."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cobotwire.editions import mycobot280
from cobotwire.editions.mycobot280 import MyCobot280
from cobotwire.simulator import ArmConnection, SimulatedArm, TcpServer
from studio.driven_page import Page
from studio.recordings import TARGET as RECORDED
from studio.recordings import record
from studio.studio_server import Studio, running
from targets.decoder.browser import needs_chromium, new_tab
from vectors import ROOT

AXE = ROOT / "target" / "front-end" / "axe.min.js"
TARGET = (40.0, -30.0, -50.0, 10.0, 20.0, -15.0)
ANGLES = (
    "[...document.querySelectorAll('#joints input[type=number]')].map((box) => box.valueAsNumber)"
)
ROWS = "[...document.querySelectorAll('.row:not([hidden])')]"
WIDTHS = [(1280, False), (1280, True), (390, False), (390, True)]
pytestmark = needs_chromium


@pytest.fixture(scope="module")
def page() -> Page:
    return Page(new_tab())


@pytest.fixture(scope="module")
def studio() -> Iterator[Studio]:
    with running("--allow-motion") as server:
        yield server


@pytest.fixture
def opened(page: Page, studio: Studio) -> Page:
    """Return the page on the simulated arm, at the width of a desktop."""
    page.show()
    page.open(studio.url)
    # The page of the previous test may keep control until the server sees it close.
    page.control()
    page.until(f"{ANGLES}.every(Number.isFinite)")
    return page


def test_page_drives_the_arm_and_shows_the_values_that_a_client_reads(opened: Page) -> None:
    url = str(opened.get("document.getElementById('source').title"))
    assert opened.send("power_on") == "sent"
    drawing = "document.getElementById('arm-canvas').toDataURL().length"
    before = opened.get(drawing)
    assert opened.send("send_angles", *TARGET, 80) == "sent"
    opened.until(f"{ANGLES}.every((angle, at) => Math.abs(angle - {json.dumps(TARGET)}[at]) < 0.1)")
    assert opened.get(drawing) != before
    with MyCobot280(url) as arm:
        angles, coords = arm.get_angles(), arm.get_coords()
    opened.until(f"{ANGLES}.join() === '{','.join(map(_plain, angles))}'")
    shown = opened.text("coordinates")
    assert shown == ", ".join(f"{name} {value:.1f}" for name, value in coords._asdict().items())
    assert opened.send("get_angles").split() == [
        word for name, angle in angles._asdict().items() for word in (name, _plain(angle))
    ]
    assert opened.text("near") == ""
    opened.send("send_angles", 0, 0, 148, 0, 0, 0, 100)
    opened.until("document.getElementById('near').textContent === 'Near a limit: j3.'")
    opened.until("document.getElementById('arm-canvas').ariaLabel.includes('Near a limit: j3')")
    assert opened.complaints == []


def _plain(number: float) -> str:
    return f"{number:g}"


def test_frame_is_shown_before_it_is_sent_and_a_wrong_value_is_named(opened: Page) -> None:
    opened.until("document.querySelector('#command option[value=send_angle]')")
    opened.show_tab("send")
    opened.choose("command", "send_angle")
    preview = "document.querySelector('#form .preview').textContent"
    strip = "document.querySelector('#form .strip').innerText.split(/\\s+/).join(' ')"
    opened.until(f"{preview}.includes('send_angle') && {strip}.startsWith('FE FE 06 21 01')")
    opened.get("document.querySelectorAll('#form .boxes input')[0].value = '7'")
    opened.choose("form", "")
    assert "joint is 7" in str(opened.until(f"{preview}.includes('joint is 7') && {preview}"))
    opened.click("#control")
    opened.until("document.querySelector('#form .primary').disabled")
    opened.get(
        "(() => { const box = document.getElementById('find'); box.value = 'gripper';"
        " box.dispatchEvent(new Event('input')); })()"
    )
    names = opened.get("[...document.querySelectorAll('#command option')].map((o) => o.value)")
    assert "get_gripper_value" in names
    assert "send_angles" not in names


def test_stop_needs_no_control_and_escape_stops(opened: Page) -> None:
    opened.show_tab("line")
    opened.choose("by-command", "stop")
    opened.click("#stop")
    opened.until("document.getElementById('status').textContent === 'stop was sent'")
    opened.until("document.getElementById('status').textContent === 'connected'")
    opened.choose("by-direction", "sent")
    opened.until(
        "[...document.querySelectorAll('#by-command option')].some((o) => o.value === 'stop')"
    )
    opened.choose("by-command", "stop")
    opened.until(f"{ROWS}.length === 1")
    opened.press("Escape")
    opened.until(f"{ROWS}.length === 2")


def test_line_is_filtered_searched_paused_and_explained(opened: Page) -> None:
    opened.show_tab("line")
    opened.choose("queries", "each")
    opened.until("document.querySelectorAll('#by-command option').length > 2")
    opened.choose("by-command", "get_coords")
    opened.choose("by-direction", "received")
    opened.until(
        f"{ROWS}.length > 2 && {ROWS}.every((row) => row.children[2].textContent === 'get_coords')"
    )
    # The page shows the second filter in its next frame.
    opened.until(f"{ROWS}.every((row) => row.children[1].textContent === '←')")
    opened.click("#pause")
    opened.until("document.getElementById('line-count').textContent.includes('more received')")
    # What arrived before the pause may be drawn in the next frame.
    opened.get(
        "new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(() => go(1))))"
    )
    count = opened.get("document.getElementById('rows').firstElementChild.style.height")
    opened.click(".row:not([hidden])")
    details = "document.getElementById('details').textContent"
    found = str(opened.until(f"{details}.includes('Specified in') && {details}"))
    for word in ("CMD", "coords.x", "millimetre", "spec/commands/coords.yaml", "footer"):
        assert word in found
    raw = opened.get("document.querySelectorAll('#details tbody tr')[3].children[3].textContent")
    shown = opened.get("document.querySelectorAll('#details tbody tr')[3].children[4].textContent")
    assert float(shown.split()[0]) == int(raw) / 10
    assert opened.get("document.getElementById('rows').firstElementChild.style.height") == count
    opened.click("#pause")
    opened.choose("search", "no such text")
    opened.until(f"{ROWS}.length === 0")
    opened.choose("search", "fe fe 02 23")
    opened.choose("by-direction", "sent")
    opened.until(f"{ROWS}.length > 2")


def test_page_can_be_used_with_only_the_keyboard(opened: Page) -> None:
    opened.show_tab("line")
    opened.choose("queries", "each")
    opened.until(f"{ROWS}.length > 5")
    seen = []
    for _ in range(80):
        opened.press("Tab")
        seen.append(opened.get("document.activeElement.id || document.activeElement.textContent"))
        if seen[-1] == "rows":
            break
    assert {
        "control",
        "stop",
        "arm-canvas",
        "+",
        "home",
        "line-tab",
        "pause",
        "search",
        "rows",
    } <= set(seen)
    opened.press("Home")
    opened.until(
        "document.querySelector('.row.chosen') && document.getElementById('rows').scrollTop === 0"
    )
    active = "document.getElementById('rows').getAttribute('aria-activedescendant')"
    first = opened.until(active)
    opened.press("ArrowDown")
    opened.until(f"{active} === document.querySelector('.row.chosen').id && {active} !== '{first}'")
    opened.until("document.querySelector('#details table')")
    opened.get("document.getElementById('control').focus()")
    opened.press("Enter")
    opened.until("document.getElementById('control').textContent === 'Take control'")
    opened.press("Enter")
    opened.until("document.getElementById('control').textContent === 'Release control'")
    opened.until("document.getElementById('motion').checked")
    opened.get("document.getElementById('motion').focus()")
    opened.press(" ")
    opened.until("!document.getElementById('motion').checked")


def test_page_starts_a_fault_scenario_and_shows_its_faults_and_noise(opened: Page) -> None:
    opened.show_tab("line")
    opened.choose("scenario", "servo-leaks")
    opened.click("#begin")
    opened.until("document.querySelectorAll('#injected li').length > 3")
    assert "fault" in opened.text("injected")
    opened.choose("by-noise", "any")
    opened.until(f"{ROWS}.length && {ROWS}.every((row) => !row.className.includes('frame'))")
    opened.choose("by-noise", "servo")
    opened.until(f"{ROWS}.length && {ROWS}.every((row) => row.className.includes('noise'))")
    opened.click(".row:not([hidden])")
    opened.until("document.getElementById('details').textContent.includes('What to do')")
    opened.choose("scenario", "")
    opened.click("#begin")
    opened.until("!document.getElementById('faults').classList.contains('running')")


@pytest.mark.parametrize(("width", "dark"), WIDTHS)
def test_page_fits_and_axe_finds_nothing_serious(opened: Page, width: int, dark: bool) -> None:
    opened.show(width, 844, dark=dark)
    opened.show_tab("line")
    opened.choose("queries", "each")
    opened.until(f"{ROWS}.length > 5")
    opened.click(".row:not([hidden])")
    opened.until("document.querySelector('#details table')")
    assert opened.get(
        "document.documentElement.scrollWidth <= document.documentElement.clientWidth"
    )
    visible = "document.getElementById('stop').getBoundingClientRect()"
    assert opened.get(f"{visible}.top >= 0 && {visible}.bottom <= innerHeight")
    # Dark mode differs only in its colours.
    rules = ", runOnly: ['color-contrast']" if dark else ""
    opened.get(AXE.read_text())
    found: list[dict[str, Any]] = opened.get(
        f"axe.run({{ resultTypes: ['violations']{rules} }}).then((found) => found.violations)"
    )
    assert [violation(each) for each in found if each["impact"] in ("serious", "critical")] == []
    assert opened.complaints == []


def violation(found: dict[str, Any]) -> tuple[str, list[str]]:
    return found["id"], [
        node["html"][:160] + node["failureSummary"][-160:] for node in found["nodes"]
    ]


def test_token_leaves_the_address_bar_and_survives_a_reload(opened: Page, studio: Studio) -> None:
    assert opened.get("location.href") == f"{studio.origin}/"
    assert studio.token not in opened.get("document.documentElement.outerHTML + document.cookie")
    opened.tab.open(f"{studio.origin}/")
    opened.until("document.documentElement.dataset.ready")
    assert opened.hosts == {f"127.0.0.1:{studio.port}"}


def test_page_without_the_token_says_what_to_do(page: Page, studio: Studio) -> None:
    page.tab.open("about:blank")
    page.tab.open(f"http://localhost:{studio.port}/")
    page.until("document.getElementById('notice').textContent.includes('Open the address')")


HOSTILE = b"</script><img src=x onerror=document.title=1><script>document.title=1</script>\r\n"


class Hostile:
    """An arm that sends markup before each reply."""

    def __init__(self, arm: ArmConnection) -> None:
        self._arm = arm

    @property
    def wait(self) -> float | None:
        return self._arm.wait

    def receive(self, data: bytes) -> bytes:
        return HOSTILE + self._arm.receive(data)

    def flush(self) -> bytes:
        return self._arm.flush()


def test_markup_on_the_line_stays_text(page: Page) -> None:
    arm = SimulatedArm(mycobot280.TABLE)
    page.show()
    with TcpServer(lambda: Hostile(arm.connect())) as server, running(server.url) as studio:
        page.open(studio.url)
        page.show_tab("line")
        page.choose("by-noise", "any")
        # The rows scroll, so one is found and clicked in one step.
        hostile = f"{ROWS}.find((row) => row.textContent.includes('onerror=document.title=1'))"
        page.until(f"((row) => row && (row.click(), true))({hostile})")
        page.until("document.getElementById('details').textContent.includes('onerror')")
        assert page.get("document.querySelectorAll('img, main script').length") == 0
        assert page.get("document.title") == "cobotwire studio"
        assert page.complaints == []


def test_curves_take_the_place_of_an_arm_without_geometry(page: Page) -> None:
    page.show()
    with running(edition="mercury_a1") as studio:
        page.open(studio.url)
        page.until(f"{ANGLES}.length === 7 && {ANGLES}.every(Number.isFinite)")
        assert page.get("document.getElementById('arm').clientHeight") == 0
        assert page.get("document.getElementById('curves').clientHeight") > 500
        assert "the geometry of this arm is not known" in page.text("no-geometry")


def test_recording_is_scrubbed_and_played_in_the_page(page: Page, tmp_path: Path) -> None:
    page.show()
    path = record(tmp_path / "arm.pcapng")
    with running(str(path)) as studio:
        page.open(studio.url)
        hidden = "getComputedStyle(document.getElementById('stop')).display"
        assert page.get(hidden) == "none"
        page.show_tab("line")
        page.choose("queries", "each")
        page.choose("scrub", "1.5")
        page.until("document.getElementById('position').textContent.startsWith('0:01.5')")
        page.until(f"{ANGLES}.every(Number.isFinite) && {ROWS}.length > 5")
        half = page.get(ANGLES)
        page.choose("speed", "10")
        page.click("#play")
        page.until(f"{ANGLES}.every((angle, at) => Math.abs(angle - {list(RECORDED)}[at]) < 0.1)")
        assert half != page.get(ANGLES)
        page.until("document.getElementById('play').textContent === 'Play'")
        page.choose("by-command", "get_angles")
        page.get("document.getElementById('export').requestSubmit()")
        page.until(
            "document.getElementById('export-status').textContent.startsWith('studio.pcapng, ')"
        )
        assert page.complaints == []
