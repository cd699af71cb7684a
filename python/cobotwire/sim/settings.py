"""What newer firmware remembers beside motion: modes, currents, recordings, backups."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass
class Settings:
    """Plain memory: what was set is read back."""

    movement_type: int = 0
    vision: bool = False
    transparent: bool = False
    gripper_torque: int = 300
    gripper_current: int = 100
    error: int = 0
    recording: bool = False
    recorded: list[tuple[tuple[int, ...], tuple[int, ...]]] = field(default_factory=list)
    played: int = 0
    backups: dict[int, dict[int, int]] = field(default_factory=dict)
