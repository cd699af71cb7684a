"""Forward and inverse kinematics: the end's pose for joint angles, and angles for a pose."""

from cobotwire.simulator.kinematics.forward import coords_of, flange
from cobotwire.simulator.kinematics.geometry import Geometry, Link, geometry_of
from cobotwire.simulator.kinematics.inverse import nearest, prepare, solutions
from cobotwire.simulator.kinematics.pose import Pose
from cobotwire.simulator.kinematics.ticks import DEGREES_PER_TICK

__all__ = [
    "DEGREES_PER_TICK",
    "Geometry",
    "Link",
    "Pose",
    "coords_of",
    "flange",
    "geometry_of",
    "nearest",
    "prepare",
    "solutions",
]
