"""The device tester: tests derived from an edition's table, run over a line."""

from cobotwire.conformance.device.asking import Waits
from cobotwire.conformance.device.catalogue import RULES, Rule
from cobotwire.conformance.device.leave import CLASSES, EVERYTHING, Leave, words, workspace_of
from cobotwire.conformance.device.line import Line
from cobotwire.conformance.device.tester import Step, Tester

__all__ = [
    "CLASSES",
    "EVERYTHING",
    "RULES",
    "Leave",
    "Line",
    "Rule",
    "Step",
    "Tester",
    "Waits",
    "words",
    "workspace_of",
]
