"""The myArm C650, and what its class shares with that of the M750."""

from __future__ import annotations

from robots.robot import Robot

METHODS = {
    "get_system_version": "get_robot_firmware_version",
    "get_angles": "get_joints_angle",
    "get_coords": "get_joints_coord",
    "set_servo_calibration": "set_servo_calibrate",
    "set_color": "set_tool_led_color",
}
PIN_MODE = {"set_pin_mode": "only the maker's pages have it"}
ROBOT = Robot(
    "MyArmC",
    "myarm_c650",
    methods=METHODS,
    lacking=PIN_MODE
    | dict.fromkeys(
        (
            *("power_on", "power_off", "is_power_on", "set_servo_enabled", "clear_robot_err"),
            *("get_joints_min", "get_joints_max"),
        ),
        "only the maker's page has it",
    ),
)
