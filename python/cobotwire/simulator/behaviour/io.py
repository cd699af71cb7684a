"""Pins and the light. An output is read back by the input of the same number."""

from __future__ import annotations

from cobotwire.editions.mycobot280.messages import (
    GetBasicInput,
    GetBasicInputReply,
    GetDigitalInput,
    GetDigitalInputReply,
    SetBasicOutput,
    SetColor,
    SetDigitalOutput,
    SetPinMode,
    SetPwmOutput,
)
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.state import ArmState


@behaviour(SetPinMode)
def set_pin_mode(arm: ArmState, now: float, request: SetPinMode) -> None:
    """Use a pin as input or output."""
    arm.pin_modes[request.pin] = request.mode


@behaviour(SetDigitalOutput)
def set_digital_output(arm: ArmState, now: float, request: SetDigitalOutput) -> None:
    """Set a pin of the Atom."""
    arm.pins[request.pin] = bool(request.high)


@behaviour(GetDigitalInput)
def get_digital_input(arm: ArmState, now: float, request: GetDigitalInput) -> GetDigitalInputReply:
    """Reply with the level of a pin of the Atom."""
    return GetDigitalInputReply(high=arm.pins.get(request.pin, False))


@behaviour(SetPwmOutput)
def set_pwm_output(arm: ArmState, now: float, request: SetPwmOutput) -> None:
    """Put pulses on a pin of the Atom; no command reads them back."""
    arm.pulses[request.channel] = (request.frequency, request.duty)


@behaviour(SetColor)
def set_color(arm: ArmState, now: float, request: SetColor) -> None:
    """Set the light."""
    arm.colour = (request.red, request.green, request.blue)


@behaviour(SetBasicOutput)
def set_basic_output(arm: ArmState, now: float, request: SetBasicOutput) -> None:
    """Set a pin of the base."""
    arm.basic_pins[request.pin] = bool(request.high)


@behaviour(GetBasicInput)
def get_basic_input(arm: ArmState, now: float, request: GetBasicInput) -> GetBasicInputReply:
    """Reply with the level of a pin of the base."""
    return GetBasicInputReply(high=arm.basic_pins.get(request.pin, False))
