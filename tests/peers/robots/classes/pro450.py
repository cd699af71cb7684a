"""The myCobot Pro 450, which the maker's class reaches over TCP."""

from __future__ import annotations

from robots.opening import opened_on_socket
from robots.robot import LOCAL, Arguments, Call, Robot

GRIPPER = 14
# The registers of the gripper that methods write and read.
_REGISTERS = {
    "angle": (11, 12),
    "torque": (27, 28),
    "speed": (32, 33),
    "io_open_angle": (30, 34),
    "io_close_angle": (31, 35),
    "mini_pressure": (25, 26),
}


def _check(data: bytes) -> bytes:
    """Return the Modbus CRC of ``data``, low byte first."""
    rest = 0xFFFF
    for each in data:
        rest ^= each
        for _ in range(8):
            rest = (rest >> 1) ^ (0xA001 if rest & 1 else 0)
    return rest.to_bytes(2, "little")


def _frame(function: int, register: int, value: int = 0) -> Arguments:
    """Return the Modbus frame that reads (3) or writes (6) a register of the gripper."""
    data = bytes([GRIPPER, function]) + register.to_bytes(2, "big") + value.to_bytes(2, "big")
    return ([*data, *_check(data)],)


def _writes(what: str, register: int, value: int, *given: int) -> Call:
    return Call(
        f"set_pro_gripper_{what}", given, "tool_serial_write_data", _frame(6, register, value)
    )


def _reads(what: str, register: int) -> Call:
    return Call(f"get_pro_gripper_{what}", (), "tool_serial_write_data", _frame(3, register))


_CALLS = [
    *(_writes(what, at, 50, 50) for what, (at, _) in _REGISTERS.items()),
    *(_reads(what, at) for what, (_, at) in _REGISTERS.items()),
    _writes("open", 11, 100),
    _writes("close", 11, 0),
    _writes("calibration", 13, 0),
    _writes("abs_angle", 36, 100, 100),
    _writes("enabled", 10, 1, 1),
    _writes("id", 3, 15, 15),
    _writes("modbus", 47, 1, 1),
    _writes("baud", 5, 1, 1),
    _writes("protection_current", 43, 200, 200),
    _reads("protection_current", 44),
    _reads("firmware_version", 1),
    _reads("firmware_modified_version", 2),
    _reads("id", 4),
    _reads("status", 14),
    _reads("baud", 6),
    Call("get_force_sensor_data", (), "tool_serial_write_data", ([1, 4, 0, 0, 0, 12, 240, 15],)),
]
_PLACE = [300, 0, 200, 90, 0, -90]
_ZERO = [0] * 6
_ROBOT = Robot(
    "Pro450Client",
    "pro450",
    local=LOCAL | {"set_limit_switch"},
    lacking={
        "angles_to_coords": "get_coords with angles",
        "is_in_position_coords": "is_in_position with the mode 1",
        "base_external_control": "a method for each bus",
    },
    not_ours={
        "flash_tool_firmware": "it replaces firmware; no source states the whole exchange",
        "set_pro_gripper_init": "it tries several requests, each of which has a command",
    },
    own_arguments={
        "tool_serial_write_data": [([1, 2, 3],), ([255] * 45,)],
        # The maker's method takes the damping before the compensation.
        "set_torque_comp": [(1, 0, 0), (6, 1, 1)],
    },
    calls=[
        *_CALLS,
        Call("set_servos_calibration", (), "set_servo_calibration", (1,)),
        Call("set_torque_comp", (3, 1, 50), "set_torque_comp", (3, 50, 1)),
        Call("go_home", (), "send_angles", (_ZERO, 20)),
        Call("is_in_position", (_PLACE, 1), "is_in_position_coords", (_PLACE,)),
        Call("get_coords", (_ZERO,), "angles_to_coords", (_ZERO,)),
        Call("base_external_485_control", ([1, 2, 255],), "base_external_control", ([1, 2, 255],)),
        Call("base_external_can_control", (258, [3]), "base_external_control", ([0, 0, 1, 2, 3],)),
    ],
    opened=opened_on_socket,
    # Motions return their final status; the robot type is returned as a string of digits.
)
ROBOTS = (_ROBOT,)
