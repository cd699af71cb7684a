"""The myArm M750."""

from __future__ import annotations

from robots.classes.myarmc import METHODS, PIN_MODE
from robots.robot import Call, Robot

_ENCODERS = [2000, 1598, 2498, 2000, 2000, 2000, 2000, 2000]
ROBOT = Robot(
    "MyArmM",
    "myarm_m750",
    methods=METHODS
    | {
        "power_on": "set_robot_power_on",
        "power_off": "set_robot_power_off",
        "is_power_on": "get_robot_power_status",
        "send_angle": "set_joint_angle",
        "send_angles": "set_joints_angle",
        "stop": "stop_robot",
        "is_moving": "is_robot_moving",
    },
    lacking=PIN_MODE,
    calls=[
        Call("set_servos_encoder", (_ENCODERS, 50), "set_servos_encoder", (_ENCODERS, 50)),
        Call(
            "set_servos_encoder_drag",
            (_ENCODERS, [500] * 8),
            "set_servos_encoder_drag",
            (_ENCODERS, [500] * 8),
        ),
    ],
)
