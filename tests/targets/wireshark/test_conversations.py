"""The dissector matches replies to requests, in recordings and in generated captures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire import editions
from cobotwire.capture import Recording, read
from cobotwire.codec.interface import Listening
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire.transport.opening import open_transport
from cobotwire.transport.tapped import TappedTransport
from strategies import codec_of
from targets.built import built
from targets.wireshark.captures import Chunk, serial, tcp
from targets.wireshark.dissecting import Item, dissected, needs_tshark, tshark

pytestmark = needs_tshark
TWICE = ("-2", "-R", "frame")
MS = 1_000_000


def line(edition: str, *frames: tuple[int, Listening, str, tuple[object, ...]]) -> list[Chunk]:
    """Return a line's frames from their time (ms), direction, command and values."""
    codec = codec_of(edition, "reference")
    return [
        Chunk(0, direction, codec.encode(name, direction, values), at * MS)
        for at, direction, name, values in frames
        if direction != "both"
    ]


def exchange(item: Item, before: int = 0) -> dict[str, str]:
    """Return what a frame shows of its exchange; its line starts after ``before`` packets."""
    ends = ("request_in", "response_in")
    found = {key: str(int(item.own[key]) - before) for key in ends if key in item.own}
    if "response_time" in item.own:
        found["ms"] = f"{float(item.own['response_time']) * 1000:g}"
    return found | ({"expert": ",".join(item.experts)} if item.experts else {})


def ends(shown: list[list[Item]], key: str) -> list[tuple[int, Item]]:
    """Return the items that name their other end, each with the number of its packet."""
    return [(n, item) for n, items in enumerate(shown, 1) for item in items if key in item.own]


@pytest.mark.parametrize("cut", ["frames", "chunks"])
@pytest.mark.parametrize("edition", ["mycobot", "mycobot280"])
def test_recording_of_the_simulated_arm_is_dissected(
    edition: str, cut: str, tmp_path: Path
) -> None:
    package: Any = editions.load(edition)
    path = tmp_path / "arm.pcapng"
    codec = codecs.load(package.TABLE)
    with PtyServer(SimulatedArm(package.TABLE)) as server:
        with Recording(path, codec if cut == "frames" else None, url=server.url) as recording:
            transport = TappedTransport(open_transport(server.url, 115200), recording.record)
            with package.CLIENT(transport) as arm:
                arm.power_on()
                arm.send_angles([1, 2, 3, 4, 5, 6], speed=50)
                for _ in range(3):
                    arm.get_angles()
                    arm.is_power_on()
                arm.get_ssid_pwd()
    packets = list(read(path))
    # Chunks name no edition; if only one dissector is installed, it is used.
    only = [built("wireshark") / f"{edition}.lua"]
    shown = dissected(path, edition, *TWICE, scripts=only if cut == "chunks" else None)
    items = [item for found in shown for item in found]
    assert [item.kind for item in items if item.kind not in ("frame", "incomplete")] == [
        "no-header"
    ]
    account = {leaf.filter: leaf.value for leaf in items[-1].leaves}
    assert set(account) == {"text.ssid", "text.password"}
    requests, replies = ends(shown, "response_in"), ends(shown, "request_in")
    assert len(requests) == len(replies) >= 7
    for (sent, request), (received, reply) in zip(requests, replies):
        assert (request.own["response_in"], reply.own["request_in"]) == (str(received), str(sent))
        took = packets[received - 1].time_ns - packets[sent - 1].time_ns
        assert reply.own["response_time"] == f"{took / 1e9:.9f}"
    assert not [item.experts for item in items if item.experts]


ASK, ANSWER = ("request", "get_angles", ()), ("reply", "get_angles", ((0,) * 6,))
UNANSWERED = {"expert": "unanswered"}
# Frames with their times in milliseconds, and the exchange that each packet shows.
EXCHANGES: dict[str, tuple[list[Any], list[dict[str, str]]]] = {
    "a query without a reply": (
        [(0, *ASK), (8, *ANSWER), (20, *ASK), (30, "reply", "is_power_on", (True,))],
        [{"response_in": "2"}, {"request_in": "1", "ms": "8"}, UNANSWERED, {}],
    ),
    # Either of the first two requests may have the reply; later pairs are certain.
    "a lost request": (
        [(0, *ASK), (100, *ASK), (108, *ANSWER), (200, *ASK), (208, *ANSWER)],
        [
            *({"response_in": "3"}, UNANSWERED, {"request_in": "1", "ms": "108"}),
            *({"response_in": "5"}, {"request_in": "4", "ms": "8"}),
        ],
    ),
    "simultaneous requests": (
        [(0, *ASK), (1, *ASK), (8, *ANSWER), (9, *ANSWER)],
        [
            *({"response_in": "3"}, {"response_in": "4"}),
            *({"request_in": "1", "ms": "8"}, {"request_in": "2", "ms": "8"}),
        ],
    ),
    "a late reply, and one with other arguments": (
        [
            (0, "request", "get_joint_min_angle", (1,)),
            (1, "request", "get_joint_min_angle", (2,)),
            (9, "reply", "get_joint_min_angle", (2, -100.0)),
            (1500, "reply", "get_joint_min_angle", (1, -90.0)),
        ],
        [UNANSWERED, {"response_in": "3"}, {"request_in": "2", "ms": "8"}, {}],
    ),
}


def test_replies_are_matched_to_their_requests_on_parallel_lines(tmp_path: Path) -> None:
    lines = [line("mycobot", *frames) for frames, _ in EXCHANGES.values()]
    chunks = [each._replace(line=at) for at, found in enumerate(lines) for each in found]
    path = tmp_path / "lines"
    path.write_bytes(serial(chunks, "mycobot"))
    shown = dissected(path, "mycobot", *TWICE)
    before, found = 0, {}
    for case, own in zip(EXCHANGES, lines):
        packets = shown[before : before + len(own)]
        found[case] = [exchange(items[0], before) for items in packets]
        before += len(own)
    assert found == {case: expected for case, (_, expected) in EXCHANGES.items()}


def test_requests_in_one_segment_match_the_replies_in_another(tmp_path: Path) -> None:
    request, reply = line("mycobot", (0, *ASK), (5, *ANSWER))  # type: ignore[arg-type]
    path = tmp_path / "segments"
    path.write_bytes(tcp([each._replace(data=each.data * 2) for each in (request, reply)]))
    two_requests, two_replies = dissected(path, "mycobot280", *TWICE)
    assert [exchange(item) for item in two_requests] == [{"response_in": "2"}] * 2
    assert [exchange(item) for item in two_replies] == [{"request_in": "1", "ms": "5"}] * 2


def test_text_over_tcp_in_pieces_is_joined(tmp_path: Path) -> None:
    codec = codec_of("mycobot280", "reference")
    chunks = [
        Chunk(0, "request", codec.encode("get_ssid_pwd", "request", ()), 0),
        Chunk(0, "reply", b"ssid: my ho", 10 * MS),
        Chunk(0, "reply", b"me net passw", 40 * MS),
        Chunk(0, "reply", b"ord: two words\r\n", 60 * MS),
        Chunk(0, "request", codec.encode("set_ssid_pwd", "request", ()), 2000 * MS),
        Chunk(0, "request", b"'name'(word)", 2020 * MS),
    ]
    path = tmp_path / "text"
    path.write_bytes(tcp(chunks))
    shown = dissected(path, "mycobot280", *TWICE)
    assert shown[0][0].own["response_in"] == "2"
    assert exchange(shown[1][0]) == {"request_in": "1", "ms": "10"}
    texts = [{leaf.filter: leaf.value for leaf in items[0].leaves} for items in shown]
    assert texts == [
        {},
        {},
        {},
        {"text.ssid": "my home net", "text.password": "two words"},
        {},
        {"text.account": "name", "text.password": "word"},
    ]
    assert shown[3][0].experts == []


def test_each_interface_uses_the_edition_that_its_recording_names(tmp_path: Path) -> None:
    path = tmp_path / "line"
    frame = codec_of("mycobot", "reference").encode("get_angles", "request", ())
    for edition in ("mycobot", "mycobot280"):
        path.write_bytes(serial([Chunk(0, "request", frame)], edition))
        assert [len(items) for items in dissected(path, edition)] == [1]
    # If only one dissector is installed, it also reads another edition's interface, and says so.
    only = [built("wireshark") / "mycobot.lua"]
    words = ("-T", "fields", "-e", "_ws.expert.message")
    assert "read as mycobot" in tshark(path, *words, scripts=only)


def test_user_chooses_the_edition_for_tcp(tmp_path: Path) -> None:
    path = tmp_path / "segments"
    frame = codec_of("mycobot", "reference").encode("get_angles", "request", ())
    path.write_bytes(tcp([Chunk(0, "request", frame)]))
    assert len(dissected(path, "mycobot280")[0]) == 1
    assert len(dissected(path, "mycobot", "-d", "tcp.port==9000,mycobot")[0]) == 1
    assert len(dissected(path, "mycobot", "-o", "mycobot280.port:0")[0]) == 1
    assert dissected(path, "mycobot280", "-o", "mycobot280.port:0") == [[]]
    other = path.read_bytes().replace((9000).to_bytes(2, "big"), (9111).to_bytes(2, "big"))
    path.write_bytes(other)
    assert dissected(path, "mycobot280") == [[]]
    (item,) = dissected(path, "mycobot280", "-o", "mycobot280.port:9111")[0]
    assert item.own["frame.direction"] == "request"
