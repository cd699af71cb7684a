"""Draw arguments with scaled numbers that pymycobot's truncation does not change."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

# Inside the limits of every class compared.
_LOWEST = (-160, -130, -145, -140, -150, -175)
_HIGHEST = (160, 130, 145, 140, 150, 175)


def _hundredths(lowest: float, highest: float) -> st.SearchStrategy[float]:
    steps = st.integers(round(lowest * 100), round(highest * 100))
    return steps.filter(lambda step: int(step / 100 * 100) == step).map(lambda step: step / 100)


def _tenths(lowest: float, highest: float) -> st.SearchStrategy[float]:
    # Truncation changes no tenth: (n / 10) * 10 is n again in IEEE doubles.
    return st.integers(round(lowest * 10), round(highest * 10)).map(lambda step: step / 10)


_ROTATION = _hundredths(-180, 180)
_SPEED = st.integers(1, 100)
_AXES = (_tenths(-281.4, 281.4), _tenths(-281.4, 281.4), _tenths(-69.9, 412.6)) + (_ROTATION,) * 3
_COORDS = st.tuples(*_AXES).map(list)
_ANGLES = st.tuples(*(_hundredths(low, high) for low, high in zip(_LOWEST, _HIGHEST))).map(list)

# Joints up to the fourth, which is the palletizer's last.
_ONE_ANGLE = st.one_of(
    [
        st.tuples(st.just(joint), _hundredths(_LOWEST[joint - 1], _HIGHEST[joint - 1]), _SPEED)
        for joint in (1, 2, 3, 4)
    ]
)
_ONE_COORD = st.one_of([st.tuples(st.just(axis), _AXES[axis - 1], _SPEED) for axis in (1, 2, 3, 4)])

BY_NAME: dict[str, st.SearchStrategy[tuple[Any, ...]]] = {
    "send_angle": _ONE_ANGLE,
    "send_angles": st.tuples(_ANGLES, _SPEED),
    "send_coord": _ONE_COORD,
    "send_coords": st.tuples(_COORDS, _SPEED, st.sampled_from((0, 1))),
    "is_in_position": st.one_of(st.tuples(_ANGLES, st.just(0)), st.tuples(_COORDS, st.just(1))),
    "jog_absolute": _ONE_ANGLE,
    "jog_increment": st.tuples(st.integers(1, 4), _hundredths(-325.35, 327.67), _SPEED),
}
