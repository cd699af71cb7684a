"""Examine and monitor an arm and the traffic of its port."""

from cobotwire.inspect.advice import Problem
from cobotwire.inspect.doctor import Doctor, Report, RoundTrip
from cobotwire.inspect.monitor import Monitor, Observation

__all__ = ["Doctor", "Monitor", "Observation", "Problem", "Report", "RoundTrip"]
