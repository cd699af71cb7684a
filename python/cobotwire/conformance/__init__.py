"""Test whether a device, a client or a codec conforms to an edition, with evidence."""

from cobotwire.conformance.report import Cause, Exchange, Report, Result, Verdict
from cobotwire.conformance.suite import Group, Suite, TestCase

__all__ = ["Cause", "Exchange", "Group", "Report", "Result", "Suite", "TestCase", "Verdict"]
