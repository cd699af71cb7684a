"""What a person must decide after a program was rewritten."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import libcst as cst

from cobotwire.pymycobot.migrate.calls import Call, LibraryClass


class Decision(NamedTuple):
    """A position in the original program, and what to decide there."""

    line: int
    column: int
    what: str

    def __str__(self) -> str:
        return f"{self.line}:{self.column}: {self.what}"


# Notes what to decide at a node of the program.
Decide = Callable[[cst.CSTNode, str], None]
# What the program must do differently, by the library's method.
_PINS = "our clients drive no pins of this computer; use RPi.GPIO or gpiozero"
NO_COUNTERPART = {
    **dict.fromkeys(["gpio_init", "gpio_output", "get_gpio_input", "base_io_to_gpio"], _PINS),
    **dict.fromkeys(["set_gpio_init_mode", "set_gpio_setup", "set_gpio_output"], _PINS),
    **dict.fromkeys(["set_gpio_pwm_start", "set_gpio_pwm_change_freq"], _PINS),
    **dict.fromkeys(["set_gpio_pwm_change_dc", "set_gpio_pwm_stop", "set_gpio_clearup"], _PINS),
    "set_iic_init": "our clients open no bus of this computer; use smbus2",
    "get_coord": "our get_coord gives tenths of a millimetre, or hundredths of a degree",
    "is_in_position": (
        "use is_in_position for an arm, is_waist_in_position or is_robot_in_position for the others"
    ),
    "open": "our clients open the port when they are created; create a new one",
}
_BITS = "our result has the error words as numbers, not lists of their set bits"
_UNITS = "our result is in the units of the reply, not in steps"
_FORM = "our result has the parts of the reply, not one list of them"
_BYTES = "our result has bytes, not a list of numbers"
RESULTS = {
    "ended": (
        "the library waits for the end of this motion, ours does not; if the program needs that, "
        "use move_angles or move_coords"
    ),
    **dict.fromkeys(["robot_status", "robot_status_of_450"], _BITS),
    **dict.fromkeys(["bit_numbers", "bits_from_the_highest"], _BITS),
    **dict.fromkeys(["in_hundredths", "in_thousandths", "listed_hundredths"], _UNITS),
    **dict.fromkeys(["calibrated", "calibrated_joints", "flat", "pairs", "quick_move_info"], _FORM),
    **dict.fromkeys(["bytes_listed", "numbers"], _BYTES),
    "tenths": "our result is ten times the library's",
    "hex_text": "our result is a number, not a text of hex digits",
    "signed": "our result has unsigned numbers",
    "solved": "if there is no solution, the library returns a text, and ours a tuple of angles",
    "one_speed": "if this is a list with a speed for each servo, pass it as our argument speeds",
    "listed": "our result is a number where the library's is a list of one",
    "joined": "our result has one named tuple for each part, not one list of all numbers",
    "radians": "our result is not rounded to thousandths",
    "servo_register": "our result is 255 where the library's is -1: the read failed",
    "error_classes": "our result has the bytes unchanged",
    "points": "our result has the numbers in one tuple; it is never -1",
    "words_of_text": "our result has both texts whole, not their first and last words",
}
NEVER_FAILED = (
    "a call that fails raises ReplyTimeout or ProtocolError here, so this test never finds a "
    "failure; catch the error"
)
NO_RESULT = (
    "{0} returns nothing here, but a result in the library; do not use the result: a call that "
    "fails raises an error"
)
PARTS = "our result is a named tuple of parts, not lists of numbers; use the parts by their names"
HIDDEN_NAME = "this needs Python's {0}, but the program uses that name for something else"
NOT_ACKNOWLEDGED = "; with ack_within=1.5, a call that the arm does not acknowledge raises one too"
ATTRIBUTE = "{0} is not called here, and only calls are rewritten; write `lambda: {0}()`"
ESCAPED = (
    "the arm is passed to code that is not read here, so its calls there are not rewritten; "
    "rewrite them there, or annotate the parameter with {0}"
)
INHERITS = (
    "{0} inherits from {1}; calls of its own methods are not rewritten: store an arm in an "
    "attribute instead of inheriting"
)
MIXED = (
    "{0} is not always an arm of one class, so the call is left as it is; give each arm a name of "
    "its own"
)
NOT_STATEMENT = "this import shares its line; write it on a line of its own, and run this again"
BY_TEXT = "{0} runs code that is not read here; if that uses the library, rewrite it by hand"
UTILITY = "cobotwire.pymycobot.utils has no {0}"
HOME = "go_home waits, and its pose and speed depend on its arguments; use move_angles"
OTHER_ROBOT = (
    "the class is {} here; if the port is that of an arm that is mounted on a body, write {} ({})"
)
SEVERAL = "{} stands for several classes; write the port and the speed as our classes take them"
TIMEOUT = "timeout was the time of one read of the port; ours limits the whole wait for a reply"
UNKNOWN = (
    "{name} may be an arm, whose class is not known here, so the call is left as it is; annotate it"
)
PARAMETER = (
    "{name} may be an arm, whose class is not known here, so its calls are left as they are; write "
    "`def {function}({name}: {kind})`, and run this again"
)
EITHER = "this may be the library's call or ours; the order of their arguments differs"
# Methods of the layer that no single call of our client replaces.
BY_HAND = {
    "power_on": "it waits for the motors; call power_on(), and then time.sleep(1)",
    "get_coords": "call get_coords() without angles, and angles_to_coords() with them",
    "set_servos_calibration": "call set_servo_calibration for each joint",
    "set_limit_switch": "it calls is_power_on() first, and decides whether later motions wait",
    "drag_teach_execute": "it calls is_drag_fifo_empty() first, and waits until the motion ends",
}


def why_left(kind: LibraryClass, method: str) -> str:
    """Return why a call is left as it is."""
    # A class that opens a socket would drive the pins of the robot's computer.
    local = method not in kind.absent or kind.opens == "serial"
    if local and method in NO_COUNTERPART:
        return NO_COUNTERPART[method]
    if not kind.has(method) or method.startswith("_"):
        why = kind.absent.get(method)
        return f"{kind.native} has no counterpart of {method}" + (f": {why}" if why else "")
    if kind.on_ports and method in kind.methods:
        return f"only {kind.on_ports[0]} has {method}; it is for an arm that is mounted on a body"
    what = BY_HAND.get(method, f"see cobotwire.pymycobot.{kind.name}.{method}")
    return f"no single call of ours does what the library's {method} does: {what}"


def why_other(call: Call) -> str:
    """Return how the result of our method differs from the library's."""
    if call.gives == "nothing":
        waits = call.by_hand or call.result == "done"
        return NO_RESULT.format(call.calls) + ("" if waits else NOT_ACKNOWLEDGED)
    return RESULTS.get(call.result, PARTS).format(call.calls)
