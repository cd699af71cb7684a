"""The mutants that may survive, each with the reason."""

from __future__ import annotations

import re

# A pattern of the kind and title, and the reason.
REASONS = (
    (
        r"\S*\.samples .*",
        "which legal values are harmless is this project's own judgement; no source states it",
    ),
    (
        r".*\.focus_all_servos\.request\.0\.type: every_joint -> (acknowledgement|colour)"
        r"|quantity\.range .*every_joint\.range: .*",
        "the only field of the type is a constant, which has the same byte in each of these types",
    ),
    (
        r".*\.type: (joint_errors -> servo_statuses|servo_statuses -> joint_errors)",
        "both are six bytes without a range; only the name of the class differs",
    ),
    (
        r"motion\.(acceleration|near_\w+) .*",
        "only the notes on kinematics state it, and only for the simulated arm",
    ),
    (
        r"gripper\.speed .*|state\.start .*\.(?!ssid|servo_voltages)\w+\.start: .* -> .*"
        r"|state\.start .*\.(speed|password|server_port|gripper_\w+)\.start: left out",
        "no source states it: this project has chosen it, as the edition says",
    ),
    (
        r"state\.type .*\.points\.type: .*",
        "only code reads the points, each with the type of its reply",
    ),
    (
        r"quantity\.wire .*\.(servo_word|target_servo_speed|frequency|torque|current|encoder)"
        r"\.wire: (signed_word -> word|word -> signed_word)",
        "the range holds no negative number and none above 32767, so both have the same bytes",
    ),
    (
        r"request_text\.text .*set_ssid_pwd.*",
        "tests/peers compares the text with the maker's library, which these statements do not run",
    ),
    (
        r"\S*\.silence_ms .*",
        "field notes report pauses of 100 ms; how much longer to wait is this project's own choice",
    ),
)


def accepted(kind: str, title: str) -> str:
    """Return why a mutant may survive; empty if it may not."""
    found = (why for pattern, why in REASONS if re.fullmatch(pattern, f"{kind} {title}"))
    return next(found, "")
