"""Move a simulated arm with the mouse, the keyboard and a finger; the page must stop it again."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from cobotwire.editions import mycobot280
from cobotwire.kinematics import flange, geometry_of
from cobotwire.simulator import SimulatedArm, TcpServer
from studio.driven_page import Page
from studio.studio_server import Studio, running
from studio.test_page import ANGLES, ROWS
from targets.decoder.browser import needs_chromium, new_tab

pytestmark = needs_chromium

STATUS = "document.getElementById('move-status').textContent"
JOG = "#joints li:nth-child({}) .jog:nth-of-type({})"
SLIDER = "#joints li:nth-child({}) input[type=range]"


@pytest.fixture(scope="module")
def page() -> Page:
    return Page(new_tab())


@pytest.fixture(scope="module")
def studio() -> Iterator[Studio]:
    with running("--rate", "30") as server:
        yield server


@pytest.fixture
def opened(page: Page, studio: Studio) -> Page:
    """Return the page, with the arm at rest with all joints at zero."""
    page.show(1440, 900)
    page.open(studio.url)
    page.control()
    page.until(f"{ANGLES}.every(Number.isFinite)")
    page.choose("speed-of-motion", "100")
    page.click("#home")
    _at_rest(page, [0.0] * 6)
    page.click("#clear")
    return page


def _at_rest(page: Page, angles: list[float]) -> None:
    near = f"{ANGLES}.every((angle, at) => Math.abs(angle - {json.dumps(angles)}[at]) < 0.2)"
    page.until(near)


def _sent(page: Page, command: str) -> int:
    """Return how often a command was sent, according to the list on the page."""
    page.choose("queries", "hide")
    page.choose("by-direction", "sent")
    found = 'document.querySelector("#by-command option[value={}]")'
    if not page.get(f"Boolean({found.format(command)})"):
        return 0
    page.choose("by-command", command)
    # The count is written with the next frame.
    _wait(page, 200)
    count = page.get("parseInt(document.getElementById('line-count').textContent)")
    return int(count)


def _drag(page: Page, selector: str, by: float, *, drop: bool = True) -> tuple[float, float]:
    """Drag the thumb of a slider in its middle; return where the mouse is."""
    x, y = page.middle(selector)
    page.mouse("mousePressed", x, y)
    for step in range(1, 6):
        page.mouse("mouseMoved", x + by * step / 5, y)
    if drop:
        page.mouse("mouseReleased", x + by, y)
    return x + by, y


def _wait(page: Page, milliseconds: int) -> None:
    page.get(f"new Promise((go) => setTimeout(go, {milliseconds}))")


def test_slider_shows_a_ghost_and_sends_its_target_when_it_is_released(opened: Page) -> None:
    drawing = "document.getElementById('arm-canvas').toDataURL()"
    before = opened.get(drawing)
    x, y = _drag(opened, SLIDER.format(2), 30, drop=False)
    opened.until(f"{drawing} !== '{before}'")  # the ghost is drawn
    target = float(opened.get(f"document.querySelector('{SLIDER.format(2)}').valueAsNumber"))
    assert target > 10
    assert abs(opened.get("document.querySelectorAll('#joints .mark')[1].offsetLeft") - 0) > 0
    opened.show_tab("line")
    assert _sent(opened, "send_angle") == 0, "nothing is sent before"
    opened.mouse("mouseReleased", x, y)
    opened.until(f"{STATUS} === 'sent'")
    _at_rest(opened, [0, target, 0, 0, 0, 0])
    assert opened.complaints == []


def test_escape_during_a_drag_stops_and_sends_no_target(opened: Page) -> None:
    x, y = _drag(opened, SLIDER.format(1), 40, drop=False)
    opened.press("Escape")
    opened.mouse("mouseReleased", x, y)
    _wait(opened, 400)
    _at_rest(opened, [0] * 6)
    opened.show_tab("line")
    assert _sent(opened, "send_angle") == 0


def test_arm_follows_a_drag_if_the_box_follow_is_checked(opened: Page) -> None:
    opened.click("#follow")
    x, y = _drag(opened, SLIDER.format(1), 40, drop=False)
    opened.until(f"{ANGLES}[0] > 20")
    for step in range(20):
        opened.mouse("mouseMoved", x - step, y)
    opened.mouse("mouseReleased", x - 20, y)
    target = float(opened.get(f"document.querySelector('{SLIDER.format(1)}').valueAsNumber"))
    _at_rest(opened, [target, 0, 0, 0, 0, 0])
    opened.click("#follow")
    opened.show_tab("line")
    assert _sent(opened, "send_angle") < 12, "at most five a second"


@pytest.mark.parametrize("by", ["mouse", "touch", "arrow key", "Enter"])
def test_jog_moves_while_it_is_held_and_release_stops(opened: Page, by: str) -> None:
    # The speed is so low that the joint stays far from its limit even on a busy machine.
    opened.choose("speed-of-motion", "10")
    x, y = opened.middle(JOG.format(3, 2))
    hands: dict[str, tuple[Callable[[], None], Callable[[], None]]] = {
        "mouse": (
            lambda: opened.mouse("mousePressed", x, y),
            lambda: opened.mouse("mouseReleased", x, y),
        ),
        "touch": (lambda: opened.touch("touchStart", (x, y)), lambda: opened.touch("touchEnd")),
        "arrow key": (
            lambda: opened.key("keyDown", "ArrowRight"),
            lambda: opened.key("keyUp", "ArrowRight"),
        ),
        "Enter": (lambda: opened.key("keyDown", "Enter"), lambda: opened.key("keyUp", "Enter")),
    }
    begin, end = hands[by]
    focus = JOG.format(3, 2) if by == "Enter" else SLIDER.format(3)
    opened.get(f"document.querySelector('{focus}').focus()")
    begin()
    opened.until(f"{ANGLES}[2] > 5")
    # Longer than the server waits for a silent page.
    _wait(opened, 800)
    held = opened.get(f"{ANGLES}[2]")
    opened.until(f"{ANGLES}[2] > {held}")  # it keeps moving while the button is held
    end()
    _wait(opened, 300)
    stopped = opened.get(f"{ANGLES}[2]")
    _wait(opened, 400)
    assert abs(opened.get(f"{ANGLES}[2]") - stopped) < 0.5
    assert stopped < 140


@pytest.mark.parametrize("how", ["the page is stuck", "the page is closed", "space"])
def test_jog_ends_when_the_page_no_longer_holds_it(opened: Page, studio: Studio, how: str) -> None:
    opened.choose("speed-of-motion", "20")
    opened.get(f"document.querySelector('{SLIDER.format(1)}').focus()")
    opened.key("keyDown", "ArrowLeft")
    opened.until(f"{ANGLES}[0] < -3")
    if how == "space":
        opened.press(" ")
    elif how == "the page is closed":
        opened.tab.open("about:blank")
    else:
        opened.get("(() => { const end = Date.now() + 1500; while (Date.now() < end); })()")
    time.sleep(0.7)
    if how == "the page is closed":
        opened.open(studio.url)
        opened.until(f"{ANGLES}.every(Number.isFinite)")
    else:
        opened.key("keyUp", "ArrowLeft")
    stopped = opened.get(f"{ANGLES}[0]")
    _wait(opened, 600)
    assert abs(opened.get(f"{ANGLES}[0]") - stopped) < 0.5
    assert -165 < stopped < -3


@pytest.mark.parametrize("dropped", [True, False], ids=["dropped", "still under way"])
def test_motion_that_leaves_the_browser_after_stop_is_not_sent(
    opened: Page, *, dropped: bool
) -> None:
    # The browser holds a request back while all its connections to the server are in use.
    options = "options" if dropped else "{ ...options, signal: undefined }"
    opened.get(
        "(() => { const real = window.fetch; const waits = new Promise((go) => window.go = go);"
        " window.fetch = async (path, options) => { if (path === '/api/send') await waits;"
        f" return real(path, {options}); }}; }})()"
    )
    _drag(opened, SLIDER.format(1), 40)
    opened.until(f"{STATUS} === 'sending'")
    opened.press("Escape")
    opened.until("document.getElementById('status').textContent === 'stop was sent'")
    opened.get("window.go()")
    reason = "before this command was confirmed" if dropped else "the arm was stopped meanwhile"
    opened.until(f"{STATUS}.includes('{reason}')")
    opened.show_tab("line")
    assert _sent(opened, "send_angle") == 0
    # The page knows the new number of stops, also after a motion that was held.
    for _ in range(2):
        opened.get(f"document.querySelector('{SLIDER.format(3)}').focus()")
        opened.key("keyDown", "ArrowRight")
        before = opened.get(f"{ANGLES}[2]")
        opened.until(f"{ANGLES}[2] > {before} + 1")
        opened.key("keyUp", "ArrowRight")
    opened.click("#home")
    _at_rest(opened, [0.0] * 6)


def test_coordinates_gripper_light_and_home_are_sent(opened: Page) -> None:
    opened.send("send_angles", 0, -30, -60, 20, 10, 0, 100)
    _at_rest(opened, [0, -30, -60, 20, 10, 0])
    opened.show_tab("axes-panel")
    boxes = "document.querySelectorAll('#axes input[type=number]')"
    z = opened.get(f"{boxes}[2].valueAsNumber")
    opened.get(f"{boxes}[2].focus()")
    opened.get(f"{boxes}[2].value = '{z - 30:.1f}'")
    opened.press("Enter")
    opened.until(
        f"document.activeElement.blur() || Math.abs({boxes}[2].valueAsNumber - {z - 30:.1f}) < 1.5"
    )
    opened.click("#close")
    opened.until(f"{STATUS} === 'sent'")
    opened.get(
        "(() => { const box = document.getElementById('light'); box.value = '#ff8000';"
        " box.dispatchEvent(new Event('change')); })()"
    )
    opened.until(f"{STATUS} === 'sent'")
    opened.show_tab("send")
    assert opened.send("get_gripper_value") == "0"
    opened.show_tab("joints-panel")
    opened.click("#home")
    _at_rest(opened, [0] * 6)


def test_target_disappears_when_the_arm_is_stopped(opened: Page) -> None:
    opened.choose("speed-of-motion", "5")
    _drag(opened, SLIDER.format(1), 40)
    opened.until(f"{STATUS} === 'sent' && {ANGLES}[0] > 1 && {ANGLES}[0] < 50")
    slider = f"document.querySelector('{SLIDER.format(1)}').valueAsNumber"
    assert opened.get(f"{slider} - {ANGLES}[0]") > 10
    opened.get("document.body.focus()")
    opened.press("Escape")
    opened.until(f"Math.abs({slider} - {ANGLES}[0]) < 0.5")


def test_queries_are_grouped_until_something_else_happens(opened: Page) -> None:
    opened.show_tab("line")
    label = f"{ROWS}.map((row) => row.children[2].textContent)"
    polls = f"{label}.filter((text) => text.startsWith('get_angles'))"
    opened.until(f"{polls}.length === 1 && / \\d\\d+$/.test({polls}[0])")
    opened.click("#close")
    opened.until(f"{label}.includes('set_gripper_value') && {polls}.length >= 2")
    opened.choose("queries", "hide")
    opened.until(f"{label}.every((text) => text === 'set_gripper_value') && {ROWS}.length > 0")


@pytest.mark.parametrize(("width", "height"), [(1440, 900), (1280, 800)])
def test_all_parts_of_the_page_are_on_one_screen(opened: Page, width: int, height: int) -> None:
    opened.show(width, height)
    for panel in ("curves", "line", "send", "faults"):
        opened.show_tab(panel)
        for id in ("arm-canvas", "stop", "home", "follow", panel):
            box = f"document.getElementById('{id}').getBoundingClientRect()"
            assert opened.get(
                f"{box}.top >= 0 && {box}.bottom <= innerHeight && {box}.height > 10"
            ), id
    assert opened.get("document.getElementById('arm-canvas').clientHeight") > 250
    assert opened.get("document.documentElement.scrollHeight === innerHeight")


def test_arm_and_stop_stay_in_sight_on_a_phone(opened: Page) -> None:
    opened.show(390, 844)
    opened.get("scrollTo(0, document.documentElement.scrollHeight)")
    for id in ("arm-canvas", "stop"):
        box = f"document.getElementById('{id}').getBoundingClientRect()"
        assert opened.get(f"{box}.top >= 0 && {box}.bottom <= innerHeight && {box}.height > 40"), id


def test_page_says_why_a_real_arm_is_not_moved(page: Page) -> None:
    page.show(1440, 900)
    arm = SimulatedArm(mycobot280.TABLE)
    with TcpServer(arm.connect) as server, running(server.url) as studio:
        page.open(studio.url)
        why = "document.getElementById('move-why').textContent"
        page.until(f"{why}.includes('only watches')")
        page.click("#control")
        page.until(f"{why}.includes('--allow-motion')")
        assert page.get("document.querySelector('#joints .jog').matches(':disabled')")
    with TcpServer(arm.connect) as server, running(server.url, "--allow-motion") as studio:
        page.open(studio.url)
        page.click("#control")
        page.until(f"{why}.includes('Switch on')")
        page.click("#motion")
        page.until("document.getElementById('move-why').hidden")
        # The arm has no power yet: a target is refused, and the page says why.
        _drag(page, SLIDER.format(1), 40)
        page.until(f"{STATUS}.includes('no power')")
        page.click("#power")
        page.until(f"{STATUS} === 'sent'")
        _drag(page, SLIDER.format(1), 40)
        page.until(f"{ANGLES}[0] > 5")


def test_drawing_agrees_with_the_kinematics_of_the_server(opened: Page) -> None:
    geometry = geometry_of(mycobot280.TABLE)
    assert geometry is not None
    links: Any = [
        [link.offset, link.alpha, link.a, link.d, link.turned_by] for link in geometry.links
    ]
    for angles in ([0.0] * 6, [10.0, -20.0, 30.0, -40.0, 50.0, -60.0]):
        found = opened.get(
            f"import('./kinematics.js').then((m) => m.points({json.dumps(links)}, {angles}))"
        )
        end = flange(geometry, angles).coords[:3]
        assert found[-1] == pytest.approx(end)
        # Each link goes along one axis, then across it.
        assert len(found) == 1 + sum(1 + bool(link.a and link.d) for link in geometry.links)


def test_six_sliders_move_at_sixty_frames_a_second(opened: Page) -> None:
    # In processor time, because other programs of a busy machine delay frames too.
    opened.tab.call("Performance.enable", timeDomain="threadTicks")
    opened.send("send_angles", 90, 60, -90, 60, 90, 90, 20)
    sliders = "[...document.querySelectorAll('#joints input[type=range]')]"
    before = _busy(opened)
    frames = opened.get(
        "new Promise((done) => { const begin = performance.now(); let count = 0;"
        " const step = (at) => { count += 1;"
        f" {sliders}.forEach((slider, index) => {{ slider.value = 40 * Math.sin(at / 300 + index);"
        " slider.dispatchEvent(new Event('input')); });"
        " if (at - begin < 1000) requestAnimationFrame(step); else done(count); };"
        " requestAnimationFrame(step); })"
    )
    each = 1000 * (_busy(opened) - before) / frames
    print(f"{frames} frames a second; {each:.1f} ms of work in each")
    # What the page does for a frame must fit into a sixtieth of a second.
    assert each < 1000 / 60


def _busy(page: Page) -> float:
    """Return how many seconds the page has worked."""
    metrics = page.tab.call("Performance.getMetrics")["metrics"]
    return float(next(each["value"] for each in metrics if each["name"] == "TaskDuration"))
