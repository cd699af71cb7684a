"""What an edition leaves undefined about a command, so that no behaviour of it is wrong.

Each sentence comes from the command's entry in ``spec/``: its ``doc`` and its ``notes``.
"""

from __future__ import annotations

# Faults of a command's meaning. Its frames, times and echoes are always defined.
OF_MEANING = frozenset(
    {
        *("sign", "scale", "order", "endianness", "value"),
        *("ignored", "stored wrong", "wrong part"),
    }
)
LEFT_OPEN = {
    "clear_queue": "no source says what happens to the present motion, and no query reports the "
    "waiting targets",
    "joint_brake": "the edition says that a motor is braked, and no query reports brakes",
    "clear_error_information": "an error is caused by an impossible motion, and its target "
    "lies outside every workspace that a tester is permitted",
    "jog_rpy": "the edition does not say which coordinates roll, pitch and yaw change, nor "
    "which direction is forward",
    "set_four_pieces_zero": "no query reports the four-piece motor, so nobody knows whether its "
    "zero was set",
    "init_gripper": "no other reply reports whether a gripper was found",
    "drag_start_record": "no source says whether an older recording is kept, so any count is right",
    "drag_end_record": "no source says how many points a second are kept, so any count is right",
    "drag_get_record_len": "no source says how many points a second are kept, so any count is "
    "right",
    "drag_get_record_data": "the points are what the joints did while they were led by hand, which "
    "nobody on the line knows",
    "drag_clear_record_data": "the maker's library marks the recording's calls as not yet tested",
}
