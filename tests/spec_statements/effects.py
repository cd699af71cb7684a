"""States what commands do by the names and words with which they are described.

An effect is written in a line, such as ``stores pins at pin``: the verb, what it is about, ``at``
with the arguments that choose an index, and the other keys. Names of state are this project's own,
but that of a setter and its query follows from their names. What a state is like follows from the
fields that report and set it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain

from cobotwire_codegen.language.words import BUILT_IN
from cobotwire_codegen.model import Command, Edition, Effect, Quantity, Type
from spec_statements.meanings import fits

# Name, then description, and the effect. The first pattern that fits decides.
EFFECTS = (
    (r"power_on", r"Switches", "sets powered=True held=True free=False connected=True"),
    (r"power_off", r"Switches .* disconnects", "sets powered=False held=False connected=False"),
    (r"release_all_\w+", r"Switches all .* off", "sets held=False"),
    (r"release_\w+", r"Switches .* one joint off", "sets held=False at joint"),
    (r"focus_all_\w+", r"Switches .* all joints on", "sets held=True"),
    (r"focus_\w+", r"Switches .* one joint on", "sets held=True at joint"),
    (r"joint_brake", r"Brakes the motor of one joint", "does halt at joint"),
    (r"pause|resume", r"Pauses|Continues", r"does \g<0>"),
    (r"jog_stop", r"Stops a motion", "does halt"),
    (r"clear_queue", r"Discards the targets", "does forget"),
    (r"clear_error_\w+", r"Clears the controller's error", "sets error=0"),
    # Motions.
    (
        r"jog_angle",
        r"Turns one joint in one direction.* until",
        "moves joint at joint until=limit direction=direction speed=speed",
    ),
    (
        r"jog_coord",
        r"Moves the end along or about one axis.* until",
        "moves end until=limit about=axis direction=direction speed=speed",
    ),
    (
        r"jog_rpy",
        r"Turns the end about a fixed axis.* until",
        "moves end until=limit about=axis keeps=position direction=direction speed=speed",
    ),
    (
        r"jog_increment_coord",
        r"Moves the end .* by a step",
        "moves end by=increment about=axis speed=speed",
    ),
    (
        r"jog_increment\w*",
        r"Turns one joint by an angle",
        "moves joint at joint by=increment speed=speed",
    ),
    (
        r"set_encoder",
        r"Moves one joint.*, at a speed",
        "moves joint at joint to=encoder speed=speed",
    ),
    (r"set_encoder", r"Moves one joint", "moves joint at joint to=encoder"),
    (r"set_encoders", r"Moves all", "moves joints to=encoders speed=speed"),
    (r"set_encoders_drag", r"Moves all", "moves joints to=encoders speed=speeds"),
    (r"set_gripper_value", r"Moves the gripper", "moves gripper to=value speed=speed"),
    (
        r"set_gripper_state",
        r"Opens or closes",
        "by state: OPEN moves gripper to=100 speed=speed; CLOSE moves gripper to=0 speed=speed",
    ),
    (
        r"set_gripper_state",
        r"Opens, closes or releases",
        "by state: OPEN moves gripper to=100 speed=speed; CLOSE moves gripper to=0 speed=speed; "
        "RELEASE sets gripper_held=False",
    ),
    (r"init_gripper", r"Initializes the gripper", "sets opening=100 assumed"),
    (r"set_gripper_calibration", r"Makes .* position its zero", "zeroes gripper"),
    (r"set_servo_calibration", r"Makes .* position of a joint", "zeroes joint at joint"),
    # State that the arm has anyway.
    (r"get_encoder", r"Reads the encoder position of one joint", "reports angles at joint"),
    (r"get_encoders", r"Reads the encoder positions", "reports angles"),
    (r"get_radians", r"Reads the angles .* in radians", "reports angles"),
    (r"get_(angles|coords)_plan", r"Reads the planned", r"reports planned_\1"),
    (r"get_angles_coords", r"Reads the angles .*, and", "reports angles=angles coords=coords"),
    (r"get_servo_speeds", r"Reads the speeds", "reports speeds"),
    (r"get_gripper_value", r"Reads how far the gripper is open", "reports opening"),
    (r"is_(gripper_moving)", r"Reports whether the gripper is moving", r"reports \1"),
    (r"is_servo_enable", r"Reports .* is connected", "reports held at joint assumed"),
    (r"is_all_servo_enable", r"Reports whether all servos", "reports held"),
    (r"is_controller_(connected)", r"Reports whether .* reaches", r"reports \1"),
    (r"(set|is)_free_mode", r"In free mode|Reports .* in free mode", "set: free"),
    (r"get_joint_min_angle", r"Reads the smallest", "reports lowest at joint"),
    (r"get_joint_max_angle", r"Reads the largest", "reports highest at joint"),
    (r"set_joint_min", r"Sets the smallest", "stores lowest at joint"),
    (r"set_joint_max", r"Sets the largest", "stores highest at joint"),
    (r"get_reboot_count", r"Reads how often the controller has started", "reports starts"),
    # State that the edition declares; `set` is stores for a setter, reports for its query.
    (r"(?:set|get)_(tool|world)_reference", r"(Sets|Reads) the position of", r"set: \1"),
    (r"(?:set|get)_(gripper)_protect_(current)", r"(Sets|Reads) the current", r"set: \1_\2"),
    (r"(?:set|get)_HTS_(gripper_torque)", r"(Sets|Reads) the torque", r"set: \1"),
    (r"(?:set|get)_transponder_mode", r"(Sets|Reports) whether the board", "set: transparent_mode"),
    (r"(?:set|get)_servo_data", r"(Writes|Reads) one", "set: registers at joint register"),
    (r"\w+_digital_(?:output|input)", r"(Sets|Reads) the level", "set: pins at pin"),
    (r"\w+_basic_(?:output|input)", r"(Sets|Reads) the level", "set: basic_pins at pin"),
    (r"set_pin_mode", r"Makes a pin", "stores pin_modes at pin"),
    (
        r"set_pwm_output",
        r"Outputs pulses",
        "stores frequency=pulse_frequency duty=pulse_duty at channel",
    ),
    (r"set_color", r"Sets the colour", "stores red=red green=green blue=blue"),
    (r"get_ssid_pwd", r"Reads the name and the password", "reports ssid=ssid password=password"),
    (r"set_ssid_pwd", r"Sets the name and the password", "stores account=ssid password=password"),
    (r"set_(server_port)", r"Sets the TCP port", r"stores \1"),
    (r"set_(vision_mode)", r"Turns vision mode", r"stores \1"),
    (r"check_async_or_sync", r"Reports whether .* synchronously", "reports synchronous_mode"),
    (r"get_modify_version", r"Reads the revision", "reports revision"),
    (r"get_(system_version|basic_version|tof_distance)", r"Reads the", r"reports \1"),
    (r"read_next_error", r"Reads one error byte for each joint", "reports joint_errors"),
    (r"get_(servo)_status", r"Reads the faults", r"reports \1_faults"),
    (r"get_(servo)_temps", r"Reads the temperatures", r"reports \1_temperatures"),
    (r"get_(servo_voltages)", r"Reads the voltages", r"reports \1"),
    (r"(?:set|get)_(\w+)", r"Sets|Reads|Reports", r"set: \1"),
    # Calculations, recordings, and what nothing tells.
    (r"angles_to_coords", r"Calculates the coordinates", "computes coords from=angles"),
    (r"solve_\w+", r"Calculates joint angles", "computes angles from=coords near=angles"),
    (r"drag_get_record_len", r"Reads how many points", "list points report=count"),
    (r"drag_clear_\w+", r"Deletes the recording", "list points clear=all"),
    (r"drag_\w+|(backup|restore)_\w+", r"Starts|Ends|Reads|Saves|Restores", "python"),
    (r"move_round|set_four_\w+", r"Turns a|Makes", "unknown"),
)


def in_words(effect: Effect) -> str:
    """Return an effect in a line."""
    if effect.cases:
        return f"by {effect.what}: " + "; ".join(f"{n} {in_words(e)}" for n, e in effect.cases)
    if effect.verb in ("python", "unknown"):
        return effect.verb
    alone = effect.verb != "sets" and len(effect.values) == 1
    values = [str(value) if alone else f"{name}={value}" for name, value in effect.values]
    at = ["at", *effect.at] if effect.at else []
    options = [f"{name}={value}" for name, value in effect.options]
    words = [effect.verb, effect.what, *values, *at, *options, "assumed" if effect.assumed else ""]
    return " ".join(filter(None, words))


# The editions with a row of EFFECTS for each command; those of others are held by their words.
IN_ROWS = ("mycobot", "mycobot280")
# Words that say the same as the words of a state.
SAYS: dict[str, str] = {
    "angles": r"encoder|radian|target_angle",
    "held": r"torque|enable|servo|motor|brake|on\b|off\b",
    "powered": r"power|switch|on\b|off\b",
    "connected": r"connected|disconnect|power_on|power_off",
    "free": r"free|power_on",
    "lowest": r"smallest|\bmin",
    "highest": r"largest|\bmax",
    "opening": r"open|close|gripper value|its zero",
    "halted": r"stop",
    "starts": r"started",
    "system": r"firmware",
    "atom": r"end of the arm|atom",
    "tool": r"\bend\b|tool|port",
    "tick": r"ticks",
    "points": r"record|drag",
    "planned": r"plan",
    "end": r"output|input|end|serial",
    "registers": r"register",
    "bus": r"gripper|hand",
    "faults": r"error|fault|status",
    "read": r"get|reads",
    "written": r"set|writes",
}
# Commands with words that name other state as well: what they are about.
ABOUT = (
    (r"power_on", "powered held free connected"),
    (r"(release|focus)_(all_)?servos?", "held"),
    (r"get_encoder", "angles"),
    (r"[sg]et_digital_(out|in)put", "pins end_pins"),
    (r"get_base_io_input", "base_pins"),
    (r"[sg]et_assist_\w+", "assist_pins"),
    (r"init_gripper", "opening"),
    (r"get_(robot_)?(modify|modified)_version", "revision"),
    (r"set_limit_switch", "checks_position reports_ends"),
    (r"[sg]et_world_reference", "world"),
    (r"set_hand_gripper_angles", "finger_positions hand_positions"),
    (r"tool_serial_restore", "tool_baud tool_timeout"),
    (r"is_in_position\w*", "reached"),
    (r"set_gripper_state", "gripper_held"),
    (r"[sg]et_servo(_system)?_data", "registers head_registers"),
    (r"[sg]et_communication_mode", "robot_protocol"),
    (r"is_init_calibration", "calibrated"),
    (r"check_async_or_sync", "synchronous_mode"),
    (r"set_pro_gripper_stop", "bus_paused"),
)
# The same where an edition has such state.
ABOUT_ITS_OWN = {
    "head_deviation": (r"[sg]et_servo_cw", "head_deviation"),
    "encoders": (r"[sg]et_servos?_encoder(_drag)?", "encoders servo_speeds"),
}


def named(edition: Edition) -> Iterator[str]:
    """Report state that neither the name nor the words of a command name, or another one better."""
    states = [*BUILT_IN, *(state.name for state in edition.states)]
    for command in edition.commands:
        effect = command.effect
        if effect is None:
            if not command.event and edition.states:
                yield f"{command.name} has no effect"
            continue
        if edition.name in IN_ROWS or effect.by_role:
            continue
        text = _text(command)
        for label, each in (("", effect), *effect.cases):
            for field, value in each.values if each.verb in ("reports", "stores", "sets") else ():
                state = str(value if each.verb != "sets" else field)
                several = each.verb != "sets" and (len(each.values) > 1 or label)
                beside = f"{label} {field}" if several else ""
                about = _about(command, states)
                if about:
                    if state not in about:
                        yield f"{command.name} {each.verb} {state}, but is about {about}"
                    continue
                best = max(_score(name, text, beside) for name in states)
                score = _score(state, text, beside)
                if score < best:
                    near = [name for name in states if _score(name, text, beside) == best]
                    yield f"{command.name} {each.verb} {state}, but its words say {near}"


def _about(command: Command, states: list[str]) -> list[str]:
    """Return the state that a command with ambiguous words is about; nothing for other commands."""
    rows = (*ABOUT, *(row for state, row in ABOUT_ITS_OWN.items() if state in states))
    return [n for name, about in rows if re.fullmatch(name, command.name) for n in about.split()]


def _text(command: Command) -> str:
    fields = " ".join(field.name for field in command.fields)
    return f"{command.name} {command.title} {command.doc} {fields}".lower().replace("_", " ")


def _score(state: str, text: str, beside: str) -> tuple[int, float, int]:
    """Rate how well a text names a state: by the field beside it, by its words, and how many."""
    words = state.split("_")
    found = [word for word in words if _says(word, text)]
    near = sum(_says(word, beside.lower().replace("_", " ")) for word in words) if beside else 0
    return near, len(found) / len(words), len(found)


def _says(word: str, text: str) -> bool:
    other = SAYS.get(word, "")
    stem = word[:5] if len(word) > 1 else rf"{word}\b"
    return bool(re.search(rf"\b{stem}" + (f"|{other}" if other else ""), text))


def effects(edition: Edition) -> Iterator[str]:
    """Report commands with another effect than their name and description tell."""
    for command in edition.commands if edition.name in IN_ROWS else ():
        if command.effect is None:
            yield f"{command.name} has no effect"
        elif not command.effect.by_role:
            found = (
                (re.fullmatch(n, command.name), e) for n, d, e in EFFECTS if fits(command, n, d)
            )
            wanted = next((match.expand(effect) for match, effect in found if match), "unstated")
            verb = "reports" if command.safety == "query" else "stores"
            stated, wanted = in_words(command.effect), wanted.replace("set:", verb, 1)
            if stated != wanted:
                yield f"{command.name} {stated}, but its description says {wanted}"


# Queries report these for more or fewer joints than the edition counts, or setters narrow them.
UNLIKE = {
    *("calibrated", "collision_threshold", "torque_compensation", "model_direction", "run_errors"),
    *("zero_encoders", "down_encoders", "written_registers", "hand_enabled", "servo_faults"),
    "servo_currents",
}


def states(edition: Edition) -> Iterator[str]:
    """Report state with another type or other indices than the fields that report or set it."""
    declared = {state.name: state for state in edition.states}
    types = {type.name: type for type in edition.types}
    pairs = [
        (str(state), command, effect, field)
        for command in edition.commands
        if (effect := command.effect) is not None and effect.verb in ("reports", "stores")
        for field, state in effect.values
        if state in declared
    ]
    asked = {state for state, command, _, _ in pairs if command.safety == "query"}
    for name, command, effect, field in pairs:
        # A setter may accept fewer values than its query reports.
        if command.safety == "query" or name not in asked:
            state, variants = declared[name], (*command.requests, *command.replies)
            found = {each.name: each.type for each in chain(*variants)}
            sizes = [each.type for each in chain(*variants) if each.name == field]
            widest = max(sizes, key=lambda type: type.size, default=None)
            if [found[at].name for at in effect.at] != list(state.each[: len(effect.at)]):
                yield f"{name} has other indices than {command.name}"
            left = [types.get(each) for each in state.each[len(effect.at) :]]
            if not _alike(state.type, widest, left) and name not in UNLIKE:
                yield f"{name} is unlike {field} of {command.name}"


def speeds(edition: Edition) -> Iterator[str]:
    """Report motions that take no notice of the speed in their request."""
    for command in edition.commands:
        arguments = {field.name for variant in command.requests for field in variant}
        effect = command.effect
        moves = effect is not None and effect.verb == "moves"
        heeded = effect is not None and effect.option("speed") == "speed"
        if moves and "speed" in arguments and not heeded:
            yield f"{command.name} does not move at the speed that is given"


# How a motion uses its arguments.
USES = {
    **dict.fromkeys(("speed", "speeds"), "speed"),
    **dict.fromkeys(("increment", "step"), "by"),
    "axis": "about",
    "direction": "direction",
}
# The simulated myBuddy turns its joints at one speed.
UNUSED = ("mybuddy", "set_encoders", "speeds")


def arguments(edition: Edition) -> Iterator[str]:
    """Report motions that use an argument otherwise than its name tells, or not at all."""
    for command in edition.commands:
        effect = command.effect
        cases = () if effect is None else (effect, *(inner for _, inner in effect.cases))
        given = {field.name for variant in command.requests for field in variant}
        for each in cases:
            if each.verb == "moves":
                used = {str(value): key for key, value in each.options}
                for name in sorted(given & {*USES, *used}):
                    wanted = (
                        None
                        if (edition.name, command.name, name) == UNUSED
                        else USES.get(name, "to")
                    )
                    if used.get(name) != wanted:
                        yield f"{command.name} uses {name} as {used.get(name)}"
                if ("joint" in given) != ("joint" in each.at):
                    yield f"{command.name} moves at {each.at}"
                part = "gripper" if "gripper" in command.name else each.what
                if part != each.what or (each.what == "gripper") != ("gripper" in command.name):
                    yield f"{command.name} moves {each.what}"


def switches(edition: Edition) -> Iterator[str]:
    """Report state that is set to true or false and is no flag."""
    flags = {state.name for state in edition.states if state.type and state.type.kind == "flag"}
    others = {state.name for state in edition.states} - flags
    for command in edition.commands:
        if (effect := command.effect) is not None:
            for each in (effect, *(inner for _, inner in effect.cases)):
                for name, value in each.values if each.verb == "sets" else ():
                    if name in (others if isinstance(value, bool) else flags):
                        yield f"{command.name} sets {name} to {value}"


def _alike(kept: Type | None, type: Type | None, left: list[Type | None]) -> bool:
    """Return whether a field has the values of a state: a row of them if an index is left.

    A text has no type.
    """
    if not left or kept is None or type is None:
        return kept == type
    each = left[-1]
    bounds = each.bounds if isinstance(each, Quantity) else None
    if bounds is None or len(left) > 1:
        return False
    return [part for _, part in type.parts] == [kept] * int(bounds[1] - bounds[0] + 1)


RULES = (named, effects, states, speeds, arguments, switches)
