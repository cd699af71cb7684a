"""Forward and inverse kinematics: the end's pose for joint angles, and angles for a pose."""

from cobotwire.simulator.kinematics.descent import Effort
from cobotwire.simulator.kinematics.forward import coords_of, flange
from cobotwire.simulator.kinematics.geometry import Geometry, Link, geometry_of
from cobotwire.simulator.kinematics.inverse import nearest
from cobotwire.simulator.kinematics.pose import Pose

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
