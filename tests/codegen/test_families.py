"""Editions with the maker's other frame formats decode frames of real arms."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any

import pytest

from cobotwire import codec as codecs
from cobotwire.codec.interface import Frame
from cobotwire.protocol.table import Table
from cobotwire.simulator import PtyServer, SimulatedArm
from cobotwire_codegen.build import build_edition
from cobotwire_codegen.check import check
from cobotwire_codegen.emit import Target, write
from cobotwire_codegen.model import Edition
from cobotwire_codegen.render import render_python
from cobotwire_codegen.render.vectors_json import plain

HERE = Path(__file__).parent / "families"
CODECS: tuple[codecs.CodecName, ...] = ("reference", "native")

# Frames that pymycobot 4.0.7's MyBuddy writes: limb, method, arguments, frame.
BUDDY = [
    (0, "power_on", (), "FE FE 00 02 10 10"),
    (1, "power_on", (), "FE FE 01 02 10 10"),
    (1, "get_angles", (), "FE FE 01 02 20 20"),
    (2, "send_angle", (3, -12.5, 30), "FE FE 02 06 21 03 FB 1E 1E 5B"),
    (
        1,
        "send_angles",
        ((1, 2, 3, 4, 5, 6), 50),
        "FE FE 01 0F 22 00 64 00 C8 01 2C 01 90 01 F4 02 58 32 8D",
    ),
]


def _edition(name: str) -> Edition:
    edition = build_edition(HERE / f"{name}.yaml", HERE)
    check(edition)
    return edition


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Return a function that generates an edition's package and imports it."""
    folder = tmp_path_factory.mktemp("families")
    sys.path.insert(0, str(folder))

    def make(name: str) -> Any:
        write(Target(folder / f"family_{name}", render_python(_edition(name))))
        importlib.invalidate_caches()
        return importlib.import_module(f"family_{name}")

    yield make
    sys.path.remove(str(folder))


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize("name", ["mercury", "mybuddy"])
def test_frames_of_other_families_are_decoded_and_encoded(
    package: Any, name: str, codec: codecs.CodecName
) -> None:
    edition, table = _edition(name), package(name).TABLE
    used = codecs.load(table, codec)
    real = [vector for vector in edition.vectors if vector.name.startswith("real")]
    assert len(real) == (7 if name == "mercury" else 0), "the frames of the notes on families"
    for vector in edition.vectors:
        assert vector.frame is not None
        found = [plain(edition, vector, field, value) for field, value in vector.values]
        values = tuple(tuple(value) if isinstance(value, list) else value for value in found)
        message = used.decode(vector.direction, vector.frame)
        assert (message.command.name, message.values) == (vector.command, values)
        assert used.encode(vector.command, vector.direction, values) == vector.frame


@pytest.mark.parametrize("codec", CODECS)
@pytest.mark.parametrize(("limb", "name", "values", "frame"), BUDDY)
def test_frame_with_an_address_is_encoded_and_decoded(
    package: Any, codec: codecs.CodecName, limb: int, name: str, values: Any, frame: str
) -> None:
    table: Table = package("mybuddy").TABLE
    used = codecs.load(table, codec)
    assert used.encode(name, "request", values, address=limb) == bytes.fromhex(frame)
    message = used.decode("request", bytes.fromhex(frame))
    assert (message.address, message.command.name, message.values) == (limb, name, values)
    framer = used.framer("request")
    events = framer.feed(b"\xfe" + bytes.fromhex(frame))
    assert [event.offset for event in events if isinstance(event, Frame)] == [1]


@pytest.mark.parametrize("name", ["mercury", "mybuddy"])
def test_clients_of_other_families_talk_to_their_simulated_arms(package: Any, name: str) -> None:
    edition = package(name)
    with PtyServer(SimulatedArm(edition.TABLE)) as server, edition.CLIENT(server.url) as arm:
        assert arm.get_angles() == (0.0,) * 6
        arm.send_angles([1, 2, 3, 4, 5, 6], speed=50)
