"""States facts of the arm by pairs of angles and coordinates that a real arm reported."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction

import numpy as np
from scipy.spatial.transform import Rotation

from cobotwire_codegen.model import Edition, Geometry, Quantity

# Angles in degrees, and the coordinates that the arm reported at them (firmware 6.5 of the 280).
PAIRS = (
    (
        (88.06, -138.33, 150.38, -151.96, 104.15, -13.71),
        (21.1, 108.9, 94.2, 75.19, 51.98, -114.61),
    ),
    ((95.18, -0.61, -0.61, -0.61, 88.85, -1.31), (15.3, 7.9, 410.7, -90.03, 0.52, 94.04)),
)
MILLIMETRES, DEGREES = 0.3, 0.1
CALIBRATED = 2048
# The document's chart of registers (lines 1280 to 1291): address, range, initial value.
CHART = ("20 0-254 0", "21 0-254 10", "22 0-254 0", "23 0-254 1", "24 0-1000 0")
# The maker's product parameters of the 280 (elephantrobotics/mycobot_docs, commit bd8e1aaf).
POWER_INPUT = "12V, 5A"
ARM = "mycobot"  # and its deltas that state no geometry of their own


def geometry(edition: Edition) -> Iterator[str]:
    """Report links that put the end elsewhere than the arm reported, or no links at all."""
    if edition.name not in (ARM, "mycobot280"):
        return
    if edition.robot.geometry is None:
        yield "the geometry of the arm is known, but the edition does not state it"
        return
    for angles, (x, y, z, *turns) in PAIRS:
        place, turned = _end(edition.robot.geometry, angles)
        apart = float(np.abs(place - np.array([x, y, z])).max())
        reported = Rotation.from_euler("xyz", turns, degrees=True)
        off = float(np.degrees((turned.inv() * reported).magnitude()))
        if apart > MILLIMETRES or off > DEGREES:
            yield f"the end is {apart:.1f} mm and {off:.1f} degrees from where the arm reported it"


def _end(geometry: Geometry, angles: tuple[float, ...]) -> tuple[np.ndarray, Rotation]:
    place, turned = np.zeros(3), Rotation.identity()
    for angle, link in zip(angles, geometry.links):
        turned = turned * Rotation.from_euler("z", angle + float(link.offset), degrees=True)
        place = place + turned.apply([float(link.a), 0, float(link.d)])
        turned = turned * Rotation.from_euler("x", float(link.alpha), degrees=True)
    return place, turned


def motion(edition: Edition) -> Iterator[str]:
    """Report an edition without a motion, or whose speed at 100 percent is not its fastest motion.

    The notes on kinematics say that a joint turns 1.5 degrees per second for each percent.
    """
    if edition.name not in (ARM, "mycobot280"):
        return
    if edition.robot.motion is None:
        yield "the edition of a real arm does not state how it moves"
    elif edition.robot.motion.speed * 100 != edition.robot.motion.fastest:
        yield "the speed at 100 percent differs from the fastest motion"


def encoders(edition: Edition) -> Iterator[str]:
    """Report encoders with no tick at a recorded angle, or with another zero than the maker's.

    The maker's documentation of the calibration says that the present position becomes 2048.
    """
    if edition.name not in (ARM, "mycobot280"):
        return
    stated = edition.robot.encoders
    if stated is None or not stated.signs:
        yield "the encoders of the arm are known, but the edition does not state them"
        return
    for angle in (angle for angles, _ in PAIRS for angle in angles):
        tick = round(angle * stated.ticks / 360)
        if int(tick * 36000 / stated.ticks) != round(angle * 100):
            yield f"{angle} is on no tick of {stated.ticks} in a turn"
    if stated.zero != CALIBRATED:
        yield f"the encoder reads {stated.zero} at 0 degrees; the maker says {CALIBRATED}"
    # Positions 0 to 4096 are -180 to 180 degrees.
    if stated.highest != stated.ticks:
        yield f"the highest reading is {stated.highest}, not that of half a turn from zero"


def joint_limits(edition: Edition) -> Iterator[str]:
    """Report joint limits that differ from the largest angle in the document's examples."""
    if edition.name != ARM:
        return
    sent = [
        value
        for vector in edition.vectors
        for name, value in vector.values
        if vector.example and name == "angle" and isinstance(value, int)
    ]
    if set(edition.robot.joint_limits) != {(Fraction(-max(sent)), Fraction(max(sent)))}:
        yield f"the joint limits differ from ±{max(sent)} degrees, the largest angle in examples"
    if len(edition.robot.joint_limits) != edition.joints:
        yield "the edition does not state limits for each joint"


# Their simulated arms have no geometry that could reject a motion.
SILENT = ("myarm300", "pro400", "pro450", "pro630")


def error_codes(edition: Edition) -> Iterator[str]:
    """Report error codes whose meaning differs from that in the explained error register."""
    meanings = [
        (low, high, text)
        for type in edition.types
        if isinstance(type, Quantity)
        for low, high, text in type.meanings
    ]
    codes = edition.robot.error_codes
    if codes is None:
        if any("joint" in text for _, _, text in meanings) and edition.name not in SILENT:
            yield "the error codes are explained, but the simulated arm reports none"
        return
    wanted = {
        r"joint .* limit": [*codes.joint_limits],
        r"the motion was stopped$": [codes.stopped],
        r".* no power": [codes.no_power],
        r"(.* )?no (inverse )?solution": [codes.no_solution],
        r".*straight line": [codes.no_straight_line],
    }
    for pattern, numbers in wanted.items():
        explained = [(a, b) for a, b, text in meanings if re.match(pattern, text)]
        if numbers == [0] and not explained:  # the register of the 280 has no such number
            continue
        if not explained:
            yield f"{numbers} are not explained as {pattern}"
            continue
        low, high = explained[0]
        if numbers != [*range(low, high + 1)][: len(numbers)]:
            yield f"{numbers} differ from {low}..{high}, which are explained as {pattern}"


def servos(edition: Edition) -> Iterator[str]:
    """Report servos that differ from the document's chart, or from the arm's power input."""
    if edition.name not in (ARM, "mycobot280"):
        return
    chart = {int(row.split()[0]): int(row.split()[-1]) for row in CHART}
    stated = edition.robot.servos
    if stated is None or dict(stated.registers) != chart:
        yield f"the registers differ from the document's chart: {chart}"
    for state in edition.states:
        if state.name == "servo_voltages" and f"{state.start}V" != POWER_INPUT.partition(",")[0]:
            yield f"the servos report {state.start} V, but the power input is {POWER_INPUT}"


def gripper(edition: Edition) -> Iterator[str]:
    """Report a gripper with another zero than the calibrated one, or not one tick per percent."""
    if edition.name not in (ARM, "mycobot280"):
        return
    stated = edition.robot.gripper
    if stated is None or (stated.closed, stated.open) != (CALIBRATED, CALIBRATED + 100):
        yield (
            f"the gripper must read {CALIBRATED} when closed, and one tick more per percent; "
            f"the edition states {stated}"
        )


def account(edition: Edition) -> Iterator[str]:
    """Report another Wi-Fi account than an example of the reply shows."""
    if edition.name not in (ARM, "mycobot280"):
        return
    shown = {dict(vector.values)["ssid"] for vector in edition.vectors if vector.text}
    stated = {state.start for state in edition.states if state.name == "ssid"}
    if not shown & stated:
        yield f"the edition states the Wi-Fi account {stated}; the examples show {shown}"


RULES = (geometry, motion, encoders, joint_limits, error_codes, servos, gripper, account)
