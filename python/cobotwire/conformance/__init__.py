"""Does this arm, this firmware, this client keep to the protocol? Answers with evidence."""

from cobotwire.conformance.report import Exchange, Report, Result, Verdict

__all__ = ["Exchange", "Report", "Result", "Verdict"]
