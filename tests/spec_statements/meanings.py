"""States safety, roles and queries by the names and words with which commands are described.

The maker chose the names; the patterns say what such names mean. An exception is a line of its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cobotwire_codegen.model import Command, Edition

# Name, then description. The first pattern that fits decides.
SAFETY = (
    ("setting", r"get_\w+|drag_get_\w+", r"Reads the next"),  # reading consumes what is read
    ("query", r"(is|check|read|get|drag_get)_\w+", r"Reads|Reports|Reading"),
    ("query", r"\w+_to_\w+|solve_\w+", r"Calculates"),
    ("persistent write", r"\w+_(calibration|zero)", r"Makes the .*position.* its zero"),
    ("persistent write", r"set_joint_m\w\w", r"Sets the \w+ allowed angle"),
    ("persistent write", r"set_servo_data", r"Writes .* into a register"),
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
    ("setting", r"(set|clear)_\w+", r"Sets|Makes|Turns|Outputs|Clears"),
)
ROLES = (
    ("joint targets", r"send_(angles|radians)", r"Moves all \w+ joints to angles"),
    ("joint target", r"send_angle|jog_absolute", r"(Moves|Turns) one joint to an angle"),
    ("coordinate targets", r"send_coords", r"Moves the end to a position and orientation"),
    ("coordinate target", r"send_coord", r"Moves the end so that one coordinate"),
    ("reached", r"is_in_position", r"Reports whether the arm is at a target"),
    ("moving", r"is_moving", r"Reports whether the arm is in motion"),
    ("stop", r"stop", r"Stops the motion"),
    ("halt", r"jog_stop", r"Stops a motion that"),
    ("halt", r"clear_queue", r"Discards the targets"),
    ("light", r"set_color", r"Sets the colour of the Atom's light"),
    ("joints", r"get_angles", r"Reads the angles of all"),
    ("coordinates", r"get_coords", r"Reads the position and orientation"),
    ("powered", r"is_power_on", r"Reports whether the Atom is powered"),
    ("paused", r"is_paused", r"Reports whether the motion is paused"),
    ("error", r"get_error_information", r"Reads why the arm did not move"),
    ("version", r"get_system_version", r"Reads the version of the firmware"),
    ("gripper", r"set_gripper_state", r"Opens, closes|Opens or closes"),
)
# A command, the query that reads it back, and what the query then reports (None: fields of the same
# names).
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
    (r"set_(encoders)_drag", r"get_\1", None),
    (r"(?:set|send)_(\w+)", r"get_\1", None),
    (r"set_(\w+)", r"is_\1", None),
)
# A query, and the queries that report the same values.
AGREES = (
    (r"get_(angles)_(coords)", (r"get_\1", r"get_\2")),
    (r"get_(\w+)_plan", (r"get_\1",)),
    (r"get_(encoder)", (r"get_\1s",)),
    (r"get_(?:encoders|radians)", ("get_angles",)),
)


def fits(command: Command, name: str, doc: str) -> bool:
    """Return whether patterns of a name and a description fit a command."""
    return bool(re.fullmatch(name, command.name)) and bool(re.match(doc, command.doc))


def safety(edition: Edition) -> Iterator[str]:
    """Report commands with another safety class than their name and description tell."""
    for command in edition.commands:
        found = [word for word, name, doc in SAFETY if fits(command, name, doc)][:1]
        if found != [command.safety]:
            yield f"{command.name} is a {command.safety}, but its description says {found}"


def roles(edition: Edition) -> Iterator[str]:
    """Report commands with another role than their name and description tell."""
    for command in edition.commands:
        found = [word for word, name, doc in ROLES if fits(command, name, doc)]
        if found != [command.role] * bool(command.role):
            yield f"{command.name} has the role {command.role!r}, but is described as {found}"


def read_back(edition: Edition) -> Iterator[str]:
    """Report setters that another query reads back than the one that their name tells."""
    known = {command.name for command in edition.commands}
    for command in edition.commands:
        wanted = None
        for pattern, query, fields in READ_BY:
            match = re.fullmatch(pattern, command.name)
            if match and match.expand(query) in known and wanted is None:
                wanted = (match.expand(query), fields or ())
        back = command.read_by
        stated = None if back is None else (back.query, back.fields)
        if stated != wanted:
            yield f"{command.name} is read by {stated}, but its name says {wanted}"


def agreement(edition: Edition) -> Iterator[str]:
    """Report queries that agree with others than their names tell."""
    for command in edition.commands:
        wanted: tuple[str, ...] = ()
        for pattern, queries in AGREES:
            match = re.fullmatch(pattern, command.name)
            if match and not wanted:
                wanted = tuple(match.expand(query) for query in queries)
        if command.agrees_with != wanted:
            yield f"{command.name} agrees with {command.agrees_with}, but its name says {wanted}"


def echoes(edition: Edition) -> Iterator[str]:
    """Report fields that a reply repeats from its request, but not as an echo."""
    for command in edition.commands:
        given = {field.name for variant in command.requests for field in variant}
        for field in (field for variant in command.replies for field in variant):
            if field.name in given and field.name in ("joint", "pin") and not field.echo:
                yield f"{command.name}: {field.name} of the reply repeats the request's"


def longest(edition: Edition) -> Iterator[str]:
    """Report another maximum than the document quotes (0-16), or than the longest message needs."""
    sizes = [
        sum(field.type.size for field in variant)
        for command in edition.commands
        for variant in (*command.requests, *command.replies)
    ]
    quoted = [int(e.says[2:]) for e in edition.errata if re.fullmatch(r"0-\d+", e.says)]
    if edition.frame.maximum_data != max([*sizes, *quoted]):
        yield f"the frame carries {edition.frame.maximum_data} bytes; needed {max(sizes)}"


def explained_errors(edition: Edition) -> Iterator[str]:
    """Report an error register whose numbers have no meanings."""
    for command in edition.commands:
        codes = [field.type for field in command.reply if field.type.name.startswith("error")]
        if command.role == "error" and not all(getattr(code, "meanings", ()) for code in codes):
            yield f"{command.name}: nothing says what its numbers mean"


RULES = (explained_errors, echoes, longest, safety, roles, read_back, agreement)
