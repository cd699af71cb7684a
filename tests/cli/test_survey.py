"""Run ``cobotwire survey``: the file, the confirmation of motion, the stop key, continuation."""

from __future__ import annotations

import json
import os
import platform
import re
import sys
import zipfile
from io import BytesIO
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec, editions
from cobotwire.capture import Recording, read
from cobotwire.conformance.survey import ASPECTS, read_survey, survey_file
from cobotwire.protocol.errors import UsageError
from cobotwire.session.device import DeviceEvent, RequestReceived
from cobotwire.simulator import PtyServer, SimulatedArm, TcpServer
from in_process import cobotwire
from wrong_arms import POSE, WRONG_ARMS

TABLE = editions.load("mycobot280").TABLE


@pytest.fixture(scope="module")
def surveyed(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """Return the file of a survey of the simulated arm."""
    path = tmp_path_factory.mktemp("surveyed") / "survey.zip"
    assert cobotwire("survey", "--simulated", "-o", path).returncode == 0
    return path.read_bytes()


@pytest.fixture
def path(surveyed: bytes, tmp_path: Path) -> Path:
    """Write the survey of the simulated arm."""
    (tmp_path / "survey.zip").write_bytes(surveyed)
    return tmp_path / "survey.zip"


def test_file_holds_facts_with_frames_and_recording_but_nothing_personal(tmp_path: Path) -> None:
    path = tmp_path / "survey.zip"
    done = cobotwire("survey", "--simulated", "-o", path, "--robot", "280 M5\x1b[2J")
    assert (done.returncode, done.stderr) == (0, f"wrote {path}\n")
    assert "facts: " in done.stdout
    with zipfile.ZipFile(path) as archive:
        assert archive.namelist() == ["survey.json", "recording.pcapng"]
        recording = archive.read("recording.pcapng")
    content, recorded = read_survey(path)
    assert recorded == recording
    assert content["robot"] == "280 M5\\x1b[2J"
    assert content["finished"] is True
    assert {fact["fact"].rpartition("/")[2] for fact in content["facts"]} <= {*ASPECTS}
    (tmp_path / "recording.pcapng").write_bytes(recording)
    sent = {packet.data for packet in read(tmp_path / "recording.pcapng")}
    seen = [fact for fact in content["facts"] if fact["verdict"] == "confirmed"]
    assert all(bytes.fromhex(f["frames"][0]["sent"]) in sent for f in seen if f["frames"])
    text = json.dumps(content) + recording.decode("latin-1")
    secret = TABLE.command("get_ssid_pwd")
    assert secret.id not in {data[3] for data in sent}
    assert content["simulated"] is True
    assert str(tmp_path) not in text
    # A short name can occur in bytes, or inside a word, by chance.
    for name in filter(None, (platform.node(), os.environ.get("USER", ""))):
        assert not re.search(rf"\b{re.escape(name)}\b", json.dumps(content))
        assert len(name) < 6 or name not in text
    again = cobotwire("survey", "--simulated", "-o", path)
    assert (again.returncode, "exists already" in again.stderr) == (2, True)


def test_survey_at_a_network_port_is_of_a_real_arm_only_if_the_owner_states_it(
    tmp_path: Path,
) -> None:
    path, stated = tmp_path / "survey.zip", tmp_path / "stated.zip"
    with TcpServer(SimulatedArm(TABLE).connect) as server:
        done = cobotwire("survey", server.url, "-o", path)
        assert "add --real-arm" in done.stderr
        # --real-arm does not apply to facts that were recorded without it.
        done = cobotwire("survey", server.url, "--real-arm", "--continue", "-o", path)
        assert "not seen; of a simulated arm" in done.stdout
        done = cobotwire("survey", server.url, "--real-arm", "-o", stated)
        assert "--real-arm" not in done.stderr
    assert [read_survey(each)[0]["simulated"] for each in (path, stated)] == [True, False]


def test_motion_is_refused_without_confirmation(tmp_path: Path) -> None:
    done = cobotwire("survey", "--simulated", "--allow-motion", "-o", tmp_path / "survey.zip")
    assert done.returncode == 2
    assert "--yes-workspace-is-clear" in done.stderr
    assert not list(tmp_path.iterdir())


def test_motion_of_all_devices_at_once_is_refused(tmp_path: Path) -> None:
    words = ("--allow-motion", "--yes-workspace-is-clear", "-o", tmp_path / "survey.zip")
    done = cobotwire("--edition", "mybuddy", "survey", "--simulated", *words)
    assert (done.returncode, "LEFT, RIGHT, WAIST" in done.stderr) == (2, True)
    assert not list(tmp_path.iterdir())


def test_survey_continues_an_interrupted_one(path: Path) -> None:
    content, recording = read_survey(path)
    known = "mycobot280/get_angles/command/present"
    cut = [f for f in content["facts"] if f["fact"] == known or "get_angles" not in f["fact"]]
    path.write_bytes(survey_file({**content, "finished": False, "facts": cut}, recording))
    done = cobotwire("survey", "--simulated", "--settings", "--continue", "-o", path)
    assert done.returncode == 0, done.stderr
    after, recorded = read_survey(path)
    assert recorded.startswith(recording)
    # Known values are not requested again, unless a fact compares them with later ones.
    request = b"\xfe\xfe\x02" + bytes([TABLE.command("get_reboot_count").id]) + b"\xfa"
    assert recorded.count(request) == recording.count(request)
    found = {fact["fact"]: fact["verdict"] for fact in after["facts"]}
    assert found[known] == "confirmed"
    assert found["mycobot280/set_fresh_mode/command/effect"] == "confirmed"
    assert after["level"] == 2
    other = cobotwire("--edition", "mycobot", "survey", "--simulated", "--continue", "-o", path)
    assert "is the survey of edition 'mycobot280'" in other.stderr
    other = cobotwire("survey", "--simulated", "--continue", "--address", "2", "-o", path)
    assert "is the survey of another device: continue it without --address" in other.stderr


def test_only_queries_in_the_recording_decide_facts(path: Path, tmp_path: Path) -> None:
    recording = tmp_path / "recording.pcapng"
    whole, traffic = read_survey(path)
    recording.write_bytes(traffic)
    half = tmp_path / "half.pcapng"
    assert cobotwire("capture", "cut", recording, "--to", "0.2", "-o", half).returncode == 0
    found = {}
    for source in (recording, half):
        evaluated = tmp_path / f"{source.stem}.zip"
        done = cobotwire("survey", "--from", source, "-o", evaluated)
        assert done.returncode == 0, done.stdout + done.stderr
        found[source], _ = read_survey(evaluated)
    assert found[recording]["facts"] == whole["facts"]
    assert found[recording]["finished"] is True
    assert found[recording]["simulated"] is True
    assert found[recording]["date"] <= whole["date"]
    decided = {f["fact"]: f["verdict"] for f in found[half]["facts"] if f["verdict"] != "not seen"}
    # Requests that were not recorded get no reply; that contradicts nothing.
    assert {*decided.values()} == {"confirmed"}
    assert 20 < len(decided) < sum(f["verdict"] == "confirmed" for f in whole["facts"])
    assert found[half]["finished"] is False
    done = cobotwire("survey", "--from", recording, "--settings", "-o", tmp_path / "no.zip")
    assert (done.returncode, "--from evaluates a recording" in done.stderr) == (2, True)
    received = tmp_path / "received.pcapng"
    tap = Recording(received, None)
    tap.record("received", b"\0", 0.0)
    tap.close()
    done = cobotwire("survey", "--from", received, "-o", tmp_path / "no.zip")
    assert (done.returncode, "holds no request" in done.stderr) == (2, True)


def test_missing_reply_contradicts_nothing_if_a_late_reply_is_possible(tmp_path: Path) -> None:
    loaded = codec.load(TABLE)
    request = {n: loaded.encode(n, "request", ()) for n in ("is_paused", "get_error_information")}
    angles, paused = (
        loaded.encode("get_angles", "reply", ((0,) * 6,)),
        loaded.encode("is_paused", "reply", (0,)),
    )
    tap = Recording(tmp_path / "late.pcapng", None)
    for at, (sent, received) in enumerate(
        (
            (request["is_paused"], b""),
            (loaded.encode("get_angles", "request", ()), paused + angles),
            (request["get_error_information"], b""),
        )
    ):
        tap.record("sent", sent, at)
        if received:
            tap.record("received", received, at + 0.01)
    tap.close()
    path = tmp_path / "survey.zip"
    done = cobotwire("survey", "--from", tmp_path / "late.pcapng", "-o", path)
    found = {fact["fact"]: fact["verdict"] for fact in read_survey(path)[0]["facts"]}
    assert (done.returncode, {*found.values()}) == (0, {"confirmed", "not seen"})
    assert found["mycobot280/get_angles/command/present"] == "confirmed"


def test_recording_with_times_before_1970_is_refused(tmp_path: Path) -> None:
    tap = Recording(tmp_path / "late.pcapng", None)
    tap.record("sent", b"\0", 0.0)
    tap.close()
    data = bytearray((tmp_path / "late.pcapng").read_bytes())
    packet = data.index(b"\6\0\0\0")
    data[packet + 12 : packet + 16] = b"\xff" * 4
    (tmp_path / "late.pcapng").write_bytes(data)
    done = cobotwire("survey", "--from", tmp_path / "late.pcapng", "-o", tmp_path / "no.zip")
    assert (done.returncode, "has times before 1970" in done.stderr) == (2, True)


def test_continued_survey_keeps_its_exit_code_and_refuses_hostile_values(path: Path) -> None:
    content, recording = read_survey(path)
    content["facts"][0]["verdict"] = "contradicted"
    path.write_bytes(survey_file(content, recording))
    assert cobotwire("survey", "--simulated", "--continue", "-o", path).returncode == 1
    for hostile in ({"hashed": 5}, {"hashed": ["\x1b[31m"]}, {"level": "x"}, {"left_out": 5}):
        path.write_bytes(survey_file({**content, **hostile}, recording))
        done = cobotwire("survey", "--simulated", "--continue", "-o", path)
        assert (done.returncode, f"{next(iter(hostile))} is not" in done.stderr) == (2, True), (
            done.stderr
        )


def test_survey_continued_without_its_options_is_not_finished(path: Path) -> None:
    content, recording = read_survey(path)
    both, one = ["--settings", "--allow-motion"], ["--allow-motion"]
    path.write_bytes(survey_file({**content, "finished": False, "left_out": both}, recording))
    for words, left, level in (([], both, 1), (["--settings"], one, 2)):
        done = cobotwire("survey", "--simulated", "--continue", *words, "-o", path)
        assert f"still to run: --continue {' '.join(left)}" in " ".join(done.stdout.split())
        content, _ = read_survey(path)
        found = content["finished"], content["left_out"], content["level"]
        assert found == (False, left, level)


def test_survey_and_doctor_send_to_the_given_address(tmp_path: Path) -> None:
    path, table = tmp_path / "survey.zip", editions.load("mybuddy").TABLE
    traffic = [tmp_path / "survey.pcapng", tmp_path / "doctor.pcapng"]
    words = ("--edition", "mybuddy"), ("--address", "right")
    cobotwire(*words[0], "survey", "--simulated", *words[1], "-o", path)
    traffic[0].write_bytes(read_survey(path)[1])
    with PtyServer(SimulatedArm(table, powered=True)) as server:
        cobotwire(*words[0], "doctor", server.url, *words[1], "--record", traffic[1])
    at = table.frame.address_at
    assert at is not None
    for recorded in map(read, traffic):
        assert {each.data[at] for each in recorded if each.direction == "sent"} == {2}


def _archive(head: bytes, data: bytes) -> bytes:
    file = BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("survey.json", head + data)
        archive.writestr("recording.pcapng", data)
    return file.getvalue()


HEAD = b'{"format": "cobotwire-survey", "version": 1, "facts": ['


@given(st.binary(max_size=200), st.sampled_from([None, b"", HEAD]))
def test_file_that_is_no_survey_is_rejected_with_a_message(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, head: bytes | None
) -> None:
    path = tmp_path_factory.getbasetemp() / "hostile.zip"
    path.write_bytes(data if head is None else _archive(head, data))
    with pytest.raises(UsageError, match="is not the file of a survey"):
        read_survey(path)


@pytest.mark.skipif(sys.platform == "win32", reason="the terminal is a pseudo-terminal")
def test_any_key_stops_the_motion_and_the_file_holds_what_was_found(tmp_path: Path) -> None:
    from terminal import Terminal

    path, stopped = tmp_path / "survey.zip", []

    def note(event: DeviceEvent, reply: bytes) -> None:
        if isinstance(event, RequestReceived) and event.message.command.role == "stop":
            stopped.append(event)

    words = ("--edition", "mycobot280", "--allow-motion", "-o", str(path))
    with (
        PtyServer(SimulatedArm(TABLE, on_event=note)) as server,
        Terminal("survey", server.url, *words, columns=80, lines=24) as terminal,
    ):
        terminal.until(lambda: "supported?[y/N]" in terminal.text())
        assert "thenitsinks" in terminal.text()
        terminal.press(b"y\n")
        terminal.until(lambda: "firstmotions" in terminal.text())
        terminal.press(b"x")
        assert terminal.finish() == 130
        assert "interrupted:thearmwasstopped" in terminal.text()
    assert stopped
    content, _ = read_survey(path)
    assert (content["finished"], content["level"]) == (False, 3)
    assert content["left_out"] == ["--allow-motion"]
    assert any(fact["verdict"] == "confirmed" for fact in content["facts"])


@pytest.mark.parametrize("name", ["doctor", "identify"])
def test_angles_in_tenths_of_degrees_are_detected_from_the_coordinates(name: str) -> None:
    table = editions.load("mycobot320").TABLE
    [change] = [arm.change for arm in WRONG_ARMS if arm.name == "tenths" and arm.change]
    shown = []
    for spoken in (table, change(table)):
        robot = spoken.robot._replace(start_angles=POSE)
        with PtyServer(SimulatedArm(spoken._replace(robot=robot), powered=True)) as server:
            shown.append(cobotwire("--edition", "mycobot320", name, server.url))
    assert [("tenths" in done.stdout, done.returncode) for done in shown] == [(False, 0), (True, 1)]
