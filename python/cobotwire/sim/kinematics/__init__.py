"""Where the end is for given joints, and which joints put it where it shall be."""

from cobotwire.sim.kinematics.forward import coords_of, flange
from cobotwire.sim.kinematics.geometry import MYCOBOT_280, Geometry, Link, geometry_of
from cobotwire.sim.kinematics.inverse import nearest, prepare, solutions
from cobotwire.sim.kinematics.pose import Pose
from cobotwire.sim.kinematics.ticks import DEGREES_A_TICK

__all__ = [
    "DEGREES_A_TICK",
    "MYCOBOT_280",
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
