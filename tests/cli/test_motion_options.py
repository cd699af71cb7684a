"""Parse the options of subcommands that let other programs move an arm."""

from __future__ import annotations

import click
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cobotwire import Limits, UsageError
from cobotwire.cli.app import app
from cobotwire.cli.shared.motion_options import MotionOptions, motion_options
from in_process import Ended, run

FOUND: list[MotionOptions] = []


@click.command()
@motion_options(silence=0.5)
def subcommand(motion: MotionOptions) -> None:
    FOUND.append(motion)


def _run(*words: str) -> Ended:
    FOUND.clear()
    return run(subcommand, "subcommand", *words)


def test_options_become_limits() -> None:
    assert _run().returncode == 0
    assert [*FOUND] == [(False, Limits(), 0.5)]
    words = ("--allow-motion", "--max-speed", "30", "--workspace", "-200:20.5,,50:400")
    assert _run(*words, "--silence", "2").returncode == 0
    box = [(-200.0, 20.5), None, (50.0, 400.0)]
    assert [*FOUND] == [(True, Limits(speed=30.0, workspace=box), 2.0)]


@pytest.mark.parametrize("seconds", ["0", "nan", "3600"])
def test_silence_that_would_never_end_is_rejected(seconds: str) -> None:
    with pytest.raises(UsageError, match=r"silence is .*; allowed: seconds above 0"):
        _run("--silence", seconds)
    assert FOUND == []


@given(st.text("0123456789:,.-+einfa x", max_size=20) | st.text(max_size=20))
@settings(max_examples=50)
def test_any_text_is_a_workspace_or_a_usage_error(text: str) -> None:
    done = _run("--workspace", text)
    if done.returncode:
        assert "a range in mm for each of x, y and z" in done.stderr
    else:
        workspace = FOUND[0].limits.workspace
        assert workspace is not None
        assert all(pair is None or pair[0] <= pair[1] for pair in workspace)


@pytest.mark.parametrize("name", ["mcp", "ros2"])
def test_motions_of_a_whole_robot_need_a_chosen_address(name: str) -> None:
    pytest.importorskip({"mcp": "mcp", "ros2": "cyclonedds"}[name])
    ended = run(app, "cobotwire", "--edition", "mybuddy", name, "/dev/null", "--allow-motion")
    assert ended.returncode == 2
    assert "all of the robot would move; allowed: LEFT, RIGHT, WAIST, or ALL" in ended.stderr
