"""Record and replay an episode with the real LeRobot and simulated arms: `make lerobot`.

LEROBOT names the environment in which LeRobot and the plugin are installed.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pyarrow.parquet
import pytest
from lerobot.robots import Robot
from lerobot.teleoperators import Teleoperator

from cobotwire.editions.mycobot280 import TABLE, MyCobot280
from cobotwire.simulator import RunningClock, SimulatedArm, TcpServer

BIN = Path(os.environ["LEROBOT"]) / "bin"
# The hand moves evenly from the release on, for longer than an episode.
HAND = [(20.0, (80.0, -60.0, 40.0, -20.0, 10.0, 100.0))]
FPS, SECONDS = 30, 3
REQUIRED = """
import lerobot.robots, lerobot.teleoperators
for each in lerobot.robots.Robot, lerobot.teleoperators.Teleoperator:
    print(*sorted(each.__abstractmethods__))
"""


def test_stand_in_requires_what_lerobot_requires() -> None:
    printed = subprocess.check_output([BIN / "python", "-c", REQUIRED], text=True)
    ours = [sorted(each.required.split()) for each in (Robot, Teleoperator)]
    assert [line.split() for line in printed.splitlines()] == ours


def run(program: str, folder: Path, *options: str) -> None:
    """Run a program of LeRobot, which reaches no hub and has no display."""
    given = {name: os.environ[name] for name in ("PATH", "HOME")}
    data = ("--dataset.repo_id=me/led", f"--dataset.root={folder / 'data'}", "--play_sounds=false")
    subprocess.run(
        [BIN / program, *data, *options],
        env={**given, "HF_LEROBOT_HOME": str(folder / "home"), "HF_HUB_OFFLINE": "1"},
        check=True,
    )


def test_episode_led_by_hand_is_recorded_and_replayed(tmp_path: Path) -> None:
    clock = RunningClock()
    follower, leader = (SimulatedArm(TABLE, clock=clock, powered=True) for _ in range(2))
    leader.lead(HAND)
    with (
        TcpServer(follower.connect, clock=clock) as one,
        TcpServer(leader.connect, clock=clock) as other,
    ):
        robot, teleop = (
            [f"--{role}.type=cobotwire", f"--{role}.edition=mycobot280", f"--{role}.port={url}"]
            for role, url in (("robot", one.url), ("teleop", other.url))
        )
        robot.append("--robot.joint_limits=[[-5, 5], null, null, null, null, null]")
        once = ["--dataset.num_episodes=1", f"--dataset.episode_time_s={SECONDS}"]
        local = [f"--dataset.fps={FPS}", "--dataset.single_task=a", "--dataset.push_to_hub=false"]
        released = "--teleop.released=true"
        run("lerobot-record", tmp_path, *robot, *teleop, released, *once, *local)
        [file] = tmp_path.glob("data/data/*/*.parquet")
        rows = pyarrow.parquet.read_table(file).to_pydict()
        last, seen = rows["action"][-1], rows["observation.state"][-1]
        assert len(rows["action"]) == pytest.approx(FPS * SECONDS, abs=FPS / 2)
        assert last[1:] == pytest.approx([v * last[0] / 80 for v in HAND[0][1][1:]], abs=0.5)
        # The follower lags a little behind the hand, and joint 1 stops at its limit.
        assert seen == pytest.approx([5.0, *last[1:]], abs=3.0)
        with MyCobot280(one.url) as arm:
            arm.go_home(speed=100)
            run("lerobot-replay", tmp_path, *robot, "--dataset.episode=0")
            arm.wait_until_reached([5.0, *last[1:]], timeout=5.0)
