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
NO_COUNTERPART = {
    "gpio_init": "our clients drive no pins of this computer; use RPi.GPIO or gpiozero",
    "gpio_output": "our clients drive no pins of this computer; use RPi.GPIO or gpiozero",
    "open": "our clients open the port when they are created; create a new one",
}
RESULTS = {
    "listed": "our result is a number, not a list of one",
    "joined": "our result has one named tuple for each part, not one list of all numbers",
    "radians": "our result is not rounded to thousandths",
    "bit_numbers": "our result has the bytes as they come, not lists of bit numbers",
    "error_classes": "our result has the bytes as they come",
    "points": "our result has the numbers in one tuple; it is never -1",
    "words_of_text": "our result has both texts whole, not their first and last words",
}
NEVER_FAILED = (
    "a call that fails raises ReplyTimeout or ProtocolError here, so this comparison never finds a "
    "failure; catch the error"
)
TIMEOUT = "timeout was the time of one read of the port; ours limits the whole wait for a reply"
UNKNOWN = "{name} may be an arm, whose class is not known here; the call is left as it is"
