"""List where the maker's classes for other robots differ from our editions, and why."""

from __future__ import annotations

from typing import NamedTuple

# Our names, and those of the maker's class, where they differ.
METHODS: dict[str, dict[str, str]] = {
    "MechArm270": {},
    "MyCobot280RDKX5": {
        "check_async_or_sync": "async_or_sync",
        "drag_clear_record_data": "clear_drag_record_data",
        "drag_end_record": "end_drag_record",
        "drag_get_record_data": "get_drag_record_data",
        "drag_get_record_len": "get_drag_record_len",
        "drag_start_record": "start_drag_record",
        "is_controller_connected": "is_tool_connected",
        "set_color": "set_tool_color",
    },
}
# Public names that send nothing to the arm.
_LOCAL = {"check_python_version", "close", "crc_check", "crc_robot_class", "open", "wait"}
LOCAL = {
    "MechArm270": _LOCAL | {"gpio_init", "gpio_output"},
    "MyCobot280RDKX5": _LOCAL | {"parametric_verification"},
}


class Ruling(NamedTuple):
    """What a call of the maker's class shows, as a part of the text, and why ours differs."""

    shows: str
    why: str


_FREE = "a query or a reference is not a motion; the maker applies the limits of motion"
_STEP = "a step may be as long as the distance between the limits; the maker compares it with them"
_COMPOSED = "a call of several requests of ours; it is compared for the 280 alone"
_NEAREST = "the nearest step; the maker truncates"
_PORT = "a port is 1..65535; the maker packs a signed word"
_KIND = "the kind may be left out; the maker's check of a missing kind fails by mistake"

RULINGS: dict[tuple[str, str], Ruling] = {
    ("MechArm270", "go_home"): Ruling("", _COMPOSED),
    ("MechArm270", "is_torque_gripper"): Ruling("", _COMPOSED),
    ("MechArm270", "is_in_position"): Ruling("Has invalid", _FREE),
    ("MechArm270", "send_radians"): Ruling("fe fe 0f 22", _NEAREST),
    ("MechArm270", "set_gripper_state"): Ruling("NoneType", _KIND),
    ("MechArm270", "set_gripper_value"): Ruling("NoneType", _KIND),
    ("MechArm270", "set_server_port"): Ruling("'h' format", _PORT),
    ("MechArm270", "set_ssid_pwd"): Ruling(
        "fe fe 02 b0 fa", "the text follows in the same write; the maker writes it 20 ms later"
    ),
    ("MyCobot280RDKX5", "angles_to_coords"): Ruling("angles not right", _FREE),
    ("MyCobot280RDKX5", "solve_inv_kinematics"): Ruling("not right", _FREE),
    ("MyCobot280RDKX5", "get_gripper_value"): Ruling(
        "fe fe 03 65 01 fa", "the kind may be left out, as on the 280; the maker then sends 1"
    ),
    ("MyCobot280RDKX5", "jog_increment_angle"): Ruling(
        "NoneType", "the maker's check fails by mistake for every call; the bytes are the 280's"
    ),
    ("MyCobot280RDKX5", "jog_increment_coord"): Ruling("coord not right", _STEP),
    ("MyCobot280RDKX5", "send_coords"): Ruling(
        "coord_mode not right", "mode 2 comes from other clients for the 280; the maker rejects it"
    ),
    ("MyCobot280RDKX5", "set_servo_data"): Ruling(
        "address not right", "the maker compares the value, not the address, with 0 to 4"
    ),
}
for _kind in METHODS:
    for _which in ("tool", "world"):
        _shows = "Has invalid coord" if _kind == "MechArm270" else "coords not right"
        RULINGS[_kind, f"set_{_which}_reference"] = Ruling(_shows, _FREE)
    for _what in ("angles", "coords"):
        RULINGS[_kind, f"sync_send_{_what}"] = Ruling("", _COMPOSED)
RULINGS["MyCobot280RDKX5", "is_in_position"] = Ruling(
    "rejected", "the maker sends the function id() by mistake, so that every call fails"
)
