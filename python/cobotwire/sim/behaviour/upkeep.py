"""How the servos are, and their parameters kept safe."""

from __future__ import annotations

from typing import Any

from cobotwire.sim.behaviour.registry import does
from cobotwire.sim.state import SERVO_REGISTERS, ArmState

VOLTS = 12.0
DEGREES_CELSIUS = 30
# A request for this servo means all of them.
ALL_SERVOS = 254


@does("get_servo_speeds")
def get_servo_speeds(arm: ArmState, now: float) -> dict[str, Any]:
    """How fast each servo turns, in steps a second."""
    return {"speeds": arm.servo_speeds(now)}


@does("get_servo_status")
def get_servo_status(arm: ArmState, now: float) -> dict[str, Any]:
    """The faults of each servo: these servos have none."""
    return {"faults": (0,) * arm.joints}


@does("get_servo_voltages")
def get_servo_voltages(arm: ArmState, now: float) -> dict[str, Any]:
    """What each servo is fed with."""
    return {"voltages": (VOLTS if arm.powered else 0.0,) * arm.joints}


@does("get_servo_temps")
def get_servo_temps(arm: ArmState, now: float) -> dict[str, Any]:
    """How warm each servo is."""
    return {"temperatures": (DEGREES_CELSIUS,) * arm.joints}


@does("backup_servo_params")
def backup_servo_params(arm: ArmState, now: float, servo: int) -> None:
    """Keep the registers of a servo, or of all."""
    for index in _servos(arm, servo):
        arm.settings.backups[index] = dict(arm.registers[index])


@does("restore_servo_params")
def restore_servo_params(arm: ArmState, now: float, servo: int) -> None:
    """Bring the kept registers back; without a backup, those of the factory."""
    for index in _servos(arm, servo):
        arm.registers[index] = dict(arm.settings.backups.get(index, SERVO_REGISTERS))


@does("set_four_pieces_zero")
def set_four_pieces_zero(arm: ArmState, now: float) -> dict[str, Any]:
    """The four-piece motor is no joint, and tells nothing: its zero is taken, and that is all."""
    return {"succeeded": True}


def _servos(arm: ArmState, servo: int) -> range:
    return range(arm.joints) if servo == ALL_SERVOS else range(servo - 1, servo)
