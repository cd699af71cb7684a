"""What an edition does not define about a command, so that every behaviour is correct.

Each sentence comes from the command's entry in ``spec/``: its ``doc`` and its ``notes``.
"""

from __future__ import annotations

# Faults in the effect of a command; its frames, times and echoes are always defined.
OF_MEANING = frozenset(
    {
        *("sign", "scale", "order", "endianness", "value"),
        *("ignored", "stored wrong", "wrong part"),
    }
)
NO_ERROR = (
    "an error is caused by an impossible motion, and its target lies outside every workspace that "
    "a tester is permitted"
)
LEFT_OPEN = {
    "clear_queue": "no source says what happens to the present motion, and no query reports the "
    "waiting targets",
    "get_plan_speed": "no source says which of the two speeds set_plan_speed sets, nor what the "
    "other one is",
    "get_plan_acceleration": "no source says which of the two accelerations set_plan_acceleration "
    "sets, nor what the other one is",
    "joint_brake": "the edition only says that a motor is braked, and no query reports brakes",
    "clear_error_information": NO_ERROR,
    "jog_rpy": "the edition does not say which coordinates roll, pitch and yaw change, nor "
    "which direction is forward",
    "set_four_pieces_zero": "no query reports the four-piece motor, so it is unknown whether its "
    "zero was set",
    "set_gripper_calibration": "no command of this arm reads the opening, and no source says that "
    "another value counts from the new zero",
    "init_gripper": "no other reply reports whether a gripper was found",
    "drag_start_record": "no source says whether an older recording is kept, so any count is right",
    "drag_end_record": "no source says how many points a second are kept, so any count is right",
    "drag_get_record_len": "no source says how many points a second are kept, so any count is "
    "right",
    "drag_get_record_data": "the points are the motion of the joints while they were led by hand, "
    "which is unknown on the line",
    "base_external_control": "the bytes of the reply come from a device at the base, which is "
    "unknown on the line",
    "tool_serial_read_data": "the bytes come from a device at the end of the arm, which is unknown "
    "on the line",
    "drag_clear_record_data": "the maker's library marks the recording's calls as not yet tested",
}
# Commands of outputs, with the queries of the inputs of the same numbers. The simulated arm wires
# each output to its input. An edition that does not state this wiring has no query of an output.
WIRED = {"set_digital_output": "get_digital_input", "set_base_io_output": "get_base_io_input"}
UNWIRED = "no source says that an output of this arm is wired to an input, and no query reads one"
# Queries of errors: see "clear_error_information".
ERRORS = frozenset({"get_error_information"})
