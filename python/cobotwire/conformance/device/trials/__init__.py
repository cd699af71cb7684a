"""The trials, by what they send; importing them registers them, in the order of a run."""

from cobotwire.conformance.device.trials import queries, malformed, settings  # isort: skip

__all__ = ["malformed", "queries", "settings"]
