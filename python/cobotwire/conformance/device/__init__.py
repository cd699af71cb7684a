"""Test whether a device conforms to an edition: test cases for its commands, over a transport."""

from cobotwire.conformance.device.connection import DeviceConnection
from cobotwire.conformance.device.options import RunOptions
from cobotwire.conformance.device.permissions import (
    ALL_PERMISSIONS,
    PERMISSIONS,
    Permissions,
)
from cobotwire.conformance.device.plan import Plan, Step
from cobotwire.conformance.device.requester import Timing
from cobotwire.conformance.device.started import ATTACH, StartedDevice, parse_command
from cobotwire.conformance.device.suite import SUITE
from cobotwire.conformance.device.tester import Tester
from cobotwire.conformance.workspace import parse_workspace, words

__all__ = [
    "ALL_PERMISSIONS",
    "ATTACH",
    "PERMISSIONS",
    "SUITE",
    "DeviceConnection",
    "Permissions",
    "Plan",
    "RunOptions",
    "StartedDevice",
    "Step",
    "Tester",
    "Timing",
    "parse_command",
    "parse_workspace",
    "words",
]
