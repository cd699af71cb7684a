"""The closed lists of words, with descriptions where a word needs one."""

from __future__ import annotations

SAFETY = {
    "query": "Reads a value and changes nothing. Clients repeat only queries automatically.",
    "setting": "Changes a setting until the power is switched off.",
    "motion": "Moves the arm, or allows it to move.",
    "power": "Switches power.",
    "persistent write": "Changes something that survives a power cycle.",
}
CHECKS = {
    "footer": "Every frame ends with the same bytes, and no number is computed.",
    "sum": "The sum of the bytes, cut to the size of the check.",
    "inverted-sum": "The sum with all bits inverted, as on the bus of Dynamixel servos.",
    "negated-sum": "The number that gives zero when it is added to the sum, as in Intel HEX.",
    "xor": "The exclusive or of the bytes.",
    "fletcher": "Two running sums modulo 256 (RFC 1145, u-blox); the second is the high byte.",
    "fletcher-16": "Two running sums modulo 255; the second is the high byte.",
}
REPLIES = {
    "own": "From this address, which only one device has.",
    "any": "From any address: the request reaches several devices, and each may reply.",
    "one": "From any address, once: the request reaches several devices, and one replies for all.",
    "none": "From no address: it is a broadcast, and no device replies.",
}
ROLES = {
    "joint targets": "Moves each joint to a target of its own, at a speed.",
    "joint target": "Moves one joint: one argument selects it, another is its target.",
    "coordinate targets": "Moves the end of the arm to coordinates, at a speed.",
    "coordinate target": "Moves along one axis: one argument selects it, another is its target.",
    "reached": "Reports whether the arm is at a target.",
    "moving": "Reports whether the arm is in motion.",
    "stop": "Stops the arm.",
    "joints": "Reports the angles of all joints.",
    "coordinates": "Reports the pose of the end of the arm.",
    "motion ended": "An event: a motion has ended; its last field is the status.",
    "powered": "Reports whether the motors have power.",
    "paused": "Reports whether the motion is paused.",
    "error": "Reports why the arm did not move; 0 is no error.",
    "version": "Reports the version of the firmware.",
    "gripper": "Opens or closes the gripper, at a speed.",
    "halt": "Ends a motion or discards targets, and starts no motion.",
    "light": "Sets the colour of a light; nothing moves, and nothing has to be restored.",
}
MOVED = {
    "joints": "All joints.",
    "joint": "One joint.",
    "end": "The end of the arm, or with `about` one of its coordinates.",
    "gripper": "The gripper; 0 percent is closed, 100 open.",
}
ZEROED = {
    "joints": "All joints.",
    "joint": "One joint.",
    "gripper": "The gripper.",
}
CONTROLS = {
    "stop": "Every motion and every pause ends; the next motion is obeyed.",
    "halt": "The present motion ends; the next one is obeyed.",
    "pause": "The arm stops, and keeps its targets.",
    "resume": "A pause ends, and the arm continues.",
    "forget": "The waiting targets are discarded.",
}
# The state that every arm has: the simulator computes it, so no edition declares it.
BUILT_IN = {
    "angles": "The angle of each joint, or with `at` of one joint, in the field's unit.",
    "coords": "The coordinates of the end of the arm or its tool, in the frame that is set.",
    "base_coords": "The coordinates of the end of the arm in the frame of the base.",
    "planned_angles": "The angles at which the present motion ends.",
    "planned_coords": "The coordinates at which the present motion ends, in the frame of the base.",
    "opening": "How far the gripper is open, in percent.",
    "speeds": "How fast the joints turn.",
    "moving": "Whether the arm moves.",
    "gripper_moving": "Whether the gripper moves.",
    "reached": "Whether the arm is at the target of the request.",
    "powered": "Whether the motors have power.",
    "held": "For each joint, whether it has torque.",
    "free": "Whether free mode is on: no joint has torque.",
    "paused": "Whether the motion is paused.",
    "connected": "Whether the controller at the end of the arm is connected.",
    "error": "The code of the last error; 0 is no error.",
    "lowest": "For each joint, the smallest allowed angle.",
    "highest": "For each joint, the largest allowed angle.",
    "starts": "How often the controller has started.",
}
# The built-in states that a command can store or set.
SETTABLE = (
    *("powered", "connected", "free", "error", "held", "lowest", "highest"),
    *("opening", "base_coords"),
)
CONFIDENCE = ("high", "medium", "low")
VERDICTS = ("consistent", "erratum", "label only", "text and byte disagree")
REASONS = (
    "no-header",
    "bad-address",
    "bad-length",
    "unknown-id",
    "bad-check",
    "truncated",
    "trailing",
    "bad-value",
)
ERRATUM_KINDS = ("text", "table", "title", "label", "example", "missing")
