"""The dissector matches replies by address, constant and size, and names events."""

from __future__ import annotations

from pathlib import Path

import pytest

import vectors
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.targets.wireshark import render_wireshark
from targets.built import built
from targets.wireshark.captures import Chunk, serial
from targets.wireshark.dissecting import Item, dissected, needs_tshark

pytestmark = needs_tshark
BUS = vectors.ROOT / "tests" / "protocols"
MS = 1_000_000
# Each line: the edition, then packets with the direction (> or <).
LINES = {
    "addresses": ("feetech", "> FF FF 01 02 01 FB", "< FF FF 03 02 20 DA", "< FF FF 01 02 00 FC"),
    "broadcast": ("feetech", "> FF FF FE 02 01 FE", "< FF FF 01 02 00 FC"),
    "sizes": (
        "feetech",
        *("> FF FF 01 04 02 3E 01 B9", "< FF FF 01 03 00 79 82"),
        *("> FF FF 01 04 02 3F 01 B8", "< FF FF 01 03 00 20 DB"),
    ),
    "constants": ("mycobot320", "> FE FE 05 E9 0E 00 1C FA", "< FE FE 07 E9 0E 00 0E 00 01 FA"),
    "constant": ("mycobot320", "> FE FE 05 E9 0E 00 1C FA", "< FE FE 07 E9 0E 00 1C FF FF FA"),
}


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[Item]]:
    """Return the items of each line, from one run of tshark."""
    folder = tmp_path_factory.mktemp("bus")
    editions = [build_edition(BUS / "feetech.yaml", BUS), vectors.edition("mycobot320")]
    write(Target(folder / "lua", render_wireshark(editions)))
    names = [line[0] for line in LINES.values()]
    chunks = [
        Chunk(
            number, "request" if packet[0] == ">" else "reply", bytes.fromhex(packet[2:]), at * MS
        )
        for number, (_, *packets) in enumerate(LINES.values())
        for at, packet in enumerate(packets)
    ]
    path = folder / "bus.pcapng"
    path.write_bytes(serial(chunks, names))
    scripts = [folder / "lua" / f"{edition.name}.lua" for edition in editions]
    packets = iter(dissected(path, " ".join({*names}), "-2", "-R", "frame", scripts=scripts))
    return {key: [next(packets)[0] for _ in line[1:]] for key, line in LINES.items()}


def test_reply_from_another_address_is_not_matched(shown: dict[str, list[Item]]) -> None:
    ping, other, own = shown["addresses"]
    assert [item.own["frame.address"] for item in (ping, other, own)] == ["1", "3", "1"]
    assert ("request_in" in other.own, "request_in" in own.own) == (False, True)
    assert "response_in" in ping.own
    assert "[NEW]" in own.label


def test_broadcast_awaits_no_reply(shown: dict[str, list[Item]]) -> None:
    ping, status = shown["broadcast"]
    assert (ping.experts, "request_in" in status.own) == ([], False)


def test_reply_without_id_is_decoded_for_its_request(shown: dict[str, list[Item]]) -> None:
    _, volts, _, degrees = shown["sizes"]
    assert volts.own["frame.command"] == "read_voltage"
    assert degrees.own["frame.command"] == "read_temperature"
    assert "frame.id" not in volts.own


def test_reply_with_the_constant_of_another_command_is_not_matched(
    shown: dict[str, list[Item]],
) -> None:
    torque, status = shown["constants"]
    assert torque.experts == ["unanswered"]
    assert (status.own["frame.command"], status.experts) == ("get_pro_gripper_status", [])
    # A reply that no command allows is shown as a faulty reply to the request.
    _, faulty = shown["constant"]
    assert (faulty.own["frame.command"], faulty.experts) == (
        "get_pro_gripper_torque",
        ["bad_value"],
    )
    assert "request_in" in faulty.own


def test_events_and_reported_failures_are_named(tmp_path: Path) -> None:
    edition = vectors.edition("mercury_a1")
    frames = [bytes.fromhex(frame) for frame in ("FE FE 04 5B 00 CD 46", "FE FE 04 5B 06 CF C6")]
    path = tmp_path / "events.pcapng"
    path.write_bytes(serial([Chunk(0, "reply", frame) for frame in frames], edition.name))
    script = built("wireshark") / "mercury_a1.lua"
    [ended], [failed] = dissected(path, edition.name, scripts=[script])
    assert (ended.label[:21], ended.experts) == ("event motion_ended: s", [])
    assert failed.experts == ["failed"]
