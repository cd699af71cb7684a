"""What a simulated arm remembers."""

from __future__ import annotations

from dataclasses import dataclass, field

from cobotwire.sim.axes import Axes
from cobotwire.sim.settings import Settings

# shared facts of the 280: see the protocol notes on kinematics
DEGREES_A_SECOND = 1.5
MILLIMETRES_A_SECOND = 3.0
OPENING_A_SECOND = 1.5
TICKS_A_TURN = 4096
ZERO_TICK = 2048
ENCODER_SIGNS = (-1, -1, 1, -1, -1, -1)
# How far from a target still counts as there: 0.1 for whatever is in degrees, 5 for millimetres.
# The notes give both for "in position"; 5 degrees at the end would be far off.
IN_POSITION_ANGLES = (0.1,) * 6
IN_POSITION_COORDS = (5.0, 5.0, 5.0, 0.1, 0.1, 0.1)
RESTING_COORDS = (44.4, -60.8, 411.7, -91.14, -1.72, -86.71)

# The document's chart of servo registers with their initial values (lines 1280-1291).
SERVO_REGISTERS = {20: 0, 21: 10, 22: 0, 23: 1, 24: 0}


@dataclass
class ArmState:
    """Every setting of the arm, and its axes."""

    joints: int
    powered: bool = False
    connected: bool = True
    free: bool = False
    stopped: bool = False
    paused: bool = False
    fresh_mode: int = 0
    speed: int = 50
    colour: tuple[int, int, int] = (0, 0, 0)
    reference_frame: int = 0
    end_type: int = 0
    port: int = 9000
    ssid: str = "MyCobotWiFi2.4G"
    password: str = "mycobot123"  # noqa: S105  (the document's own example)
    tool: tuple[float, ...] = (0.0,) * 6
    world: tuple[float, ...] = (0.0,) * 6
    pins: dict[int, bool] = field(default_factory=dict)
    pin_modes: dict[int, int] = field(default_factory=dict)
    basic_pins: dict[int, bool] = field(default_factory=dict)
    gripper: Axes = field(default_factory=lambda: Axes((0.0,)))
    pose: Axes = field(default_factory=lambda: Axes(RESTING_COORDS))
    settings: Settings = field(default_factory=Settings)
    angles: Axes = field(init=False)
    enabled: list[bool] = field(init=False)
    minimum: list[float] = field(init=False)
    maximum: list[float] = field(init=False)
    registers: list[dict[int, int]] = field(init=False)

    def __post_init__(self) -> None:
        self.angles = Axes((0.0,) * self.joints)
        self.enabled = [False] * self.joints
        self.minimum = [-165.0] * self.joints
        self.maximum = [165.0] * self.joints
        # One servo more than joints: newer firmware counts the gripper's as the last.
        self.registers = [dict(SERVO_REGISTERS) for _ in range(self.joints + 1)]

    def can_move(self) -> bool:
        """Whether a motion command is obeyed: powered, held, and not stopped."""
        return self.powered and not self.free and not self.stopped and all(self.enabled)

    def go_to_angles(self, target: tuple[float, ...], speed: int, now: float) -> bool:
        """Start a joint motion; False if it is refused, which the real arm does not tell either."""
        reachable = all(a <= t <= b for a, t, b in zip(self.minimum, target, self.maximum))
        if not reachable or not self.can_move() or speed == 0:
            return False
        self.angles.go(target, DEGREES_A_SECOND * speed, now, queue=self.fresh_mode == 0)
        return True

    def go_to_coords(self, target: tuple[float, ...], speed: int, now: float) -> bool:
        """Start a motion of the end; False if it is refused."""
        if not self.can_move() or speed == 0:
            return False
        self.pose.go(target, MILLIMETRES_A_SECOND * speed, now, queue=self.fresh_mode == 0)
        return True

    def halt(self, now: float) -> None:
        """End every motion of the arm."""
        self.angles.halt(now)
        self.pose.halt(now)

    def encoder(self, joint: int, now: float) -> int:
        """The servo position of a joint, counted from 0; the gripper's, behind the last joint."""
        if joint >= self.joints:
            return ZERO_TICK + round(self.gripper.position(now)[0])
        return angle_to_tick(joint, self.angles.position(now)[joint])


def angle_to_tick(joint: int, degrees: float) -> int:
    """The servo position that holds a joint at an angle."""
    tick = ZERO_TICK + ENCODER_SIGNS[joint % 6] * round(degrees * TICKS_A_TURN / 360)
    return min(max(tick, 0), TICKS_A_TURN - 1)


def tick_to_angle(joint: int, tick: int) -> float:
    """The angle at which a servo position holds a joint."""
    return ENCODER_SIGNS[joint % 6] * (tick - ZERO_TICK) * 360 / TICKS_A_TURN
