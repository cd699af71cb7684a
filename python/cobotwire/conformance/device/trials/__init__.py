"""The trials, by what they send; importing them registers them, in the order of a run."""

from cobotwire.conformance.device.trials import (  # isort: skip  (the order of a run)
    queries,
    malformed,
    settings,
    effects,
    holding,
    motion,
    coordinates,
    jogging,
    gripping,
    queueing,
    agreement,
    calibrating,
    alike,
)

__all__ = [
    "agreement",
    "alike",
    "calibrating",
    "coordinates",
    "effects",
    "gripping",
    "holding",
    "jogging",
    "malformed",
    "motion",
    "queries",
    "queueing",
    "settings",
]
