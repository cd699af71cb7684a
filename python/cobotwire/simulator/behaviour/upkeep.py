"""The condition of the servos, and backups of their parameters."""

from __future__ import annotations

from cobotwire.editions.mycobot280.messages import (
    BackupServoParams,
    GetServoSpeeds,
    GetServoSpeedsReply,
    GetServoStatus,
    GetServoStatusReply,
    GetServoTemps,
    GetServoTempsReply,
    GetServoVoltages,
    GetServoVoltagesReply,
    RestoreServoParams,
    SetFourPiecesZero,
    SetFourPiecesZeroReply,
)
from cobotwire.simulator.behaviour.registry import behaviour, row
from cobotwire.simulator.state import SERVO_REGISTERS, ArmState

VOLTS = 12.0
DEGREES_CELSIUS = 30
# A request for this servo means all servos.
ALL_SERVOS = 254


@behaviour(GetServoSpeeds)
def get_servo_speeds(arm: ArmState, now: float, request: GetServoSpeeds) -> GetServoSpeedsReply:
    """Reply with the speed of each servo, in steps a second."""
    return GetServoSpeedsReply(speeds=row(arm.servo_speeds(now)))


@behaviour(GetServoStatus)
def get_servo_status(arm: ArmState, now: float, request: GetServoStatus) -> GetServoStatusReply:
    """Reply that no servo has a fault."""
    return GetServoStatusReply(faults=row((0,) * arm.joints))


@behaviour(GetServoVoltages)
def get_servo_voltages(
    arm: ArmState, now: float, request: GetServoVoltages
) -> GetServoVoltagesReply:
    """Reply with the supply voltage of each servo."""
    return GetServoVoltagesReply(voltages=row((VOLTS if arm.powered else 0.0,) * arm.joints))


@behaviour(GetServoTemps)
def get_servo_temps(arm: ArmState, now: float, request: GetServoTemps) -> GetServoTempsReply:
    """Reply with the temperature of each servo."""
    return GetServoTempsReply(temperatures=row((DEGREES_CELSIUS,) * arm.joints))


@behaviour(BackupServoParams)
def backup_servo_params(arm: ArmState, now: float, request: BackupServoParams) -> None:
    """Back up the registers of one servo or of all."""
    for index in _servos(arm, request.servo):
        arm.settings.backups[index] = dict(arm.registers[index])


@behaviour(RestoreServoParams)
def restore_servo_params(arm: ArmState, now: float, request: RestoreServoParams) -> None:
    """Restore the registers from the backup; without one, the factory values."""
    for index in _servos(arm, request.servo):
        arm.registers[index] = dict(arm.settings.backups.get(index, SERVO_REGISTERS))


@behaviour(SetFourPiecesZero)
def set_four_pieces_zero(
    arm: ArmState, now: float, request: SetFourPiecesZero
) -> SetFourPiecesZeroReply:
    """Report success. The four-piece motor is not a joint, and no command reads it."""
    return SetFourPiecesZeroReply(succeeded=True)


def _servos(arm: ArmState, servo: int) -> range:
    return range(arm.joints) if servo == ALL_SERVOS else range(servo - 1, servo)
