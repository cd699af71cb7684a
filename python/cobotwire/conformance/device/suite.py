"""The test cases for devices, in the order of a run."""

from __future__ import annotations

from cobotwire.conformance.device.groups import (
    agreement,
    at_rest,
    calibration,
    changes,
    coupling,
    declared,
    forbidden_settings,
    gripping,
    holding,
    jogging,
    limits_kept,
    malformed,
    motion,
    ordering,
    pausing,
    queries,
    queueing,
    references,
    settings,
    speeds,
    switching,
)
from cobotwire.conformance.device.probe import Body
from cobotwire.conformance.suite import Suite

SUITE: Suite[Body] = Suite(
    "device",
    (
        queries.QUERIES,
        declared.DECLARED_ABSENT,
        at_rest.GEOMETRIES,
        at_rest.REACHED_AT_REST,
        at_rest.JOINT_LIMITS,
        malformed.DAMAGED,
        malformed.FORBIDDEN,
        malformed.CROWDED,
        ordering.ORDERED,
        malformed.UNKNOWN_IDS,
        settings.SETTINGS,
        forbidden_settings.FORBIDDEN_SETTINGS,
        coupling.COUPLING,
        references.REFERENCES,
        switching.LIGHTS,
        motion.POSES,
        motion.JOINTS,
        motion.REPLAYS,
        motion.STOPPING,
        pausing.PAUSING,
        speeds.SPEEDS,
        limits_kept.LIMITS_KEPT,
        # After the motions, because unread commands leave the gripper in another state.
        switching.SWITCHES,
        switching.UNREAD,
        holding.HOLDING,
        jogging.STEPS,
        jogging.JOGS,
        jogging.COORDINATES,
        gripping.GRIPPER_MOVES,
        gripping.GRIPPER_OPENS,
        queueing.NEXT_TARGET,
        agreement.AGREEMENT,
        agreement.CALCULATION,
        calibration.CALIBRATION,
        # Last, because they compare all acknowledgements of the run.
        changes.ALL_ACKNOWLEDGED,
        declared.DECLARED_FACTS,
    ),
)
