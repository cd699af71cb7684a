"""Derive safety, role and read-back query of a command from its name and description.

The maker chose the names; the patterns state their meanings. Each exception has its own line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire_codegen.model import Command, Edition

# Safety class, pattern of the name, pattern of the description. The first row that fits decides.
SAFETY = (
    # These queries remove what they read from the device.
    ("setting", r"get_\w+|drag_get_\w+|\w+_read_data", r"Reads the next|Reads bytes and removes"),
    ("query", r"(is|check|read|get|drag_get|tool_serial)_\w+", r"Reads|Reports|Reading|Checks the"),
    ("query", r"get_encoders", r"The positions"),
    ("query", r"motion_ended|collision", r"A motion has ended|Reports whether .* would collide"),
    ("query", r"\w+_to_\w+|solve_\w+", r"Calculates|Converts"),
    ("power", r"set_(hand_gripper|servo|motor)_enabled", r"Switches"),
    ("power", r"set_(gripper_enabled|free_move_mode|control_mode)", r"Sets whether"),
    ("power", r"set_break|servo_restore|set_robot_power_\w+", r"Switches|Clears those errors"),
    ("power", r"drag_teach_(save|pause)", r"(Starts|Ends) .*recording"),
    ("motion", r"over_limit_return_zero|fourier_\w+|drag_teach_execute|write_\w+", r"Moves|Turns"),
    ("motion", r"set_(solution_angles|(hand|pro)_gripper_(abs_)?angles?)", r"Moves|Turns"),
    ("motion", r"set_(joints?_angle|servos?_encoder(_drag)?)", r"Moves"),
    # The register decides whether a gripper moves or stores a parameter.
    ("persistent write", r"set_pro_gripper", r"Writes a register"),
    ("motion", r"set_(pro|hand)_gripper", r"Writes a number into a register"),
    (
        "motion",
        r"(set_pro|set|init)_(electric_)?gripper(_\w+)?",
        r"Opens|Closes the|Initializes|Pauses",
    ),
    ("motion", r"set_pro_gripper_(resume|stop)", r"Continues|Stops"),
    ("motion", r"set_hand_gripper_pinch_action", r"Brings the hand into"),
    ("motion", r"stop_robot|clear_(waist|recv)_queue", r"Stops the motion|Discards the"),
    ("motion", r"set_encoders", r"The positions"),
    # The firmware stores tuning parameters of servos, joints and grippers.
    ("persistent write", r"set_servo_(p|d|i|cww?)", r"Sets (the|how far a servo)"),
    ("persistent write", r"set_(pro|hand)_gripper_(\w+)", r"Sets (the|how far one joint)"),
    ("persistent write", r"set_(model_direction|dynamic_parameters|motor_type)", r"Sets"),
    ("persistent write", r"clear_zero_pos|drag_teach_clean", r"Deletes"),
    ("persistent write", r"parameter_identify", r"Calculates the parameters"),
    ("persistent write", r"\w+_(calibration|calibrate|zero)", r"Makes the .*position.* its zero"),
    ("persistent write", r"set_joint_m\w\w(_angle)?", r"Sets the \w+ allowed angle"),
    ("persistent write", r"set_servo(_system)?_data", r"Writes .* into a register"),
    ("persistent write", r"(backup|restore)_\w+", r"Saves|Restores"),
    ("persistent write", r"set_(ssid_pwd|server_port)", r"Sets the (name|TCP port)"),
    ("persistent write", r"set_\w*gripper_(torque|protect_current)", r"Sets the (torque|current)"),
    ("persistent write", r"drag_clear_\w+", r"Deletes"),
    ("power", r"power_\w+|release_\w+|focus_\w+", r"Switches .* (on|off)"),
    ("power", r"set_free_mode", r".*the servos give no torque"),
    ("power", r"joint_brake", r"Brakes the motor"),
    ("power", r"drag_(start|end)_\w+", r"(Starts|Ends) .*recording"),  # the joints turn freely
    ("motion", r"(send|jog|move)_\w+", r"Moves|Turns|Stops|Sends"),
    ("motion", r"pause|resume|stop", r"Pauses|Continues|Stops"),
    ("motion", r"set_encoders?(_drag)?", r"Moves"),
    ("motion", r"(set|init)_gripper(_state|_value)?", r"Opens|Moves|Initializes"),
    ("motion", r"clear_queue", r"Discards the targets"),
    ("setting", r"(set|clear)_\w+", r"Sets|Makes|Turns|Outputs|Clears|Adds a point"),
    ("setting", r"tool_serial_\w+|collision_switch", r"Sets|Sends|Turns the check"),
    ("setting", r"base_external_control", r"Sends bytes"),
    # The servo bus.
    ("query", r"read|ping|sync_read", r"Reads|Makes a servo send"),
    ("persistent write", r"(reg_|sync_)?write|reset", r"Writes|Restores all"),
    ("motion", r"action", r"Executes what was written"),
)
ROLES = (
    ("joint targets", r"send_(angles|radians)", r"Moves all \w+ joints( of an arm)? to angles"),
    ("joint target", r"send_angle|jog_absolute", r"(Moves|Turns) one joint to an angle"),
    ("coordinate targets", r"send_coords", r"Moves the end of the arm to a position"),
    ("coordinate target", r"send_coord", r"Moves the end of the arm so that one coordinate"),
    ("joint target", r"set_joint_angle", r"Moves one joint to an angle"),
    ("reached", r"is_in_position(_coords)?", r"Reports whether the arm is at a target"),
    ("motion ended", r"motion_ended", r"A motion has ended"),
    ("moving", r"is_moving", r"Reports whether the arm is in motion"),
    ("stop", r"stop", r"Stops the motion"),
    ("halt", r"jog_stop", r"Stops a motion that"),
    ("halt", r"clear_(waist_|recv_)?queue|stop_robot", r"Discards the|Stops the motion"),
    ("halt", r"set_pro_gripper_(stop|pause)", r"(Stops|Pauses) the motion of the gripper"),
    ("light", r"set_(tool_led_)?color", r"Sets the colour of the.* light"),
    ("joints", r"get_angles", r"Reads the angles of all"),
    ("coordinates", r"get_coords", r"Reads the position and orientation"),
    ("powered", r"is_power_on", r"Reports whether the (Atom is|arm has|arm is) power"),
    ("paused", r"is_paused", r"Reports whether the motion is paused"),
    ("error", r"get_error_information", r"Reads why the arm did not move"),
    ("version", r"get_system_version", r"Reads the version of the firmware"),
    ("gripper", r"set_gripper_state", r"Opens, closes|Opens or closes"),
)
# The maker's page lists this command, but the library lacks it, so it has no role.
WITHOUT_ROLE = {("myarm_c650", "is_power_on")}
# A command, the query that reads it back, and the values that the query must report (None: fields
# of the same names).
READ_BY: tuple[tuple[str, str, tuple[tuple[str, str | int], ...] | None], ...] = (
    (r"power_on", "is_power_on", (("powered", 1),)),
    (r"power_off", "is_power_on", (("powered", 0),)),
    (r"release_\w+", "is_all_servo_enable", (("enabled", 0),)),
    (r"focus_\w+", "is_all_servo_enable", (("enabled", 1),)),
    (r"pause", "is_paused", (("paused", 1),)),
    (r"resume", "is_paused", (("paused", 0),)),
    (r"clear_(error_information)", r"get_\1", (("error", 0),)),
    (r"drag_clear_record_data", "drag_get_record_len", (("points", 0),)),
    # The maker: "the corresponding potential value is 2048"; "set the current position to zero".
    (r"set_servo_calibration", "get_encoder", (("encoder", 2048),)),
    (r"set_(gripper)_calibration", r"get_\1_value", (("value", 0),)),
    (r"set_(ssid_pwd)", r"get_\1", (("ssid", "account"), ("password", "password"))),
    (r"set_(joint_m\w\w)", r"get_\1_angle", None),
    (r"set_(digital|basic)_output", r"get_\1_input", None),
    (r"set_(\w+)_out_io_state", r"get_\1_in_io_state", None),
    (r"set_(encoders|servos_encoder)_drag", r"get_\1", None),
    (r"set_robot_power_on", "is_power_on", (("powered", 1),)),
    (r"set_robot_power_off", "is_power_on", (("powered", 0),)),
    (r"send_angle|jog_absolute", "get_joint_angle", None),
    (r"jog_absolute", "get_angle", None),
    (r"set_joints_angle|send_angles_auto", "get_angles", None),
    (r"write_move_c", "get_coords", (("coords", "end"),)),
    (r"write_move_c_r", "get_coords", None),
    (r"write_base_coords", "get_base_coord", None),
    (r"collision_switch", "is_collision_on", None),
    (r"set_servo_calibration", "get_angle", (("angle", 0),)),
    (r"drag_teach_clean", "get_drag_fifo_len", (("points", 0),)),
    (r"tool_serial_flush", "tool_serial_available", (("count", 0),)),
    (r"set_tool_serial_(baud_rate|timeout)", "get_tool_config", None),
    (r"set_pro_gripper_open", "get_pro_gripper_angle", (("value", 100),)),
    (r"set_(pro)_gripper_(close|calibration)", r"get_\1_gripper_angle", (("value", 0),)),
    (r"set_hand_gripper_calibrate", "get_hand_gripper_angle", (("value", 0),)),
    (r"(?:set|send)_(\w+)", r"get_\1", None),
    (r"set_(\w+)", r"is_\1", None),
)
# A Mercury reports its power as a number, and has a query for the state of one servo.
_MERCURY = (
    (r"power_on(_only)?", "is_power_on", (("state", 1),)),
    (r"power_off", "is_power_on", (("state", 0),)),
    (r"release_servo", "is_servo_enable", (("enabled", 0),)),
    (r"focus_servo", "is_servo_enable", (("enabled", 1),)),
)
READ_BY_OF = {"mercury_a1": _MERCURY}
# For these setters, the query of the matching name reports a list, another number of switches, or
# what a selector chooses, so it does not read them back.
NOT_READ = {
    "mercury_a1": r"set_(limit_switch|fusion_parameters|collision_threshold|torque_comp|drag_fifo"
    r"|model_direction|digital_output|(pro|hand)_gripper)",
    "mybuddy": r"set_plan_\w+|send_coord",
    "mycobot320": r"set_pro_gripper|set_hand_gripper_id",
}
# A query, and the queries that report the same values.
AGREES = (
    (r"get_(angles)_(coords)", (r"get_\1", r"get_\2")),
    (r"get_(\w+)_plan", (r"get_\1",)),
    (r"get_(angle|encoder|servo_encoder)", (r"get_\1s",)),
    (r"get_servo_encoder", ("get_servos_encoder",)),
    (r"get_quick_move_info", ("get_angles", "get_coords")),
    (r"get_(?:encoders|radians)", ("get_angles",)),
)


def fits(command: Command, name: str, doc: str) -> bool:
    """Return whether patterns of a name and a description fit a command."""
    return bool(re.fullmatch(name, command.name)) and bool(re.match(doc, command.doc))


def safety(edition: Edition) -> Iterator[str]:
    """Report commands with another safety class than their name and description imply."""
    for command in edition.commands:
        found = [word for word, name, doc in SAFETY if fits(command, name, doc)][:1]
        if found != [command.safety]:
            yield f"{command.name} is a {command.safety}, but its description says {found}"


def roles(edition: Edition) -> Iterator[str]:
    """Report commands with another role than their name and description imply."""
    for command in edition.commands:
        found = [word for word, name, doc in ROLES if fits(command, name, doc)]
        if (edition.name, command.name) in WITHOUT_ROLE:
            found = []
        if found != [command.role] * bool(command.role):
            yield f"{command.name} has the role {command.role!r}, but is described as {found}"


def read_back(edition: Edition) -> Iterator[str]:
    """Report setters that are read back by another query than their name suggests."""
    known = {command.name for command in edition.commands}
    names = (edition.name, *edition.bases)
    rows = [row for name in names for row in READ_BY_OF.get(name, ())]
    for command in edition.commands:
        wanted = None
        for pattern, query, fields in (*rows, *READ_BY):
            match = re.fullmatch(pattern, command.name)
            if match and match.expand(query) in known and wanted is None:
                wanted = (match.expand(query), fields or ())
        if any(re.fullmatch(NOT_READ.get(name, ""), command.name) for name in names):
            wanted = None
        back = command.read_by
        stated = None if back is None else (back.query, back.fields)
        if stated != wanted:
            yield f"{command.name} is read by {stated}, but its name says {wanted}"


def agreement(edition: Edition) -> Iterator[str]:
    """Report queries that agree with other queries than their names imply."""
    known = {command.name for command in edition.commands}
    # On the RDK X5, get_encoder also reads the gripper's servo, which get_encoders does not report.
    known -= {"get_encoders"} if edition.name == "mycobot280_rdkx5" else set()
    for command in edition.commands:
        wanted: tuple[str, ...] = ()
        for pattern, queries in AGREES:
            match = re.fullmatch(pattern, command.name)
            if match and not wanted:
                wanted = tuple(match.expand(query) for query in queries)
                wanted = wanted if known.issuperset(wanted) else ()
        if command.agrees_with != wanted:
            yield f"{command.name} agrees with {command.agrees_with}, but its name says {wanted}"


# The arguments that choose what a query reports; its reply repeats them.
ABOUT = {"joint", "pin", "servo", "register", "address", "gripper", "gripper_id"}


def echoes(edition: Edition) -> Iterator[str]:
    """Report fields that a reply repeats from its request, but that are not marked as an echo.

    If the first variant of the reply lacks the field, later variants must mark it as required.
    """
    for command in edition.commands:
        given = {field.name for variant in command.requests for field in variant}
        first = {field for variant in command.replies[:1] for field in variant}
        for field in (field for variant in command.replies for field in variant):
            echoed = field.echo == "required" or (field.echo and field in first)
            if field.name in ABOUT & given and field.const is None and not echoed:
                yield f"{command.name}: {field.name} of the reply repeats the request's"


def longest(edition: Edition) -> Iterator[str]:
    """Report a maximum that is neither what the document quotes (0-16) nor what messages need."""
    sizes = [
        sum(field.type.size for field in variant)
        for command in edition.commands
        for variant in (*command.requests, *command.replies)
    ]
    quoted = [int(e.says[2:]) for e in edition.errata if re.fullmatch(r"0-\d+", e.says)]
    # Editions based on the Mercury A1 share its frame. A servo's LEN is at most FF and counts two
    # bytes besides the data.
    quoted += [56] * ("mercury_a1" in edition.bases) + [253] * (edition.name == "servo_bus")
    if edition.frame.maximum_data != max([*sizes, *quoted]):
        yield f"the frame carries {edition.frame.maximum_data} bytes; needed {max(sizes)}"


def explained_errors(edition: Edition) -> Iterator[str]:
    """Report an error register whose numbers have no meanings."""
    for command in edition.commands:
        codes = [field.type for field in command.reply if field.type.name == "error_code"]
        known = edition.name not in ("mybuddy", "mypalletizer260")  # no page explains theirs
        if known and command.role == "error" and not all(getattr(c, "meanings", ()) for c in codes):
            yield f"{command.name}: nothing says what its numbers mean"


RULES = (explained_errors, echoes, longest, safety, roles, read_back, agreement)
