"""Describe damaged and foreign frames of other formats than the document's."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cobotwire import codec as codecs
from cobotwire.codec.interface import Codec, Frame, Noise
from cobotwire.diagnose import DamagedFrame, Finding
from cobotwire.editions.mycobot import TABLE
from diagnosed_formats import CODECS, NO_ID
from diagnosing import diagnose


@given(st.sampled_from(CODECS), st.integers(1, 6))
def test_truncated_frame_has_the_name_of_its_command(codec: Codec, lost: int) -> None:
    frame = codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)])
    found = diagnose(codec, frame[:-lost])
    assert isinstance(found[0], DamagedFrame)
    if not codec.table.frame.reply_has_id:
        assert (found[0].command, found[0].id, found[0].offset) == (None, None, 0)
        return
    names = [command.name for command in codec.table.commands if command.id == found[0].id]
    assert (found[0].command, found[0].offset) == (" or ".join(names), 0)
    assert "get_angles" in names
    assert not any(isinstance(item, Frame | Noise) for item in found)


@pytest.mark.parametrize("name", ["reference", "native"])
def test_frames_of_formats_without_ids_in_replies_are_described(name: codecs.CodecName) -> None:
    codec = codecs.load(TABLE._replace(frame=NO_ID), name)
    whole = codec.encode("get_angles", "reply", [(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)], address=7)
    sizes = {variant.size for command in TABLE.commands for variant in command.reply}
    unlisted = NO_ID.enclose(0, bytes(min(set(range(1, 20)) - sizes)), 7, "reply")
    request = codec.encode("send_angle", "request", [1, 10.0, 50])
    for stream, described in (
        (whole[:-3], "damaged frame: its end or check is wrong"),
        (whole[:-1] + b"\0", "damaged frame: its end or check is wrong"),
        (unlisted, "damaged frame: its LEN is wrong"),
        (request, "a request, send_angle: an echo, or another host"),
    ):
        found, frame = diagnose(codec, stream + whole)
        assert isinstance(found, Finding)
        assert (found.describe(), found.data) == (described, stream)
        assert isinstance(frame, Frame)
    # A host that listens to requests reads their ids.
    [damaged] = diagnose(codec, request[:-1], listening="request")
    assert isinstance(damaged, DamagedFrame)
    assert damaged.command == "send_angle"
