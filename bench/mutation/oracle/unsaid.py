"""What an edition leaves open of a command, so that nobody can say what is wrong.

Each sentence is from the command's own entry in ``spec/``: its ``doc`` and its ``notes``.
"""

from __future__ import annotations

# Faults of what a command means. Its frames, times and echoes are never left open.
OF_MEANING = frozenset(
    {
        *("sign", "scale", "order", "endianness", "value"),
        *("ignored", "stored wrong", "wrong part"),
    }
)
LEFT_OPEN = {
    "clear_queue": "no source says what becomes of the motion that is under way, and only waiting "
    "targets are thrown away, of which no query tells",
    "joint_brake": "the edition says that a motor is braked, and no query tells of brakes",
    "clear_error_information": "an error comes of a motion that cannot be done, and such a target "
    "lies outside every workspace that a tester has leave for",
    "jog_rpy": "the edition does not say about which coordinate roll, pitch and yaw turn, nor "
    "which way is forward",
    "set_four_pieces_zero": "no query tells of the four-piece motor, so nobody knows whether its "
    "zero was set",
    "init_gripper": "no other reply tells whether a gripper was found",
    "drag_start_record": "no source says whether an older recording is kept, so any count is right",
    "drag_end_record": "no source says how many points a second are kept, so any count is right",
    "drag_get_record_len": "no source says how many points a second are kept, so any count is "
    "right",
    "drag_get_record_data": "the points are what the joints did while they were led by hand, which "
    "nobody on the line knows",
    "drag_clear_record_data": "the maker's library marks the recording's calls as not yet tested",
}
