"""The search of the site finds what users ask for, and the sidebar shows few links.

Both run in a browser, on the site as readers get it.
"""

from __future__ import annotations

from pathlib import Path
from urllib.parse import quote

import pytest

from targets.decoder.browser import Tab, needs_chromium, new_tab

pytestmark = needs_chromium

# What users type, and the page or the section that must come first.
QUESTIONS = {
    "open gripper": "reference/mycobot280/gripper.html#set-gripper-state",
    "read joint angles": "reference/mycobot280/motion.html#get-angles",
    "move joint speed": "reference/mycobot280/motion.html#send-angles",
    "set led color 280": "reference/mycobot280/io.html#set-color",
    "joint limits 280": "robots/mycobot280.html#joint-limits-and-speed",
    "pymycobot port": "pymycobot.html",
    "stop the arm": "reference/mycobot280/motion.html#stop",
    "emergency stop": "guide/drive.html#stop-the-arm-no-emergency-stop",
    "free mode drag": "reference/mycobot280/power.html#set-free-mode",
    "connect over wifi tcp": "reference/mycobot280/network.html#set-server-port",
    "timeout no reply": "api/errors.html",
    "pause between points": "motion.html#pause-between-points",
    "asyncio": "guide/drive.html#many-threads-or-asyncio",
    "wireshark": "wireshark.html",
    "decode hex": "decoder.html",
    "record capture": "captures.html",
    "simulate without arm": "simulation.html",
    "mercury a1 power on": "reference/mercury_a1/power.html",
    "pro450 gripper": "reference/pro450/serial.html#set-pro-gripper-offset",
    "noise on the line": "diagnosis.html",
    "which class for my robot": "robots.html",
    "write my own command": "guide/add-command.html",
}
RESULTS = """(async () => {
  const pause = () => new Promise((go) => setTimeout(go, 5));
  while (!document.querySelector(".search-summary")?.innerText) await pause();
  return [...document.querySelectorAll("ul.search a")].map((link) => link.getAttribute("href"));
})()"""
VISIBLE = """[...document.querySelectorAll(".sidebar-tree a")]
  .filter((link) => link.checkVisibility() && link.getClientRects().length).length"""


@pytest.fixture(scope="module")
def tab(site: Path) -> Tab:
    return new_tab()


def found(tab: Tab, site: Path, question: str) -> list[str]:
    """Return the links of the search page, the best first."""
    tab.open(f"{(site / 'search.html').as_uri()}?q={quote(question)}")
    links: list[str] = tab.evaluate(RESULTS)
    return links


@pytest.mark.parametrize("question", QUESTIONS)
def test_first_result_answers_the_users_question(tab: Tab, site: Path, question: str) -> None:
    first, *others = found(tab, site, question)
    assert first == QUESTIONS[question]
    # Catalogues of test cases contain the words of every command.
    catalogues = [link.startswith("reference/test-suite/") for link in others]
    assert catalogues == sorted(catalogues)


def test_command_and_guide_are_the_first_two_results(tab: Tab, site: Path) -> None:
    guide = "guide/drive.html#go-home-open-the-gripper-name-joints"
    assert found(tab, site, "open gripper")[1] == guide


@pytest.mark.parametrize(
    ("page", "most"),
    [
        *[(page, 15) for page in ("index", "guide/drive", "simulation", "framing", "api/client")],
        # These also list all robots, or one robot with the families of its commands.
        *[("robots", 17), ("robots/mycobot280", 16), ("reference/mercury_b1/body", 17)],
    ],
)
def test_sidebar_shows_few_links(tab: Tab, site: Path, page: str, most: int) -> None:
    tab.open((site / f"{page}.html").as_uri())
    assert 5 < tab.evaluate(VISIBLE) <= most
