"""Cases of replies: merged, split, late, duplicated, damaged, and lost."""

from __future__ import annotations

from cobotwire.simulator.faults import (
    Dropped,
    Duplicated,
    Inserted,
    Late,
    Lost,
    Replaced,
    Slow,
    Split,
    Stalled,
)
from field_notes.case import (
    ACK,
    ANGLES,
    ANGLES_READ,
    FIRMWARE_PAUSE,
    GET_NOTHING,
    NO_REPLY,
    POWERED,
    Call,
    Case,
    encoder,
    encoder_reply,
)

CONTROLS = Call("get_angles", (), [48.81, 43.71, 33.38, 7.85, 66.6, 0.27])
EDGES = Call("get_angles", (), [168.0, -168.0, 0.01, -0.01, 180.0, -180.0])
DAMAGED = Call("get_angles", (), ANGLES_READ)
ENCODER_SIZE = len(encoder_reply(1))


def angles_reply(*degrees: float) -> bytes:
    """Return a reply to get_angles."""
    raw = b"".join(round(angle * 100).to_bytes(2, "big", signed=True) for angle in degrees)
    return b"\xfe\xfe\x0e\x20" + raw + b"\xfa"


CASES = (
    Case(
        "a late ack glued to the reply",
        ("merged",),
        "FE FE 03 10 01 FA in one piece with the reply",
        (Inserted(data=ACK),),
    ),
    Case(
        "another command's frame before the reply",
        ("other frame",),
        "FE FE 03 12 01 FA",
        (Inserted(data=POWERED),),
    ),
    Case(
        "a pause of 100 ms inside the reply",
        ("pause",),
        "8 bytes, 100 ms, 9 bytes",
        (Split(after_bytes=8, seconds=0.1),),
        requests=None,
    ),
    Case(
        "a pause of 120 ms inside the reply",
        ("pause",),
        "8 bytes, 120 ms, 9 bytes",
        (Split(after_bytes=8, seconds=0.12),),
        requests=None,
    ),
    Case(
        "a pause of 120 ms after FE FE",
        ("pause",),
        "2 bytes, 120 ms, 15 bytes",
        (Split(after_bytes=2, seconds=0.12),),
        requests=None,
    ),
    Case(
        "a reply split after 8 bytes",
        ("split",),
        "8 bytes, 5 ms, 9 bytes",
        (Split(after_bytes=8, seconds=0.005),),
    ),
    Case(
        "a reply split at every byte",
        ("split",),
        "16 calls: the reply in two parts, 5 ms apart, cut one byte further each time",
        tuple(Split(nth=(cut,), after_bytes=cut, seconds=0.005) for cut in range(1, 17)),
        verdicts=("right",) * 16,
        requests=16,
        repeat=16,
        within=2.0,
    ),
    Case(
        "byte by byte",
        ("split",),
        "each byte by itself, 1 ms between them",
        (Slow(bits_per_second=10_000),),
    ),
    Case(
        "a reply 727 ms late",
        ("late", "flushing"),
        "the arm stalls for 727 ms, then replies to all requests; joint 1 is queried, then 2",
        (Late(seconds=FIRMWARE_PAUSE), Stalled(nth=(1,), seconds=0.727)),
        (encoder(1), encoder(2)),
        verdicts=("ReplyTimeout", "right"),
        requests=4,
        within=2.5,
    ),
    Case(
        "replies 250 ms late",
        ("late", "flushing", "again"),
        "two replies take 250 ms; joint 1 is queried, then 2 and 3",
        (Late(seconds=0.25, nth=(1, 2)), Late(seconds=FIRMWARE_PAUSE, first=3)),
        (encoder(1), encoder(2), encoder(3)),
        verdicts=("right",) * 3,
        requests=None,
        within=2.5,
    ),
    Case(
        "a lossy line",
        ("again",),
        "two of three replies are lost; 2 calls",
        (Lost(every=3, first=1), Lost(every=3, first=2)),
        verdicts=("right",) * 2,
        requests=6,
        repeat=2,
        within=2.5,
    ),
    Case(
        "a duplicated reply",
        ("late",),
        "the reply to joint 1 comes twice at once; then 2 is queried",
        (Duplicated(nth=(1,)), Late(seconds=FIRMWARE_PAUSE, first=2)),
        (encoder(1), encoder(2)),
        verdicts=("right", "right"),
        requests=2,
    ),
    Case(
        "a duplicated reply, the copy later",
        ("late",),
        "the reply to joint 1 comes again while joint 2 waits for its own",
        # The copy arrives while the second query waits, even on a busy machine.
        (
            Inserted(data=encoder_reply(1), nth=(2,)),
            Split(after_bytes=ENCODER_SIZE, seconds=FIRMWARE_PAUSE, nth=(2,)),
        ),
        (encoder(1), encoder(2)),
        verdicts=("right", "wrong, silently"),
        requests=2,
    ),
    Case(
        "a dropped byte",
        ("no checksum",),
        "the first reply lacks a byte; the next is whole",
        (Dropped(byte=9, nth=(1,)),),
        requests=2,
    ),
    Case(
        "a corrupted footer",
        ("no checksum",),
        "the first reply ends in FB; the next is whole",
        (Replaced(by=ANGLES[:-1] + b"\xfb", nth=(1,)),),
        requests=2,
    ),
    Case(
        "a corrupted angle",
        ("no checksum",),
        "one bit differs: 83.32 degrees for 1.40",
        (Replaced(by=ANGLES[:4] + b"\x20" + ANGLES[5:]),),
        (DAMAGED,),
        verdicts=("wrong, silently",),
    ),
    Case(
        "XON and XOFF in the data",
        ("xon",),
        "the port is left in its default mode; the reply holds 13 11 0D 0A 03 1A",
        (Replaced(by=angles_reply(*CONTROLS.right)),),
        (CONTROLS,),
        cooked=True,
    ),
    Case(
        "values at the edges",
        ("truncated",),
        "168, -168, 0.01, -0.01, 180 and -180 degrees",
        (Replaced(by=angles_reply(*EDGES.right)),),
        (EDGES,),
    ),
    Case(
        "a query that is never answered",
        ("minus one", "again"),
        "silence",
        (Lost(),),
        (GET_NOTHING,),
        verdicts=("ReplyTimeout",),
        requests=3,
    ),
    Case(
        "one byte where two are expected",
        ("0x53",),
        "the reply to a two-byte read of a servo register (0x53) has one byte",
        (Replaced(by=bytes.fromhex("FE FE 03 53 0A FA")),),
        (Call("get_servo_data", (1, 24, 1), NO_REPLY),),
        verdicts=("wrong, silently",),
    ),
)
