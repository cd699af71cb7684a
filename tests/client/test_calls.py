"""Call the simulated arm with the generated client, through pyserial and a pseudo-terminal."""

from __future__ import annotations

import pytest

import vectors
from cobotwire import MyCobot
from cobotwire.editions.mycobot import (
    Angles,
    WifiAccount,
)
from cobotwire.simulator import PtyServer, SimulatedArm


@pytest.mark.parametrize(
    ("limit", "arrived"), [(165.0, True), (10.0, False)], ids=["reached", "not reached"]
)
def test_program_of_the_guide_runs_to_its_end(
    server: PtyServer,
    simulated: SimulatedArm,
    limit: float,
    arrived: bool,
    capsys: pytest.CaptureFixture[str],
) -> None:
    # The arm ignores a target beyond a limit, and never reaches it.
    simulated.state.maximum[2] = limit
    text = (vectors.ROOT / "docs" / "guide" / "drive.md").read_text()
    [example] = [part.split("```")[0] for part in text.split("drive.py -->\n```python\n")[1:]]
    exec(compile(example.replace("/dev/ttyACM0", server.url), "drive.py", "exec"), {})
    printed = capsys.readouterr().out.splitlines()
    assert (printed[-1] == "[0, -20, 30, 0, 10, 0]", len(printed)) == (arrived, 2 + (not arrived))


def test_text_reply_ends_after_a_silence(arm: MyCobot, simulated: SimulatedArm) -> None:
    assert arm.get_ssid_pwd() == WifiAccount("MyCobotWiFi2.4G", "mycobot123")
    simulated.state.kept |= {"ssid": "two words", "password": "pass word "}
    assert arm.get_ssid_pwd() == WifiAccount("two words", "pass word ")
    assert arm.is_power_on() is False, "the next call succeeds"


@pytest.mark.parametrize("codec", ["reference", "native"])
def test_client_uses_the_codec_it_is_given(server: PtyServer, codec: str) -> None:
    with MyCobot(server.url, codec="native" if codec == "native" else "reference") as arm:
        assert arm.codec == codec
        assert arm.get_angles() == Angles(0, 0, 0, 0, 0, 0)
        assert codec in repr(arm)
