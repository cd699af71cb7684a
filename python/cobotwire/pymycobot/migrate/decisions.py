"""What a person must decide after a program was rewritten."""

from __future__ import annotations

from typing import NamedTuple


class Decision(NamedTuple):
    """A place of the program as it was, and what to decide there."""

    line: int
    column: int
    what: str

    def __str__(self) -> str:
        return f"{self.line}:{self.column}: {self.what}"


# By the library's method: what the program must do otherwise.
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
_BITS = "our result has the error words as they come, not lists of bit numbers"
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
    "signed": "our result has no sign",
    "solved": "our result is a row of angles where the library's is a text: there is no solution",
    "one_speed": "if this speed is a row with a number for each servo, call our argument speeds",
    "listed": "our result is a number where the library's is a list of one",
    "joined": "our result has one named tuple for each part, not one list of all numbers",
    "radians": "our result is not rounded to thousandths",
    "servo_register": "our result is 255 where the library's is -1: the read failed",
    "error_classes": "our result has the bytes as they come",
    "points": "our result has the numbers in one tuple; it is never -1",
    "words_of_text": "our result has both texts whole, not their first and last words",
}
NEVER_FAILED = (
    "a call that fails raises ReplyTimeout or ProtocolError here, so this comparison never finds a "
    "failure; catch the error"
)
HOME = "go_home waits, and its pose and speed depend on its arguments; use move_angles"
OTHER_ROBOT = "the class is {} here; if the port is that of an arm on a body, write {} ({})"
SEVERAL = "{} stands for several classes; write the port and the speed as our classes take them"
TIMEOUT = "timeout was the time of one read of the port; ours limits the whole wait for a reply"
UNKNOWN = "{name} may be an arm, whose class is not known here; the call is left as it is"
