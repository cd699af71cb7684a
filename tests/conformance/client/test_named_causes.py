"""A failure of a client names its cause: the command, LEN, every wrong value, each occurrence.

All bytes are written by hand, from the document and the command list of current firmware.
"""

from __future__ import annotations

import pytest

from cobotwire.codec.interface import Noise
from cobotwire.conformance.client.broken_frames import described, joined
from cobotwire.conformance.client.history import Received
from cobotwire.conformance.report import Report, Result
from cobotwire.editions.mycobot280 import TABLE
from conformance.client.test_cases import checked, line, spaced

POWER_OFF, RELEASE_ALL = bytes.fromhex("FEFE0211FA"), bytes.fromhex("FEFE0213FA")
# jog_increment: joint 1, 10 degrees, speed 50. set_gripper_value: 60 percent, speed 80.
STEP, GRIP = bytes.fromhex("FEFE06330103E832FA"), bytes.fromhex("FEFE04673C50FA")


def only(report: Report, case: str) -> Result:
    [found] = [result for result in report.failures if result.case == case]
    return found


def test_pause_inside_a_frame_is_reported_as_a_pause() -> None:
    first, rest = Noise(0, STEP[:6], "truncated"), Noise(6, STEP[6:], "no-header")
    [whole] = joined([Received(1.2, first), Received(1.25, rest)])
    assert isinstance(whole.event, Noise)
    text = described(TABLE, whole.event)
    assert "jog_increment_angle is sent in parts with a pause of over 200 ms: FE FE" in text


def test_each_occurrence_is_described_and_all_are_counted() -> None:
    frames = [bytes.fromhex(f"FEFE03200{at}FA") for at in range(9)]
    found = only(checked(spaced(*frames)), "frame-length")
    assert found.reason.endswith("00 FA (9 of 9 failed)")
    assert len(found.further) == 7
    assert "at 2.400 s: LEN is 03" in found.further[0]
    assert found.further[0].endswith("01 FA")


def test_scripted_call_with_a_wrong_len_is_not_called_missing() -> None:
    script = [line("get_angles"), line("is_power_on")]
    report = checked(spaced(bytes.fromhex("FEFE032000FA"), bytes.fromhex("FEFE0212FA")), script)
    assert {result.case for result in report.failures} == {"frame-length", "sent-variant"}
    found = only(report, "sent-variant")
    assert (found.command, found.reason) == (
        "get_angles",
        "line 1: expected FE FE 02 20 FA, got the broken frame FE FE 03 20 00 FA",
    )


def test_scripted_call_with_an_unknown_id_is_found_by_the_rest_of_its_frame() -> None:
    sent = bytes.fromhex("FEFE059A010203FA")
    report = checked(spaced(sent), [line("set_color", 1, 2, 3)])
    assert {result.case for result in report.failures} == {"frame-id", "sent-variant"}
    assert only(report, "sent-variant").command == "set_color"


def test_all_wrong_values_of_a_call_are_named() -> None:
    # 1, 2, 3, 4, 5, 7 degrees at 31 percent, in place of 1, 2, 30, 4, 5, 6 at 30.
    sent = bytes.fromhex("FEFE0F22006400C8012C019001F402BC1FFA")
    report = checked(spaced(sent), [line("send_angles", [1, 2, 30, 4, 5, 6], 30)])
    assert "angles.j3: expected 30 degrees, got 3 degrees" in only(report, "sent-scale").reason
    others = only(report, "sent-value").reason
    assert "angles.j6: expected 6 degrees, got 7 degrees" in others
    assert "speed: expected 30 percent, got 31 percent" in others


@pytest.mark.parametrize(
    ("right", "sent"),
    [
        (line("send_angle", 1, 9.5, 40), "FEFE06210103B629FA"),  # speed 41
        (line("send_angle", 3, 9.5, 40), "FEFE06210403B628FA"),  # joint 4
        (line("set_fresh_mode", 1), "FEFE031600FA"),  # mode 0
    ],
)
def test_wrong_number_without_a_scale_is_not_called_rounding(right: object, sent: str) -> None:
    report = checked(spaced(bytes.fromhex(sent)), [right])  # type: ignore[list-item]
    assert {result.case for result in report.failures} == {"sent-value"}


@pytest.mark.parametrize("frame", ["29", "26", "28", "05"])
@pytest.mark.parametrize("off", [POWER_OFF, RELEASE_ALL])
def test_stop_pause_resume_and_clear_queue_are_legal_without_power(off: bytes, frame: str) -> None:
    assert checked(spaced(off, bytes.fromhex(f"FEFE02{frame}FA"))).conforms


@pytest.mark.parametrize("motion", [STEP, bytes.fromhex("FEFE02D4FA")])
def test_motion_with_released_joints_fails(motion: bytes) -> None:
    assert "released" in only(checked(spaced(RELEASE_ALL, motion)), "motion-powered").reason


def test_gripper_and_joints_that_are_held_again_may_move_after_a_release() -> None:
    assert checked(spaced(RELEASE_ALL, GRIP)).conforms
    focus = bytes.fromhex("FEFE035701FA")
    assert checked(spaced(RELEASE_ALL, focus, STEP)).conforms


@pytest.mark.parametrize("mode", range(3))
def test_send_coords_accepts_each_mode_that_clients_send(mode: int) -> None:
    sent = bytes.fromhex("FEFE102503E8000007D00000000000001E") + bytes([mode, 0xFA])
    assert checked(spaced(sent)).conforms
