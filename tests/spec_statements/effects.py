"""States what commands do, derived from their names and descriptions.

An effect is written in one line, such as ``stores pins at pin``: the verb, the state or part of
the arm, ``at`` with the arguments that choose an index, and the other keys. This project chose the
names of states. Which state a setter and its query share follows from their names. The type and
indices of a state follow from the fields that report and set it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain

from cobotwire_codegen.language.words import BUILT_IN
from cobotwire_codegen.model import Command, Edition, Effect, Quantity, Type
from spec_statements.meanings import fits

# The effects other than reports and motions: patterns of name and description, and the effect. The
# first row that fits decides.
EFFECTS = (
    (r"power_on", r"Switches", "sets powered=True held=True free=False connected=True"),
    (r"power_off", r"Switches .* disconnects", "sets powered=False held=False connected=False"),
    (r"power_off", r"Switches", "sets powered=False held=False"),
    (r"release_all_\w+", r"Switches .*\ball .* off", "sets held=False"),
    (r"release_\w+", r"Switches .*\bone .* off", "sets held=False at joint"),
    (r"focus_all_\w+", r"Switches .*\ball .* on", "sets held=True"),
    (r"focus_\w+", r"Switches .*\bone .* on", "sets held=True at joint"),
    (r"joint_brake", r"Brakes the motor of one joint", "does halt at joint"),
    (r"pause|resume", r"Pauses|Continues", r"does \g<0>"),
    (r"jog_stop", r"Stops a motion", "does halt"),
    (r"stop_robot", r"Stops the motion", "does stop"),
    (r"clear_(recv_)?queue", r"Discards", "does forget"),
    (r"clear_(error_information|robot_err)", r"Clears the", "sets error=0"),
    (r"init_gripper", r"Initializes the gripper", "sets opening=100 assumed"),
    (r"init_electric_gripper", r"Initializes", "sets gripper_initialized=True"),
    (r"set_pro_gripper_pause", r"Pauses", "sets bus_paused=True at gripper_id"),
    (r"set_pro_gripper_resume", r"Continues", "sets bus_paused=False at gripper_id"),
    # The maker: "set the current position to zero".
    (r"set_gripper_calibration", r"Makes the present position", "zeroes gripper"),
    (r"angles_to_coords", r"Calculates the", "computes coords from=angles"),
    (r"solve_\w+", r"Calculates .*angles", "computes angles from=coords near=angles"),
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


# For a word in the name of a state, a pattern of other words with the same meaning.
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
# The state that a command is about, if its words also name other state.
ABOUT = (
    (r"power_on", "powered held free connected"),
    (r"get_robot_power_status", "powered"),
    (r"(release|focus)_(all_)?servos?", "held"),
    (r"get_encoder", "angles"),
    (r"[sg]et_joints?_min(_angle)?", "lowest"),
    (r"[sg]et_joints?_max(_angle)?", "highest"),
    (r"[sg]et_digital_(out|in)put", "pins end_pins"),
    (r"get_base_io_input", "base_pins"),
    (r"[sg]et_assist_\w+", "assist_pins"),
    (r"init_gripper", "opening"),
    (r"get_(robot_)?(modify|modified)_version", "revision"),
    (r"set_limit_switch", "checks_position reports_ends"),
    (r"[sg]et_world_reference", "world"),
    (r"set_hand_gripper_angles", "finger_positions hand_positions"),
    (r"tool_serial_restore", "tool_baud tool_timeout"),
    (r"is_(waist_)?in_position\w*", "reached"),
    (r"set_gripper_state", "gripper_held"),
    (r"[sg]et_servo(_system)?_data", "registers head_registers"),
    (r"[sg]et_communication_mode", "robot_protocol"),
    (r"is_init_calibration", "calibrated"),
    (r"check_async_or_sync", "synchronous_mode"),
    (r"set_pro_gripper_stop", "bus_paused"),
)
# The same for commands that are about this state only in editions that have it.
ABOUT_ITS_OWN = {
    "head_deviation": (r"[sg]et_servo_cw", "head_deviation"),
    "encoders": (r"[sg]et_servos?_encoder(_drag)?", "encoders servo_speeds"),
}


def named(edition: Edition) -> Iterator[str]:
    """Report effects on a state that the words of the command name less well than another state."""
    states = [*BUILT_IN, *(state.name for state in edition.states)]
    for command in edition.commands:
        effect = command.effect
        if effect is None:
            if not command.event and edition.states:
                yield f"{command.name} has no effect"
            continue
        if effect.by_role:
            continue
        text = _text(command)
        for label, each in (("", effect), *effect.cases):
            kept = [value for _, value in each.values]
            if each.verb in ("reports", "stores") and 1 < len({*kept}) < len(kept):
                yield f"{command.name} {each.verb} one state for two of its fields"
            fields = (f for variant in command.requests for f in variant)
            given = {f.name for f in fields if f.const is None}
            missing = {"joint", "address", "parameter"} & given - {*each.at}
            if missing and "all" not in command.name and kept:
                yield f"{command.name} {each.verb} the same for every {missing}"
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
    """Return the state that a command with ambiguous words is about; empty for other commands."""
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
    """Report commands whose effect differs from what their name and description say."""
    for command in edition.commands:
        effect = command.effect
        if effect is not None and effect.verb in ("sets", "does", "computes", "zeroes"):
            found = (
                (re.fullmatch(n, command.name), e) for n, d, e in EFFECTS if fits(command, n, d)
            )
            wanted = next((match.expand(effect) for match, effect in found if match), "")
            # No query of the myArm M and C reports free mode.
            if command.name == "power_on" and edition.name.startswith("myarm_"):
                wanted = "sets powered=True held=True"
            if wanted and not effect.by_role and in_words(effect) != wanted:
                yield f"{command.name} {in_words(effect)}, but its description says {wanted}"


# For these states, queries report another number of joints than the edition has, or setters accept
# fewer values. Their type is that of the setter's field; without a setter, that of each number that
# the query reports.
PART_OF_FIELD = {
    *("calibrated", "collision_threshold", "torque_compensation", "model_direction", "run_errors"),
    *("zero_encoders", "down_encoders"),
}
UNLIKE = {
    *PART_OF_FIELD,
    *("written_registers", "hand_enabled"),
    *("mercury_b1 servo_faults", "mercury_x1 servo_faults"),
    *("mercury_b1 servo_currents", "mercury_x1 servo_currents"),
}
# A type with this prefix numbers the joints, and has one more number that means all joints.
OR_ALL = "restored_"


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
            unlike = {name, f"{edition.name} {name}"} & UNLIKE
            if not unlike and not _alike(state.type, widest, left):
                yield f"{name} is unlike {field} of {command.name}"
    for name in PART_OF_FIELD & declared.keys():
        fields = [
            (each.type, command.safety != "query")
            for state, command, _, field in pairs
            if state == name
            for each in command.fields
            if each.name == field
        ]
        stored = [type for type, is_set in fields if is_set]
        reported = [part for type, _ in fields for _, part in type.parts]
        if declared[name].type not in (stored or reported):
            yield f"{name} has another type than the fields that set or report it"
    for command in edition.commands:
        effect = command.effect
        if effect is not None and effect.verb == "sets":
            given = {each.name: each.type.name for each in command.fields}
            at = [given[each].removeprefix(OR_ALL) for each in effect.at]
            for name, _ in effect.values if at else ():
                if name in declared and at != list(declared[name].each[: len(at)]):
                    yield f"{name} has other indices than {command.name}"


def speeds(edition: Edition) -> Iterator[str]:
    """Report motions, other than a gripper's, whose speed has another type than a speed."""
    for command in edition.commands:
        effect = command.effect
        types = {f.type.name for variant in command.requests for f in variant if f.name == "speed"}
        if effect and effect.verb == "moves" and effect.what != "gripper":
            for other in types - {"speed", "motion_speed"}:
                yield f"the speed of {command.name} is a {other}"


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
    """Report motions that ignore an argument, or use it differently from what its name says."""
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
                if ("rpy" in command.name) != (each.option("keeps") == "position"):
                    yield f"{command.name} keeps {each.option('keeps')}"
                part = "gripper" if "gripper" in command.name else each.what
                if part != each.what or (each.what == "gripper") != ("gripper" in command.name):
                    yield f"{command.name} moves {each.what}"


def openings(edition: Edition) -> Iterator[str]:
    """Report grippers that open or close to another percentage, or are held when released."""
    for command in edition.commands:
        for member, each in command.effect.cases if command.effect else ():
            wanted = {"OPEN": 100, "CLOSE": 0}.get(member)
            if each.what == "gripper" and each.option("to") not in (wanted, str(wanted)):
                yield f"{command.name} moves the gripper to {each.option('to')} for {member}"
            if member == "RELEASE" and each.values != (("gripper_held", False),):
                yield f"{command.name} holds the gripper that it releases"


def _alike(kept: Type | None, type: Type | None, left: list[Type | None]) -> bool:
    """Return whether a field has the type of a state, or a row of such values.

    ``left`` are the indices of the state that no argument chooses: the field has a value for each.
    The type of a text is None.
    """
    if not left or kept is None or type is None:
        return kept == type
    each = left[-1]
    bounds = each.bounds if isinstance(each, Quantity) else None
    if bounds is None or len(left) > 1:
        return False
    return [part for _, part in type.parts] == [kept] * int(bounds[1] - bounds[0] + 1)


RULES = (named, effects, states, speeds, arguments, openings)
