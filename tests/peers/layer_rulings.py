"""Why calls of the layer differ from the same calls of the maker's library.

Both differ in which values they allow; ``make robots`` compares and rules that for our clients.
"""

from __future__ import annotations

_NEAREST = "the nearest step; the library truncates"
_ASKS_ONCE = "the arm is asked whether it moves, and less often where it is"
_NO_ACK = "the edition has no acknowledgement of it, so the library waits in vain and returns -1"

# By method, where the frames may differ.
FRAMES = {
    "send_angles": _NEAREST,
    "send_radians": _NEAREST,
    "sync_send_angles": _ASKS_ONCE,
    "sync_send_coords": _ASKS_ONCE,
}
# By class and method, where the results may differ; the frames too, because the library sends
# again what was not answered.
UNANSWERED = {
    ("MyArm", "clear_error_information"): _NO_ACK,
    ("MyPalletizer260", "set_gripper_value"): _NO_ACK,
    ("MyPalletizer260", "set_ssid_pwd"): _NO_ACK,
}
# By class and method, where the results may differ.
RESULTS = {
    ("MyArm", "send_coords"): "with a mode, the library drops the acknowledgement and returns None",
    ("MyArmC", "is_tool_btn_clicked"): "a part of the reply that did not come is None here",
    ("MyArm", "go_home"): "the library returns None; ours the result of the order that it sends",
}
# By class and method: where our parameters are others.
PARAMETERS = {
    ("MyArmSocket", "sync_send_coords"): "mode has the default of the serial class",
}
