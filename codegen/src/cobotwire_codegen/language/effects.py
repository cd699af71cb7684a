"""What a command does: the state of an edition, and the effects of commands on it."""

from __future__ import annotations

from cobotwire_codegen.language.json_schema import either
from cobotwire_codegen.language.names import CASE, LOWER
from cobotwire_codegen.language.records import Choice, Named, Part, Record, optional, required
from cobotwire_codegen.language.shapes import Anything, Known, Name, Names, Text, Word
from cobotwire_codegen.language.words import CONTROLS, MOVED, ZEROED

_TYPE = Known("type_name", "the name of a type")
_PLAIN = {"type": ["number", "string", "boolean", "array"]}
_STATES = either(
    "object", {"additionalProperties": {"type": "string"}, "minProperties": 1}, {"type": "string"}
)
_AT = "The arguments that choose one of a state's values, if the state has a value for each index."


class State(Record):
    """One item of the state of an arm. The key in `state` is its name."""

    type = optional(_TYPE, "The type of its value. Left out: a text.")
    each = optional(
        Names(LOWER),
        "The type of the index, or a list of types: there is a value for each index. `joint` "
        "stands for each joint of the arm.",
    )
    start = optional(
        Anything("a value of the type, as a vector states it", _PLAIN),
        "The value with which a simulated arm starts, for every index. Left out: zero, false, the "
        "first member, or an empty text.",
    )
    EXAMPLE = "{type: speed, each: joint, start: 50}"


class _Effect(Record):
    assumed = optional(
        Text(),
        "Why no source states this effect. A simulated arm has it and the reference describes it, "
        "but testers do not test it.",
    )


class _AtIndex(_Effect):
    at = optional(Names(LOWER), _AT)


class Reports(_AtIndex):
    """A query reports state."""

    reports = required(
        Anything("a state, or a mapping from fields of the reply to states", _STATES),
        "The state that the reply has, or a mapping from its fields to states. Without `at`, a "
        "state with a value for each joint is reported as a value type.",
    )
    EXAMPLE = "{reports: fresh_mode}"


class Stores(_AtIndex):
    """A command stores its arguments."""

    stores = required(
        Anything("a state, or a mapping from arguments to states", _STATES),
        "The state that has the argument's value afterwards, or a mapping from arguments to "
        "states. Without `at`, a value type gives each joint its value.",
    )
    EXAMPLE = "{stores: joint_minimum, at: joint}"


class Sets(_AtIndex):
    """A command gives state a fixed value."""

    sets = required(
        Named(Anything("a value of the state", _PLAIN), LOWER, ("empty-list", "name a state")),
        "Each state with its value afterwards. Without `at`, every index has it.",
    )
    EXAMPLE = "{sets: {powered: false}}"


class Moves(_AtIndex):
    """A command moves a part of the arm."""

    moves = required(Word(MOVED, MOVED.values()), "What moves.")
    to = optional(
        Anything("an argument, or a number", {"type": ["string", "number"]}),
        "The argument with the target, in degrees, radians, ticks, millimetres or percent; or a "
        "fixed target.",
    )
    by = optional(Name(LOWER), "The argument with the distance from the present position.")
    until = optional(Word(("limit",)), "The motion continues until it is stopped, or to a limit.")
    about = optional(Name(LOWER), "The argument that names the axis.")
    keeps = optional(Word(("position",)), "What does not move: the end of the arm turns in place.")
    direction = optional(Name(LOWER), "The argument with the direction.")
    speed = optional(Name(LOWER), "The argument with the speed, in percent.")
    EXCLUSIVE = (("to", "by"), ("to", "until"), ("by", "until"))
    EXAMPLE = "{moves: joint, at: joint, until: limit, direction: direction, speed: speed}"


class Zeroes(_AtIndex):
    """The present position of a part becomes its zero."""

    zeroes = required(Word(ZEROED, ZEROED.values()), "Which part.")
    EXAMPLE = "{zeroes: joint, at: joint}"


class Does(_AtIndex):
    """A command controls the motion under way."""

    does = required(Word(CONTROLS, CONTROLS.values()), "What happens to the motion.")
    EXAMPLE = "{does: pause}"


class Lists(_Effect):
    """A command works on a list of values; each value has the state's type."""

    list = required(Name(LOWER), "The state that is the list.")
    append = optional(Name(LOWER), "The argument that is added at the end.")
    take = optional(
        Word(("first",)), "The reply has the first value, which is removed from the list."
    )
    empty = optional(Word(("zeros",)), "What `take` reports if the list is empty.")
    clear = optional(Word(("all",)), "The list becomes empty.")
    report = optional(
        Word(("count", "empty")),
        "The reply states how many values there are, or if there are any.",
    )
    EXCLUSIVE = (("append", "take"), ("append", "clear"), ("append", "report"), ("take", "report"))
    EXAMPLE = "{list: points, take: first, empty: zeros}"


class Computes(_Effect):
    """A query computes a value from its arguments; nothing changes."""

    computes = required(Word(("coords", "angles")), "What the reply has.")
    from_ = required(Name(LOWER), "The argument that it is computed from.")
    near = optional(Name(LOWER), "The argument with angles; the solution is near to them.")
    EXAMPLE = "{computes: coords, from: angles}"


class Unknown(Record):
    """No source says what a command does."""

    unknown = required(Text(), "What is not known.")
    EXAMPLE = "{unknown: No source says how the arm moves.}"


class Python(_Effect):
    """The effect of a command is implemented in code: the simulator has a function for it."""

    python = required(Text(), "What the command does.")
    EXAMPLE = "{python: Repeats the recorded motion.}"


EFFECT = Choice(
    "effect",
    {
        "reports": Reports,
        "stores": Stores,
        "sets": Sets,
        "moves": Moves,
        "zeroes": Zeroes,
        "does": Does,
        "list": Lists,
        "computes": Computes,
        "unknown": Unknown,
        "python": Python,
    },
)


class ByCase(Record):
    """An effect that depends on an argument."""

    selector = required(Name(LOWER), "The argument that decides.")
    cases = required(
        Named(EFFECT, CASE, ("empty-list", "state the effect of a value")),
        "The effect for each value: a member's name or a number.",
    )
    EXAMPLE = """\
selector: state
cases:
  OPEN: {moves: gripper, to: 100, speed: speed}
  CLOSE: {moves: gripper, to: 0, speed: speed}
"""


ANY_EFFECT = Choice("any_effect", {"selector": ByCase, **EFFECT.chosen})
ANY_EFFECT_PART = Part(ANY_EFFECT)
