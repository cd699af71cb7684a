"""Cases of replies: merged, split, late, doubled, damaged, and never."""

from __future__ import annotations

from field_notes.case import (
    ACK,
    ANGLES,
    NO_ANSWER,
    PAUSE_OF_FIRMWARE,
    POWERED,
    Call,
    Case,
    Script,
    encoder,
    encoder_reply,
)

CONTROLS = Call("get_angles", (), [48.81, 43.71, 33.38, 7.85, 66.6, 0.27])
EDGES = Call("get_angles", (), [168.0, -168.0, 0.01, -0.01, 180.0, -180.0])
DAMAGED = Call("get_angles", (), [1.4, 0.61, -0.26, -1.93, 1.75, -1.75])
NEVER = Call("get_angles", (), NO_ANSWER)


def angles_reply(*degrees: float) -> bytes:
    """The answer to get_angles."""
    words = b"".join(round(angle * 100).to_bytes(2, "big", signed=True) for angle in degrees)
    return b"\xfe\xfe\x0e\x20" + words + b"\xfa"


def _stalled(request: bytes, number: int) -> Script:
    """The arm stalls once, then answers all that it was asked, in turn."""
    return (0.727 if number == 0 else PAUSE_OF_FIRMWARE, encoder_reply(request[4]))


def _slow(request: bytes, number: int) -> Script:
    return (0.25 if number < 2 else PAUSE_OF_FIRMWARE, encoder_reply(request[4]))


def _twice(request: bytes, number: int) -> Script:
    reply = encoder_reply(request[4])
    return (reply + reply,) if number == 0 else (PAUSE_OF_FIRMWARE, reply)


def _twice_apart(request: bytes, number: int) -> Script:
    """The copy comes in any case while the second question waits, however busy the machine is."""
    reply = encoder_reply(request[4])
    return (reply,) if number == 0 else (encoder_reply(1), PAUSE_OF_FIRMWARE, reply)


def _cut(request: bytes, number: int) -> Script:
    cut = number % (len(ANGLES) - 1) + 1
    return (ANGLES[:cut], 0.005, ANGLES[cut:])


def _every_third(request: bytes, number: int) -> Script:
    return (ANGLES,) if number % 3 == 2 else ()


CASES = (
    Case(
        "a late ack glued in front",
        ("merged",),
        "FE FE 03 10 01 FA in one piece with the reply",
        ((ACK + ANGLES,),),
    ),
    Case(
        "another command's frame in front",
        ("other frame",),
        "FE FE 03 12 01 FA, then the reply",
        ((POWERED + ANGLES,),),
    ),
    Case(
        "a pause of 100 ms inside the reply",
        ("pause",),
        "8 bytes, 100 ms, 9 bytes",
        ((ANGLES[:8], 0.1, ANGLES[8:]),),
        asked=None,
    ),
    Case(
        "a pause of 120 ms inside the reply",
        ("pause",),
        "8 bytes, 120 ms, 9 bytes",
        ((ANGLES[:8], 0.12, ANGLES[8:]),),
        asked=None,
    ),
    Case(
        "a pause of 120 ms behind FE FE",
        ("pause",),
        "2 bytes, 120 ms, 15 bytes",
        ((ANGLES[:2], 0.12, ANGLES[2:]),),
        asked=None,
    ),
    Case(
        "a reply split after 8 bytes",
        ("split",),
        "8 bytes, 5 ms, 9 bytes",
        ((ANGLES[:8], 0.005, ANGLES[8:]),),
    ),
    Case(
        "a reply split at every byte",
        ("split",),
        "16 calls: the reply in two parts, 5 ms apart, cut one byte further each time",
        _cut,
        ours=("right",) * 16,
        asked=16,
        repeat=16,
        within=2.0,
    ),
    Case(
        "byte by byte",
        ("split",),
        "each byte by itself, 1 ms between them",
        (tuple(step for byte in ANGLES for step in (bytes([byte]), 0.001)),),
    ),
    Case(
        "a reply 727 ms late",
        ("late", "flushing"),
        "the arm stalls for 727 ms, then answers all that it was asked; joint 1 is asked, then 2",
        _stalled,
        (encoder(1), encoder(2)),
        ours=("ReplyTimeout", "right"),
        asked=4,
        within=2.5,
    ),
    Case(
        "replies 250 ms late",
        ("late", "flushing", "again"),
        "two replies take 250 ms; joint 1 is asked, then 2 and 3",
        _slow,
        (encoder(1), encoder(2), encoder(3)),
        ours=("right",) * 3,
        asked=None,
        within=2.5,
    ),
    Case(
        "a sick line",
        ("again",),
        "two of three questions go unanswered; 2 calls",
        _every_third,
        ours=("right",) * 2,
        asked=6,
        repeat=2,
        within=2.5,
    ),
    Case(
        "a reply twice",
        ("late",),
        "the reply to joint 1 comes twice at once; then 2 is asked",
        _twice,
        (encoder(1), encoder(2)),
        ours=("right", "right"),
        asked=2,
    ),
    Case(
        "a reply twice, the copy later",
        ("late",),
        "the reply to joint 1 comes again while joint 2 waits for its own",
        _twice_apart,
        (encoder(1), encoder(2)),
        ours=("right", "wrong, silently"),
        asked=2,
    ),
    Case(
        "a byte is dropped",
        ("no checksum",),
        "the first reply lacks a byte; the next is whole",
        ((ANGLES[:9] + ANGLES[10:],), (ANGLES,)),
        asked=2,
    ),
    Case(
        "a corrupted footer",
        ("no checksum",),
        "the first reply ends in FB; the next is whole",
        ((ANGLES[:-1] + b"\xfb",), (ANGLES,)),
        asked=2,
    ),
    Case(
        "a corrupted angle",
        ("no checksum",),
        "one bit differs: 83.32 degrees for 1.40",
        ((ANGLES[:4] + b"\x20" + ANGLES[5:],),),
        (DAMAGED,),
        ours=("wrong, silently",),
    ),
    Case(
        "XON and XOFF in the data",
        ("xon",),
        "the port is left in its default mode; the reply holds 13 11 0D 0A 03 1A",
        ((angles_reply(*CONTROLS.right),),),
        (CONTROLS,),
        cooked=True,
    ),
    Case(
        "values at the edges",
        ("truncated",),
        "168, -168, 0.01, -0.01, 180 and -180 degrees",
        ((angles_reply(*EDGES.right),),),
        (EDGES,),
    ),
    Case(
        "a query that is never answered",
        ("minus one", "again"),
        "silence",
        (),
        (NEVER,),
        ours=("ReplyTimeout",),
        asked=3,
    ),
    Case(
        "one byte where two are asked for",
        ("0x53",),
        "a two-byte read of a servo register (0x53) is answered with one byte",
        ((bytes.fromhex("FE FE 03 53 0A FA"),),),
        (Call("get_servo_data", (1, 24, 1), NO_ANSWER),),
        ours=("wrong, silently",),
    ),
)
