"""A stand-in for LeRobot's module of cameras; no robot gets a camera."""

from typing import Any


class CameraConfig:
    width: int
    height: int


def make_cameras_from_configs(camera_configs: dict[str, CameraConfig]) -> dict[str, Any]:
    return {}
