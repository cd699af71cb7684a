"""Forward and inverse kinematics: the flange's pose for joint angles, and angles for a pose."""

from cobotwire.kinematics.descent import Effort
from cobotwire.kinematics.forward import coords_of, flange
from cobotwire.kinematics.geometry import Geometry, Link, geometry_of
from cobotwire.kinematics.inverse import nearest
from cobotwire.kinematics.pose import Pose

__all__ = [
    "Effort",
    "Geometry",
    "Link",
    "Pose",
    "coords_of",
    "flange",
    "geometry_of",
    "nearest",
]
