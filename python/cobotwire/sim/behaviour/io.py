"""Pins and the light. An output that was set is read back by the input of the same number."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import ArmState


@does("set_pin_mode")
def set_pin_mode(arm: ArmState, now: float, pin: int, mode: int) -> None:
    """Use a pin as input or output."""
    arm.pin_modes[pin] = mode


@does("set_digital_output")
def set_digital_output(arm: ArmState, now: float, pin: int, high: int) -> None:
    """Drive a pin of the Atom."""
    arm.pins[pin] = bool(high)


@does("get_digital_input")
def get_digital_input(arm: ArmState, now: float, pin: int) -> dict[str, Any]:
    """Read a pin of the Atom."""
    return {"high": arm.pins.get(pin, False)}


@does("set_pwm_output")
def set_pwm_output(arm: ArmState, now: float, channel: int, frequency: int, duty: int) -> None:
    """Put pulses on a pin of the Atom; no command reads them back."""
    arm.pulses[channel] = (frequency, duty)


@does("set_color")
def set_color(arm: ArmState, now: float, red: int, green: int, blue: int) -> None:
    """Set the light."""
    arm.colour = (red, green, blue)


@does("set_basic_output")
def set_basic_output(arm: ArmState, now: float, pin: int, high: int) -> None:
    """Drive a pin of the base."""
    arm.basic_pins[pin] = bool(high)


@does("get_basic_input")
def get_basic_input(arm: ArmState, now: float, pin: int) -> dict[str, Any]:
    """Read a pin of the base."""
    return {"high": arm.basic_pins.get(pin, False)}
