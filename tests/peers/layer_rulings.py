"""Why calls of the layer differ from the same calls of the maker's library.

Both differ in which values they allow; ``make robots`` compares and rules that for our clients.
"""

from __future__ import annotations

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
    "send_angles": _NEAREST,
    "send_radians": _NEAREST,
    "sync_send_angles": _ASKS_ONCE,
    "sync_send_coords": _ASKS_ONCE,
}
# By class and method, where the frames may differ.
OTHER_FRAMES = {
    ("MyBuddy", "set_encoders"): _ROWS,
    ("MyBuddySocket", "set_encoders"): _ROWS,
}
# By class and method, where the results may differ; the frames too, because the library sends
# again what was not answered.
UNANSWERED = {
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
# By class and method, where the results may differ.
RESULTS = {
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
