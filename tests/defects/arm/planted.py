"""The planted defects of the arm, by their switches, which ``key_arm.yaml`` explains."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from defects.arm.arm import SIZES, Arm
from defects.arm.numbers import COORDS, framed, signed
from defects.arm.spoilt import REPLIES, REQUESTS, Defect, Right, misread, spoilt, swapped

LATE, A_LITTLE = 0.7, 0.01


def arm_with(clock: Callable[[], float], defect: str = "") -> Arm:
    """Return the arm with a defect; without a name, the correct one.

    Raises:
        KeyError: no defect has the name.
    """
    arm = Arm(clock)
    for method, hook in DEFECTS[defect].items() if defect else ():
        setattr(arm, method, partial(hook, arm, getattr(arm, method)))
    return arm


def _late(arm: Arm, data: bytes, sent: bytes) -> bytes:
    arm.later(LATE, sent)
    return b""


def _halved(arm: Arm, data: bytes, sent: bytes) -> bytes:
    arm.later(LATE, sent[8:])
    return sent[:8]


def _twice(arm: Arm, data: bytes, sent: bytes) -> bytes:
    arm.later(A_LITTLE, sent)
    return sent


def _one_behind(arm: Arm, right: Right, data: bytes) -> bytes:
    if not (sent := right(data)):
        return b""
    held: bytes = arm.memory.get("held", b"")
    arm.memory["held"] = sent
    return held


def _reboots(arm: Arm, right: Right, id: int, data: bytes) -> bytes:
    if id != 0x60:
        return bytes(right(id, data))
    arm.reset()
    return b"ets Jun  8 2016 00:22:57\r\n\r\nrst:0xc (SW_CPU_RESET),boot:0x17\r\n"


def _frame_of_any_id(arm: Arm, right: Right, data: bytes) -> bytes | None:
    if len(data) >= 5 and data[:2] == b"\xfe\xfe" and data[3] not in SIZES:
        return data[: data[2] + 3] if len(data) >= data[2] + 3 else None
    found: bytes | None = right(data)
    return found


def _ignores_footers(arm: Arm, right: Right, data: bytes) -> bytes | None:
    size = SIZES.get(data[3], 99) + 5 if len(data) >= 4 else 99
    whole = len(data) >= size and data[2] == size - 3
    found: bytes | None = data[: size - 1] + b"\xfa" if whole else right(data)
    return found


def _ignores_lengths(arm: Arm, right: Right, data: bytes) -> bytes | None:
    if len(data) >= 4 and data[3] in SIZES:
        data = data[:2] + bytes([SIZES[data[3]] + 2]) + data[3:]
    found: bytes | None = right(data)
    return found


def _one_per_write(arm: Arm, right: Right, data: bytes) -> bytes:
    sent: bytes = right(data)
    size = sent[2] + 3 if len(sent) > 4 and sent[:2] == b"\xfe\xfe" else len(sent)
    return sent[:size]


def _newest_first(arm: Arm, right: Right, data: bytes) -> bytes:
    sent, frames = right(data), []
    while sent[:2] == b"\xfe\xfe" and len(sent) > 4:
        frames.append(sent[: sent[2] + 3])
        sent = sent[sent[2] + 3 :]
    return b"".join(reversed(frames)) + bytes(sent)


def _needs_whole_writes(arm: Arm, right: Right, data: bytes) -> bytes:
    arm.buffer = b""
    return bytes(right(data))


def _acknowledged(wanted: int, body: bytes) -> Defect:
    """Acknowledge a command, which the document does not define."""
    ack = framed(wanted, body)
    return {"reply": lambda _, right, id, data: right(id, data) + (ack if id == wanted else b"")}


def _forgets_after_noise(arm: Arm, right: Right, data: bytes) -> bytes:
    if not arm.buffer and data[:1] != b"\xfe":
        arm.speed = 50
    return bytes(right(data))


def _forgets_the_tool(arm: Arm, right: Right, why: str) -> None:
    if why == "LEN":
        arm.references[0x81] = bytes(12)


def _settings_coupled(arm: Arm, right: Right, id: int, data: bytes) -> None:
    right(id, data)
    if id == 0x85:
        arm.flags[0x89] = 0


def _read_as(wanted: int, read: Callable[[int], int]) -> Defect:
    """Change the first byte of a request before it is checked."""
    return {
        "reply": lambda _, right, id, data: right(
            id, bytes([read(data[0])]) if id == wanted else data
        )
    }


def _answering(wanted: int, answer: Callable[[Arm], int]) -> Defect:
    """Reply to a query with another byte."""
    return {
        "answer": lambda arm, right, id, data: (
            bytes([answer(arm)]) if id == wanted else right(id, data)
        )
    }


def _dies(arm: Arm, right: Right, data: bytes) -> bytes:
    sent: bytes = right(data)
    return b"" if arm.requests > 300 else sent


def _stale_after_motion(arm: Arm, right: Right, id: int, data: bytes) -> bytes:
    if id in (0x21, 0x22, 0x31, 0x33):
        arm.memory["before"] = right(0x20, b"")
    sent: bytes = right(id, data)
    stale = id == 0x20 and "before" in arm.memory and not arm.travel.moves
    return arm.memory.pop("before") if stale else sent


def _only_first_joint_counts(arm: Arm, right: Right, data: bytes) -> bool:
    scale, near, query = (COORDS[0], 5.0, 0x23) if data[12] else (100, 0.2, 0x20)
    here = arm.answer(query, b"")
    assert here is not None, "both are queries"
    return abs(signed(data[:2])[0] - signed(here[:2])[0]) / scale <= near


def _flag_of_pause(arm: Arm, right: Right, id: int, data: bytes) -> None:
    if id in (0x26, 0x28):
        arm.memory["paused"] = int(id == 0x26)
    else:
        right(id, data)


def _resume_discards(arm: Arm, right: Right, id: int, data: bytes) -> None:
    if id == 0x28:
        arm.travel.put(arm.travel.place())
    else:
        right(id, data)


def _limits_not_kept(arm: Arm, right: Right, ticks: list[float], speed: int) -> None:
    limits, arm.limits = arm.limits, {0x4A: [-1800] * 6, 0x4B: [1800] * 6}
    right(ticks, speed)
    arm.limits = limits


def _drags_neighbour(arm: Arm, right: Right, data: bytes) -> None:
    right(data)
    arm.travel.goal[data[0] % 6] += 23


DEFECTS: dict[str, Defect] = {
    **REPLIES,
    **REQUESTS,
    # Time.
    "late-reply": spoilt(0x23, _late),
    "reply-in-two-halves": spoilt(0x3D, _halved),
    "double-reply": spoilt(0x65, _twice),
    "one-reply-behind": {"receive": _one_behind},
    "nul-before-each-reply": {
        "reply": lambda _, right, id, data: b"\0" * bool(sent := right(id, data)) + sent
    },
    # Framing, acknowledgements, values and state.
    "echo": {"receive": lambda _, right, data: data + right(data)},
    "reboots": {"reply": _reboots},
    "replies-to-unknown-ids": {
        "frame": _frame_of_any_id,
        "reply": lambda _, right, id, data: right(id, data) if id in SIZES else framed(id, b"\x01"),
    },
    "ignores-footers": {"frame": _ignores_footers},
    "ignores-len": {"frame": _ignores_lengths},
    "never-gives-up-half-a-request": {"gives_up": lambda *_: None},
    "one-request-per-write": {"receive": _one_per_write},
    "replies-in-reverse": {"receive": _newest_first},
    "needs-whole-writes": {"receive": _needs_whole_writes},
    "acknowledges-set-speed": _acknowledged(0x41, b"\x01"),
    "acknowledges-release": _acknowledged(0x13, b""),
    "forgets-after-noise": {"receive": _forgets_after_noise},
    "forgets-after-wrong-len": {"lose_state": _forgets_the_tool},
    "takes-forbidden-values": _read_as(0x4A, lambda joint: min(max(joint, 1), 6)),
    "stores-forbidden-values": _read_as(0x89, lambda end: min(end, 1)),
    "settings-coupled": {"change": _settings_coupled},
    "any-instead-of-all": _answering(0x51, lambda arm: any(arm.enabled)),
    "tool-in-tenths": {"tool": lambda _, right: [n / 10 for n in right()]},
    "tool-axes-swapped": {"tool": lambda _, right: swapped(0, 1)(right())},
    "dies": {"receive": _dies},
    # Motion, and what is reported about it.
    "stale-angles": {"reply": _stale_after_motion},
    "never-stops": misread(0x29, lambda data: None),
    "never-moving": _answering(0x2B, lambda arm: 0),
    "always-there": {"is_there": lambda *_: True},
    "only-first-joint-counts": {"is_there": _only_first_joint_counts},
    "pause-only-reports": {
        "change": _flag_of_pause,
        **_answering(0x27, lambda arm: arm.memory.get("paused", 0)),
    },
    "resume-discards": {"change": _resume_discards},
    "limits-not-kept": {"go": _limits_not_kept},
    "drags-neighbour": {"send_angle": _drags_neighbour},
}
