"""The condition of the servos, and backups of their parameters."""

from __future__ import annotations

from cobotwire.editions.mycobot280 import messages as m
from cobotwire.simulator.behaviour.registry import behaviour, query, row
from cobotwire.simulator.state import ArmState

# In encoder steps a second.
query(m.GetServoSpeeds, lambda arm, now, request: row(arm.servo_speeds(now)))
# No servo has a fault.
query(m.GetServoStatus, lambda arm, now, request: row((0,) * arm.joints))
query(
    m.GetServoVoltages,
    lambda arm, now, request: row(
        (arm.servos.voltage or 0.0 if arm.powered else 0.0,) * arm.joints
    ),
)
query(
    m.GetServoTemps,
    lambda arm, now, request: row((round(arm.servos.temperature or 0),) * arm.joints),
)


@behaviour(m.BackupServoParams)
def backup_servo_params(arm: ArmState, now: float, request: m.BackupServoParams) -> None:
    """Back up the registers of one servo or of all."""
    for index in _servos(arm, request.servo):
        arm.backups[index] = dict(arm.registers[index])


@behaviour(m.RestoreServoParams)
def restore_servo_params(arm: ArmState, now: float, request: m.RestoreServoParams) -> None:
    """Restore the registers from the backup; without one, the factory values."""
    for index in _servos(arm, request.servo):
        arm.registers[index] = dict(arm.backups.get(index, arm.servos.registers))


@behaviour(m.SetFourPiecesZero)
def set_four_pieces_zero(
    arm: ArmState, now: float, request: m.SetFourPiecesZero
) -> m.SetFourPiecesZeroReply:
    """Succeed without effect: the four-piece motor is not a joint, and no command reads it."""
    arm.remarks.append("no effect: the simulated arm has no four-piece motor")
    return m.SetFourPiecesZeroReply(succeeded=True)


def _servos(arm: ArmState, servo: int) -> range:
    # A number that no joint has means all servos.
    return range(servo - 1, servo) if servo <= arm.joints else range(arm.joints)
