"""Why calls of the layer differ from the same calls of the maker's library.

Both differ in which values they allow; ``make robots`` compares and rules that for our clients.
"""

from __future__ import annotations

# Classes that a ruling of another class concerns, too: they reach the same robot by TCP.
BY_TCP = {"Mercury (B1, X1)": "MercurySocket", "Pro400": "Pro400Client", "Pro630": "Pro630Client"}


def _also_by_tcp(rulings: dict[tuple[str, str], str]) -> dict[tuple[str, str], str]:
    others = {(BY_TCP[name], m): why for (name, m), why in rulings.items() if name in BY_TCP}
    return {**others, **rulings}


_NEAREST = "the nearest step; the library truncates"
_ASKS_ONCE = "the arm is asked whether it moves, and less often where it is"
_NO_ACK = "the edition has no acknowledgement of it, so the library waits in vain and returns -1"
_ROWS = "for the whole robot, the library sends 14 positions and 14 speeds for 13 joints"
_TENTHS = "the library returns tenths here, against its own description and its other classes"
_HUNDREDTHS = "the library returns hundredths of degrees here, and its other classes degrees"
_DROPPED = "the library reads the reply and drops it"
_ENDLESS = "the library waits for ever: it wants six bytes, and the reply has seven"
_NOT_READ = "the library does not read the reply"

# By method, where the frames may differ.
FRAMES = {
    "is_in_position": _NEAREST,
    "send_angles": _NEAREST,
    "send_radians": _NEAREST,
    "sync_send_angles": _ASKS_ONCE,
    "sync_send_coords": _ASKS_ONCE,
}
# By class and method, where the frames may differ.
OTHER_FRAMES = {
    ("MyBuddy", "set_encoders"): _ROWS,
    ("MyBuddySocket", "set_encoders"): _ROWS,
    **_also_by_tcp(
        {
            ("Pro400", "set_servos_calibration"): "six joints; the library sends seven requests",
            ("Pro630", "set_servos_calibration"): "six joints; the library sends seven requests",
        }
    ),
}
# By class and method, where the results may differ; the frames too, because the library sends
# again what was not answered.
_ONE_BYTE = "the library sends one byte where the maker's page has more, and gets no reply"
UNANSWERED = {
    **{
        (robot, method): _ONE_BYTE
        for robot in ("Mercury (A1)", "Mercury (B1, X1)", "Pro400", "Pro630")
        for method in ("tool_serial_set_baud", "tool_serial_set_timeout")
    },
    ("MyArm", "clear_error_information"): _NO_ACK,
    ("MechArm", "set_ssid_pwd"): _NO_ACK,
    ("MyCobot", "set_ssid_pwd"): _NO_ACK,
    ("MyCobotSocket", "set_ssid_pwd"): _NO_ACK,
    ("MyCobotSocket", "get_tof_distance"): _ENDLESS,
    ("MyPalletizer260", "set_gripper_value"): _NO_ACK,
    ("MyPalletizerSocket", "set_gripper_value"): _NO_ACK,
    ("MyPalletizerSocket", "set_ssid_pwd"): _NO_ACK,
    ("MyPalletizerSocket", "get_tof_distance"): _ENDLESS,
    ("MyPalletizer260", "set_ssid_pwd"): _NO_ACK,
}
UNANSWERED = _also_by_tcp(UNANSWERED)
# By class and method, where the results may differ.
RESULTS = {
    ("Pro450Client", "base_external_485_control"): "the reply of the bus; the library wants a mode",
    ("Pro450Client", "base_external_can_control"): "the reply of the bus; the library wants a mode",
    ("Pro450Client", "get_force_sensor_data"): "six numbers or an error; the library has any bytes",
    **{
        (name, method): why
        for name in ("MyBuddy", "MyBuddySocket")
        for method, why in {"read_next_error": _DROPPED, "get_joint_current": _NOT_READ}.items()
    },
    **{
        (name, method): _TENTHS
        for name in ("MechArm", "MyCobot")
        for method in (
            *("get_joint_min_angle", "get_joint_max_angle"),
            *("get_system_version", "get_basic_version"),
        )
    },
    ("MechArm", "solve_inv_kinematics"): _HUNDREDTHS,
    ("MyCobot", "solve_inv_kinematics"): _HUNDREDTHS,
    ("MyArm", "send_coords"): "with a mode, the library drops the acknowledgement and returns None",
    ("MyArmC", "is_tool_btn_clicked"): "a part of the reply that did not come is None here",
    ("MyArm", "go_home"): "the library returns None; ours the result of the order that it sends",
}
# By class and method: where our parameters are others.
PARAMETERS = {
    ("MyArmSocket", "sync_send_coords"): "mode has the default of the serial class",
    ("MyCobotSocket", "sync_send_coords"): "mode has the default of the serial class",
}
# Motions that both wait for: the frames in between may differ, and what a failed motion does.
MOTIONS = dict.fromkeys(
    (
        *("send_angle", "send_angles", "send_coord", "send_coords", "set_solution_angles"),
        *("jog_increment_angle", "jog_increment_coord", "write_move_c", "write_move_c_r"),
        *("send_base_coord", "send_base_coords", "over_limit_return_zero", "go_home"),
        "drag_teach_execute",
    ),
    "a failed motion raises RequestRefused; the library queries the arm and explains it",
)
# Where ours raises MotionTimeout: the simulated arm does not reach a target, since no source gives
# its geometry; the library returns as if it did.
LATE = ("sync_send_angles", "sync_send_coords")
# By class and method, where the library raises an error by mistake.
_EXPLAINS = "the library fails when a motion ends: it has no method to explain the end"
MISTAKES = {
    **{("Pro400", method): _EXPLAINS for method in (*MOTIONS, "sync_send_angles")},
    ("MyCobot280RDKX5", "sync_send_angles"): "the library fails by is_in_position, which it asks",
    ("Pro400", "power_on"): "the library fails by get_limit_switch, after the arm has power",
}
MISTAKES = _also_by_tcp(MISTAKES)
_SIZE = "the library does not read replies of this size, or reads a part of them"
_SIGN = "the library reads the highest bit as a sign, and lists other bits then"
_PIN = "a pin in the reply is optional here; the library reads a reply of one kind wrongly"
_TOOLS = [f"get_pro_gripper{what}" for what in ("", "_angle", "_torque", "_speed", "_status")]
_TOOLS += [
    f"get_hand_gripper_{what}" for what in ("angle", "torque", "p", "d", "i", "id", "status")
]
_TOOLS += ["get_hand_gripper_clockwise", "get_hand_gripper_counterclockwise", "get_hand_model"]
_TOOLS += ["get_hand_gripper_min_pressure", "get_hand_gripper_default_speed"]
_TOOLS += ["get_hand_firmware_major_version", "get_hand_firmware_minor_version"]
_SIZES = ["get_robot_status", "get_quick_move_info", "get_pos_over", "get_servo_encoder"]
_SIZES += ["get_dynamic_parameters", "get_digital_inputs", "tool_serial_read_data"]
_SIZES_630 = ["get_comm_error_counts", "get_solution_angles", "get_max_speed", "get_max_acc"]
_SIZES_630 += ["get_fusion_parameters", "get_pos_over_shoot", "get_joint_min_angle"]
_SIZES_630 += ["get_joint_max_angle"]
# By robot and method, where results of the same reply may differ.
REPLIES = {
    **{
        (robot, method): _SIGN
        for robot in ("Mercury (A1)", "Mercury (B1, X1)", "Pro630")
        for method in ("get_robot_status", "get_motors_run_err")
    },
    **{
        (robot, method): _SIZE
        for robot in ("Pro400", "Pro630")
        for method in (*_TOOLS, *_SIZES, *(_SIZES_630 if robot == "Pro630" else ()))
    },
    **{
        (robot, "get_base_io_input"): _PIN
        for robot in ("Mercury (A1)", "Mercury (B1, X1)", "Pro400", "Pro630", "Pro450Client")
    },
    ("Pro400", "get_limit_switch"): "the library fails: it expects two numbers in its list of one",
    ("Pro450Client", "get_comm_error_counts"): "a count has no sign; the library gives it one",
    (
        "Pro450Client",
        "get_pro_gripper_offset",
    ): "-127..127 by its own page; the library has no sign",
}
REPLIES = _also_by_tcp(REPLIES)
REPLIES["Pro400Client", "get_angles"] = "ours are degrees; the library divides thousandths by 100"
