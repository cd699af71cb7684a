"""The myBuddy, with two arms and a waist.

The maker's methods take the address of a limb as their first argument.
"""

from __future__ import annotations

from robots.robot import LOCAL, Call, Robot

_PINS = frozenset(
    {"set_gpio_clearup", "set_gpio_init_mode", "set_gpio_output", "set_gpio_pwm_change_dc"}
    | {"set_gpio_pwm_change_freq", "set_gpio_pwm_start", "set_gpio_pwm_stop", "set_gpio_setup"}
    | {"get_gpio_input", "base_io_to_gpio", "set_iic_init", "is_open"}
)
_ZERO, _ANGLES = [0] * 6, [10, -20, 30, -40, 50, -60]
_COORDS = [100, -50.5, 200, 90, -45.25, 10]
_FIRST = "the first argument becomes the address, by a mistake of the maker; no robot has it"
_NONE = "it fails before it sends: the maker's class takes the address from missing arguments"
_FORM = "a variant of is_in_position in the maker's class"
_WHOLE_ROBOT = frozenset(
    {"get_system_version", "focus_all_servos", "base_to_single_coords", "collision"}
    | {"get_base_coords", "jog_inc_coord", "collision_switch", "is_collision_on"}
)

_ROBOT = Robot(
    "MyBuddy",
    "mybuddy",
    methods={
        "set_pin_mode": "set_tool_pin_mode",
        "set_digital_output": "set_tool_digital_output",
        "get_digital_input": "get_tool_digital_input",
        "set_pwm_output": "set_tool_pwm_output",
        "set_color": "set_tool_color",
    },
    local=LOCAL | _PINS,
    before={"ALL": (0,), "LEFT": (1,), "RIGHT": (2,), "WAIST": (3,)},
    without_address=_WHOLE_ROBOT,
    lacking={
        "is_waist_in_position": _FORM,
        "is_robot_in_position": _FORM,
        "single_to_base_coords": "get_base_coords of the maker's class, with arguments",
    },
    not_ours={
        **dict.fromkeys(
            [
                *("set_color", "set_digital_output", "get_digital_input", "set_server_port"),
                *("set_basic_output", "get_basic_input", "set_ssid_pwd"),
            ],
            _FIRST,
        ),
        **dict.fromkeys(("get_tof_distance", "get_basic_version", "get_ssid_pwd"), _NONE),
    },
    calls=[
        Call("is_in_position", (3, [30], 0), "is_waist_in_position", (30, 0), "WAIST"),
        Call("is_in_position", (3, [30.5], 1), "is_waist_in_position", (30.5, 1), "WAIST"),
        *(
            Call(
                "is_in_position",
                (0, [row, row, [12.5]], kind),
                "is_robot_in_position",
                (row, row, 12.5, kind),
                "ALL",
            )
            for row, kind in ((_ANGLES, 0), (_COORDS, 1))
        ),
        Call("get_base_coords", (_COORDS, 0), "single_to_base_coords", (_COORDS, 0), "ALL"),
        Call("get_base_coords", (_COORDS, 1), "single_to_base_coords", (_COORDS, 1), "ALL"),
        Call("sync_send_angles", (1, _ZERO, 50), "send_angles", (_ZERO, 50), "LEFT"),
        Call("sync_send_coords", (2, _ZERO, 50), "send_coords", (_ZERO, 50, 0), "RIGHT"),
    ],
)
ROBOTS = (_ROBOT,)
