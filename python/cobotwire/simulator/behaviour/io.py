"""Pins and the light. An output is read back by the input of the same number."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour, query
from cobotwire.simulator.state import ArmState


@behaviour(m.SetPinMode)
def set_pin_mode(arm: ArmState, now: float, request: m.SetPinMode) -> None:
    """Use a pin as input or output."""
    arm.pin_modes[request.pin] = request.mode


@behaviour(m.SetDigitalOutput)
def set_digital_output(arm: ArmState, now: float, request: m.SetDigitalOutput) -> None:
    """Set a pin of the Atom."""
    arm.pins[request.pin] = bool(request.high)


query(m.GetDigitalInput, lambda arm, now, request: arm.pins.get(request.pin, False))


@behaviour(m.SetPwmOutput)
def set_pwm_output(arm: ArmState, now: float, request: m.SetPwmOutput) -> None:
    """Put pulses on a pin of the Atom; no command reads them back."""
    arm.pulses[request.channel] = (request.frequency, request.duty)


@behaviour(m.SetColor)
def set_color(arm: ArmState, now: float, request: m.SetColor) -> None:
    """Set the light."""
    arm.colour = (request.red, request.green, request.blue)


@behaviour(m.SetBasicOutput)
def set_basic_output(arm: ArmState, now: float, request: m.SetBasicOutput) -> None:
    """Set a pin of the base."""
    arm.basic_pins[request.pin] = bool(request.high)


query(m.GetBasicInput, lambda arm, now, request: arm.basic_pins.get(request.pin, False))
