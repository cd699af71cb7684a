"""The page of each robot: its program runs on the simulated arm, and its arm is drawn."""

from __future__ import annotations

import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from cobotwire.editions import load, names
from cobotwire.simulator import SimulatedArm, TcpServer
from vectors import ON_SITE, ROOT

PORT = "/dev/ttyACM0"


def page(edition: str) -> str:
    return (ROOT / "docs" / "robots" / f"{edition}.md").read_text(encoding="utf-8")


def printed(edition: str) -> list[Any]:
    """Return what the program of a page prints, on the simulated arm."""
    [program] = re.findall(r"^```python\n(.*?)^```$", page(edition), re.DOTALL | re.MULTILINE)
    assert program.count(PORT) == 1
    found: list[Any] = []
    with TcpServer(SimulatedArm(load(edition).TABLE).connect) as server:
        exec(program.replace(PORT, server.url), {"print": found.append})
    return found


def test_first_program_of_each_robot_runs_on_its_simulated_arm(site: Path) -> None:
    # All programs run at the same time: on a Mercury, power_on() takes eight seconds, since its
    # reply may be an echo.
    with ThreadPoolExecutor(len(names())) as pool:
        found = dict(zip(names(), pool.map(printed, names())))
    first = {edition: round(angles.j1) for edition, [angles] in found.items()}
    still = {"myarm_c650"}  # no command moves it
    assert first == {edition: 0 if edition in still else 10 for edition in names()}


@pytest.mark.parametrize("edition", ON_SITE)
def test_picture_shows_every_joint_or_the_page_says_why_there_is_none(
    site: Path, edition: str
) -> None:
    robot = load(edition).TABLE.robot
    html = (site / "robots" / f"{edition}.html").read_text(encoding="utf-8")
    labels = re.findall(r"<circle [^>]*/><text [^>]*>(j\d)</text>", html)
    joints = [f"j{number}" for number, _ in enumerate(robot.joint_limits, 1)]
    assert labels == ([] if robot.geometry is None else joints)
    assert ("There is no picture" in html) == (robot.geometry is None)


def test_page_links_each_command_to_its_section(site: Path) -> None:
    html = (site / "robots" / "mycobot280.html").read_text(encoding="utf-8")
    linked = re.findall(r'href="\.\./reference/mycobot280/\w+\.html#([\w-]+)"', html)
    commands = [command.name for command in load("mycobot280").TABLE.commands]
    assert sorted(linked) == sorted(name.replace("_", "-").lower() for name in commands)


def test_page_says_what_real_arms_showed_and_which_facts_are_disputed(site: Path) -> None:
    text = page("mycobot280")
    assert "| reports from real arms: FE FE 03 65 19 FA |" in text
    assert "The sources disagree about `is_in_position`" in text
    assert "have frames of `set_gripper_enabled`" in page("mercury_a1")
