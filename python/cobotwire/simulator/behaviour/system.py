"""Versions, errors and modes of newer firmware."""

from __future__ import annotations

from cobotwire.editions.mycobot280.enums import FreshMode, MoveMode
from cobotwire.editions.mycobot280.messages import (
    CheckAsyncOrSync,
    CheckAsyncOrSyncReply,
    ClearErrorInformation,
    GetBasicVersion,
    GetBasicVersionReply,
    GetErrorInformation,
    GetErrorInformationReply,
    GetFreshMode,
    GetFreshModeReply,
    GetModifyVersion,
    GetModifyVersionReply,
    GetMovementType,
    GetMovementTypeReply,
    GetRebootCount,
    GetRebootCountReply,
    GetSystemVersion,
    GetSystemVersionReply,
    GetTransponderMode,
    GetTransponderModeReply,
    SetMovementType,
    SetTransponderMode,
    SetTransponderModeReply,
    SetVisionMode,
)
from cobotwire.simulator.behaviour.registry import behaviour
from cobotwire.simulator.state import ArmState

# What the firmware of a 280 reports today; the kinematics notes are about firmware 6.5.
SYSTEM_VERSION = 6.5
BASIC_VERSION = 2.0
REVISION = 1


@behaviour(GetModifyVersion)
def get_modify_version(
    arm: ArmState, now: float, request: GetModifyVersion
) -> GetModifyVersionReply:
    """Reply with the firmware's revision."""
    return GetModifyVersionReply(revision=REVISION)


@behaviour(GetSystemVersion)
def get_system_version(
    arm: ArmState, now: float, request: GetSystemVersion
) -> GetSystemVersionReply:
    """Reply with the firmware's version."""
    return GetSystemVersionReply(version=SYSTEM_VERSION)


@behaviour(GetBasicVersion)
def get_basic_version(arm: ArmState, now: float, request: GetBasicVersion) -> GetBasicVersionReply:
    """Reply with the version of the base."""
    return GetBasicVersionReply(version=BASIC_VERSION)


@behaviour(CheckAsyncOrSync)
def check_async_or_sync(
    arm: ArmState, now: float, request: CheckAsyncOrSync
) -> CheckAsyncOrSyncReply:
    """Reply that a motion is acknowledged when it is received, not when it ends."""
    return CheckAsyncOrSyncReply(synchronous=False)


@behaviour(GetRebootCount)
def get_reboot_count(arm: ArmState, now: float, request: GetRebootCount) -> GetRebootCountReply:
    """Reply how often the controller has started: once at first, and after each panic."""
    return GetRebootCountReply(reboots=arm.starts)


@behaviour(GetErrorInformation)
def get_error_information(
    arm: ArmState, now: float, request: GetErrorInformation
) -> GetErrorInformationReply:
    """Reply with the last error; 0: there is none."""
    return GetErrorInformationReply(error=arm.settings.error)


@behaviour(ClearErrorInformation)
def clear_error_information(arm: ArmState, now: float, request: ClearErrorInformation) -> None:
    """Forget the last error."""
    arm.settings.error = 0


@behaviour(GetFreshMode)
def get_fresh_mode(arm: ArmState, now: float, request: GetFreshMode) -> GetFreshModeReply:
    """Reply whether targets are queued."""
    return GetFreshModeReply(mode=FreshMode(arm.fresh_mode))


@behaviour(SetMovementType)
def set_movement_type(arm: ArmState, now: float, request: SetMovementType) -> None:
    """Choose how the end moves to coordinates."""
    arm.settings.movement_type = request.mode


@behaviour(GetMovementType)
def get_movement_type(arm: ArmState, now: float, request: GetMovementType) -> GetMovementTypeReply:
    """Reply how the end moves to coordinates."""
    return GetMovementTypeReply(mode=MoveMode(arm.settings.movement_type))


@behaviour(SetVisionMode)
def set_vision_mode(arm: ArmState, now: float, request: SetVisionMode) -> None:
    """Set whether the end is kept from turning over."""
    arm.settings.vision = bool(request.vision)


@behaviour(SetTransponderMode)
def set_transponder_mode(
    arm: ArmState, now: float, request: SetTransponderMode
) -> SetTransponderModeReply:
    """Set whether frames are passed on."""
    arm.settings.transparent = bool(request.transparent)
    return SetTransponderModeReply(succeeded=True)


@behaviour(GetTransponderMode)
def get_transponder_mode(
    arm: ArmState, now: float, request: GetTransponderMode
) -> GetTransponderModeReply:
    """Reply whether frames are passed on."""
    return GetTransponderModeReply(transparent=arm.settings.transparent)
