"""The state of a simulated arm: its settings, and the positions of its axes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from cobotwire.protocol.table import Dynamics
from cobotwire.simulator.kinematics import DEGREES_PER_TICK, Geometry, Pose, flange
from cobotwire.simulator.kinematics.ticks import (
    ZERO_TICK,
    angle_at,
    encoder_at,
    inside,
    on_tick,
    reported_angles,
    reported_coords,
)
from cobotwire.simulator.motion import Axes
from cobotwire.simulator.motion.hand import TimedPoint
from cobotwire.simulator.remembered import Remembered

# How an arm moves if its edition does not state it: like the 280.
LIKE_280 = Dynamics(1.5, 150.0, 200.0)
# No source defines how a gripper moves: here it opens in two thirds of a second, at full speed from
# the beginning.
OPENING_PER_SECOND = 1.5
OPENING_ACCELERATION = 10_000.0
HIGHEST_ENCODER = 4096
# No source says how often a point is recorded; their number is a word.
RECORD_EVERY_SECONDS = 0.1
MOST_POINTS = 32767

# The document's chart of servo registers with their initial values (lines 1280-1291).
SERVO_REGISTERS = {20: 0, 21: 10, 22: 0, 23: 1, 24: 0}


@dataclass
class ArmState:
    """Every setting of the arm, and its axes. Angles are in degrees."""

    joints: int
    geometry: Geometry | None = None
    motion: Dynamics = LIKE_280
    powered: bool = False
    connected: bool = True
    free: bool = False
    paused: bool = False
    fresh_mode: int = 0
    movement_type: int = 0
    vision: bool = False
    transparent: bool = False
    speed: int = 50
    colour: tuple[int, int, int] = (0, 0, 0)
    reference_frame: int = 0
    end_type: int = 0
    port: int = 9000
    ssid: str = "MyCobotWiFi2.4G"
    password: str = "mycobot123"  # noqa: S105  (the document's own example)
    tool: tuple[float, ...] = (0.0,) * 6
    world: tuple[float, ...] = (0.0,) * 6
    remembered: Remembered = field(default_factory=Remembered)
    # Whatever behaviours from outside of cobotwire keep.
    kept: dict[str, Any] = field(default_factory=dict)
    pins: dict[int, bool] = field(default_factory=dict)
    pin_modes: dict[int, int] = field(default_factory=dict)
    basic_pins: dict[int, bool] = field(default_factory=dict)
    # By pin: the frequency in hertz and the duty cycle in 256ths.
    pulses: dict[int, tuple[int, int]] = field(default_factory=dict)
    gripper_torque: int = 300
    gripper_current: int = 100
    # The last error; 0: none.
    error: int = 0
    recording: bool = False
    # The encoders and speeds of each recorded point, and how many points were read back.
    recorded: list[tuple[tuple[int, ...], tuple[int, ...]]] = field(default_factory=list)
    played: int = 0
    # When the next point is recorded.
    record_at: float = 0.0
    # How somebody leads the arm whenever it is released.
    hand: tuple[TimedPoint, ...] = ()
    # The registers of backed up servos, counted from 0.
    backups: dict[int, dict[int, int]] = field(default_factory=dict)
    # How often the controller has started.
    starts: int = 1
    gripper: Axes = field(default_factory=lambda: Axes((0.0,), OPENING_ACCELERATION))
    # Why the present request had no effect or waits; the arm turns these remarks into notes.
    remarks: list[str] = field(default_factory=list)
    angles: Axes = field(init=False)
    enabled: list[bool] = field(init=False)
    minimum: list[float] = field(init=False)
    maximum: list[float] = field(init=False)
    registers: list[dict[int, int]] = field(init=False)

    def __post_init__(self) -> None:
        self.angles = Axes((0.0,) * self.joints, self.motion.acceleration)
        self.enabled = [False] * self.joints
        self.minimum = [-165.0] * self.joints
        self.maximum = [165.0] * self.joints
        # One servo more than joints: newer firmware counts the gripper's servo as the last.
        self.registers = [dict(SERVO_REGISTERS) for _ in range(self.joints + 1)]

    def standing(self, now: float) -> tuple[float, ...]:
        """Return where the joints are, on the ticks of their encoders."""
        return self.on_ticks(self.angles.position(now))

    def on_ticks(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        """Return where joints would stop if they were sent to angles: on the nearest ticks."""
        return tuple(map(on_tick, angles)) if self.geometry else angles

    def reported_angles(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        """Return angles as the arm reports them."""
        return reported_angles(angles) if self.geometry else angles

    def limits(self) -> list[tuple[float, float]]:
        """Return the lowest and the highest angle on a tick that each joint may have.

        If the first is above the second, no angle is allowed.
        """
        pairs = list(zip(self.minimum, self.maximum))
        return [inside(low, high) for low, high in pairs] if self.geometry else pairs

    @property
    def held(self) -> bool:
        """Whether every joint has power and torque."""
        return self.powered and not self.free and all(self.enabled)

    @property
    def released(self) -> bool:
        """Whether no joint has power and torque."""
        return not self.powered or self.free or not any(self.enabled)

    def release(self, now: float) -> None:
        """End every motion of the arm; if no joint is held now, somebody may lead the arm."""
        self.angles.halt(now)
        if self.released:
            self.angles.lead(self.hand, now)

    def hold(self, now: float) -> None:
        """End the motion by hand when a joint is held again."""
        if not self.released:
            self.angles.halt(now)

    def record(self, now: float) -> None:
        """Record the points that were due by now; the sources do not define how often."""
        while self.recording and self.record_at <= now and len(self.recorded) < MOST_POINTS:
            self.record_point(self.record_at)
            self.record_at += RECORD_EVERY_SECONDS

    def record_point(self, now: float) -> None:
        """Record the encoders and speeds of the joints."""
        encoders = tuple(self.encoder(joint, now) for joint in range(self.joints))
        self.recorded.append((encoders, self.servo_speeds(now)))

    def power_on(self) -> None:
        """Power and hold every joint where it is; connect the Atom."""
        self.connected = True
        self.powered, self.free = True, False
        self.enabled = [True] * self.joints

    def resume(self, now: float) -> None:
        """End a pause: continue."""
        self.paused = False
        self.angles.resume(now)

    def servo_speeds(self, now: float) -> tuple[int, ...]:
        """Return how fast each servo turns, in encoder steps per second and direction."""
        speeds = enumerate(self.angles.speed(now))
        return tuple(round(self._sign(joint) * v / DEGREES_PER_TICK) for joint, v in speeds)

    def encoder(self, joint: int, now: float) -> int:
        """Return the encoder of a joint, counted from 0; after the last joint, the gripper's."""
        if joint >= self.joints:
            return ZERO_TICK + round(self.gripper.position(now)[0])
        reading = encoder_at(self.angles.position(now)[joint], self._sign(joint))
        return min(max(reading, 0), HIGHEST_ENCODER)

    def angle_at(self, joint: int, encoder: int) -> float:
        """Return the angle of a joint, counted from 0, for a reading of its encoder."""
        return angle_at(encoder, self._sign(joint))

    def _sign(self, joint: int) -> int:
        return self.geometry.encoder_signs[joint] if self.geometry else 1

    def reported_coords(
        self, angles: tuple[float, ...], *, base: bool = False
    ) -> tuple[float, ...] | None:
        """Return the end's coordinates for angles, as the arm reports them.

        Without a geometry, return None. With ``base``, use the frame of the base, whatever
        reference frame is set.
        """
        pose = self.end(angles, base=base)
        return None if pose is None else reported_coords(pose.coords)

    def end(self, angles: tuple[float, ...], *, base: bool = False) -> Pose | None:
        """Return the pose of the flange or the tool, in the frame of the base or the world."""
        if self.geometry is None:
            return None
        pose = flange(self.geometry, angles)
        if self.end_type:
            pose = pose.then(Pose.of(self.tool))
        return Pose.of(self.world).then(pose) if self.reference_frame and not base else pose

    def flange_for(self, end: Pose) -> Pose:
        """Return the flange's pose in the frame of the base when the end is at ``end``."""
        if self.end_type:
            end = end.then(Pose.of(self.tool).inverted())
        return Pose.of(self.world).inverted().then(end) if self.reference_frame else end
