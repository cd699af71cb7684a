"""Registers of the servos: how they are read, and their backups."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.editions.mycobot280.enums import ServoDataMode
from cobotwire.simulator.behaviour.registry import Sized, behaviour
from cobotwire.simulator.state import ArmState


@behaviour(m.GetServoData)
def get_servo_data(arm: ArmState, now: float, request: m.GetServoData) -> Sized:
    """Reply with a servo register: its low byte, or with mode 1 always two bytes."""
    value = arm.kept["registers"].get((request.joint, request.register), 0)
    if request.mode == ServoDataMode.WORD:
        return Sized(m.GetServoDataReply(value=value), 2)
    return Sized(m.GetServoDataReply(value=value % 256), 1)


@behaviour(m.BackupServoParams)
def backup_servo_params(arm: ArmState, now: float, request: m.BackupServoParams) -> None:
    """Back up the registers of one servo or of all."""
    for servo in _servos(arm, request.servo):
        arm.backups[servo] = {
            register: value
            for (joint, register), value in arm.kept["registers"].items()
            if joint == servo
        }


@behaviour(m.RestoreServoParams)
def restore_servo_params(arm: ArmState, now: float, request: m.RestoreServoParams) -> None:
    """Restore the registers from the backup; without one, the factory values."""
    for servo in _servos(arm, request.servo):
        kept = {at: value for at, value in arm.kept["registers"].items() if at[0] != servo}
        saved = arm.backups.get(servo, dict(arm.servos.registers))
        arm.kept["registers"] = kept | {(servo, at): value for at, value in saved.items()}


def _servos(arm: ArmState, servo: int) -> range:
    # A number that no joint has means all servos.
    return range(servo, servo + 1) if servo <= arm.joints else range(1, arm.joints + 1)
