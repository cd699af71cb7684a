"""The trials, by what they send; importing them registers them, in the order of a run."""

from cobotwire.conformance.device.trials import (  # isort: skip  (the order of a run)
    queries,
    malformed,
    settings,
    effects,
    motion,
    agreement,
    alike,
)

__all__ = ["agreement", "alike", "effects", "malformed", "motion", "queries", "settings"]
