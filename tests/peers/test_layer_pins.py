"""The pins of a myBuddy's board: the maker's class and ours make the same calls of RPi.GPIO."""

from __future__ import annotations

from typing import Any

import pytest

from layer_comparison import layer_on
from pymycobot_classes import peer_on
from pymycobot_ports import RecordingPort, RecordingTransport
from recorded_pins import installed_pins

PINS = (*range(1, 17), "SCL0", "SDA0")
CALLS: list[tuple[str, tuple[Any, ...]]] = [
    ("set_gpio_init_mode", (0,)),
    *(("set_gpio_setup", (pin, index % 2)) for index, pin in enumerate(PINS)),
    ("set_gpio_output", (3, 1)),
    ("get_gpio_input", (16,)),
    ("set_gpio_pwm_start", (6, 50.0, 10.0)),
    ("set_gpio_pwm_change_freq", (25.0,)),
    ("set_gpio_pwm_change_dc", (75.0,)),
    ("set_gpio_pwm_stop", ()),
    ("set_gpio_clearup", (3,)),
]


def _called(who: Any, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    pins = installed_pins(monkeypatch)
    for method, arguments in CALLS:
        getattr(who, method)(*arguments)
    return pins.called


def test_pins_are_called_as_by_the_makers_class(monkeypatch: pytest.MonkeyPatch) -> None:
    theirs = _called(peer_on("MyBuddy", RecordingPort()), monkeypatch)
    mine = _called(layer_on("MyBuddy", RecordingTransport()), monkeypatch)
    assert mine == theirs
    assert len(mine) == len(CALLS) + 1


def test_wrong_use_of_pins_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    buddy = layer_on("MyBuddy", RecordingTransport())
    with pytest.raises(ValueError, match=r"call set_gpio_init_mode\(\) before"):
        buddy.set_gpio_output(1, 1)
    with pytest.raises(ValueError, match="mode is 1; allowed: 0"):
        buddy.set_gpio_init_mode()
    with pytest.raises(ValueError, match="pin is 17; allowed: "):
        buddy.base_io_to_gpio(17)
    with pytest.raises(ValueError, match=r"call set_gpio_pwm_start\(\) before"):
        buddy.set_gpio_pwm_stop()
    assert buddy.is_open()
    buddy.close()
    assert not buddy.is_open()
