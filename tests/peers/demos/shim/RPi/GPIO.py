"""Stand in for the pins of a Raspberry Pi: outputs do nothing, inputs are 0."""

from typing import Any

BCM, BOARD, OUT, IN, HIGH, LOW = 11, 10, 0, 1, 1, 0


def _nothing(*arguments: Any, **options: Any) -> int:
    return 0


setmode = setwarnings = setup = output = input = cleanup = _nothing
