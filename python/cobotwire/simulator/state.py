"""The state of a simulated arm: its settings, and the positions of its axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from cobotwire.kinematics import Geometry, Pose, flange
from cobotwire.kinematics.coordinates import ALL_SIX, pose_with
from cobotwire.kinematics.ticks import Steps, reported_angles, reported_coords
from cobotwire.protocol.messages import Event
from cobotwire.protocol.robot import (
    UNSTATED,
    Dynamics,
    Encoders,
    ErrorCodes,
    Gripper,
    Robot,
    Servos,
)
from cobotwire.simulator.motion import Axes
from cobotwire.simulator.motion.hand import TimedPoint

NO_STEPS = Steps()
# What this simulator assumes of a robot if the edition does not state it.
UNSTATED_MOTION = Dynamics(1.0, 100.0, 200.0)
UNSTATED_GRIPPER = Gripper(1.0, 0, 100)
NEAR_DEGREES, NEAR_MILLIMETRES = 0.1, 5.0
HALF_TURN = 180.0
NO_POSE = (0.0,) * 6
# In percent per second squared; so high that a gripper is at full speed at once.
OPENING_ACCELERATION = 10_000.0
# No source states how often points are recorded; their number is sent in two bytes.
RECORD_EVERY_SECONDS = 0.1
MOST_POINTS = 32767


@dataclass
class ArmState:
    """Every setting of the arm, and its axes. Angles are in degrees.

    ``robot`` is what the edition states about the robot; ``geometry`` may replace its links.
    """

    joints: int
    geometry: Geometry | None = None
    robot: Robot = UNSTATED
    # For each coordinate of the edition, its index in x, y, z, rx, ry, rz.
    coordinates: tuple[int, ...] = ALL_SIX
    steps: Steps = NO_STEPS
    # By how many seconds the joints lag behind the motion that the arm computes.
    lag: float = 0.0
    powered: bool = False
    connected: bool = True
    free: bool = False
    paused: bool = False
    # The state that the edition declares, by name, and what behaviours from outside keep. A state
    # with a value for each index is a mapping from the index.
    kept: dict[str, Any] = field(default_factory=dict)
    # What clients set for joints that the arm lacks, by the state and the index.
    elsewhere: dict[str, dict[Any, Any]] = field(default_factory=dict)
    # The last error; 0: none.
    error: int = 0
    recording: bool = False
    # How many of the recorded points were read back.
    played: int = 0
    # When the next point is recorded.
    record_at: float = 0.0
    # How somebody leads the arm whenever it is released.
    hand: tuple[TimedPoint, ...] = ()
    # The registers of backed up servos, counted from 1.
    backups: dict[int, dict[int, int]] = field(default_factory=dict)
    # How often the controller has started.
    starts: int = 1
    gripper: Axes = field(default_factory=lambda: Axes((0.0,), OPENING_ACCELERATION))
    # Why the present request had no effect or waits; the arm turns these remarks into notes.
    remarks: list[str] = field(default_factory=list)
    # The error code of the rejection of the present request; 0: it has no code; None: not rejected.
    rejection: int | None = None
    # Whether the present request started a motion, even if it takes no time.
    at_once: bool = False
    # The events of the present request, each with its time.
    emitted: list[tuple[Event, float]] = field(default_factory=list)
    angles: Axes = field(init=False)
    enabled: list[bool] = field(init=False)
    minimum: list[float] = field(init=False)
    maximum: list[float] = field(init=False)

    def __post_init__(self) -> None:
        start = self.robot.start_angles or (0.0,) * self.joints
        self.angles = Axes(start, self.motion.acceleration, self.lag)
        self.enabled = [False] * self.joints
        self.minimum = [-HALF_TURN] * self.joints
        self.maximum = [HALF_TURN] * self.joints

    # The declared state that motion and kinematics use. A state that the edition does not declare
    # has the value that changes nothing.
    @property
    def queues(self) -> bool:
        """Whether a new target waits for the end of the present motion."""
        return not self.kept.get("fresh_mode", 0)

    @property
    def moves_straight(self) -> bool:
        """Whether the arm moves on a straight line if the command does not choose."""
        return bool(self.kept.get("movement_type", 0))

    @property
    def reports_ends(self) -> bool:
        """Whether the arm reports the end of each motion."""
        return bool(self.kept.get("reports_ends", True))

    @property
    def tool(self) -> tuple[float, ...] | None:
        """The tool's pose on the flange if the tool counts as the end of the arm; else None."""
        return self._pose("tool") if self.kept.get("end_type", 0) else None

    @property
    def world(self) -> tuple[float, ...] | None:
        """The base's pose in the world, if that is the frame of reference; else None."""
        return self._pose("world") if self.kept.get("reference_frame", 0) else None

    def _pose(self, name: str) -> tuple[float, ...]:
        """Return the pose that is kept under a name; zeros if it is not a pose in this edition."""
        value = self.kept.get(name)
        return value if isinstance(value, tuple) and len(value) == len(NO_POSE) else NO_POSE

    @property
    def points(self) -> list[Any]:
        """The recorded points: each has the encoder and the speed of each joint in turn."""
        points: list[Any] = self.kept.setdefault("points", [])
        return points

    @property
    def light(self) -> tuple[int, ...]:
        """The red, green and blue part of the light."""
        return tuple(self.kept.get(part, 0) for part in ("red", "green", "blue"))

    @property
    def motion(self) -> Dynamics:
        """How the arm moves."""
        return self.robot.motion or UNSTATED_MOTION

    @property
    def encoders(self) -> Encoders | None:
        """How the encoders count; None if the edition does not state it."""
        return self.robot.encoders

    @property
    def servos(self) -> Servos:
        """What the servos report."""
        return self.robot.servos or Servos()

    @property
    def gripper_facts(self) -> Gripper:
        """How fast the gripper moves, and what its encoder reads."""
        return self.robot.gripper or UNSTATED_GRIPPER

    @property
    def error_codes(self) -> ErrorCodes:
        """The numbers of rejected motions; 0 if the edition does not state them."""
        return self.robot.error_codes or ErrorCodes((0,) * self.joints, 0, 0)

    @property
    def near(self) -> tuple[float, float]:
        """The distances at which a target counts as reached, in degrees and in millimetres."""
        motion = self.motion
        return motion.near_degrees or NEAR_DEGREES, motion.near_millimetres or NEAR_MILLIMETRES

    def emit(self, event: Event, at: float) -> None:
        """Let the arm send an event at the time of the present request, or later."""
        self.emitted.append((event, at))

    def standing(self, now: float) -> tuple[float, ...]:
        """Return where the joints are, on the ticks of their encoders."""
        return self.on_ticks(self.angles.position(now))

    def on_ticks(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        """Return where joints would stop if they were sent to angles: on the nearest ticks."""
        return tuple(map(self.on_tick, angles))

    def on_tick(self, degrees: float) -> float:
        """Return the angle of the nearest tick."""
        return self.encoders.on_tick(degrees) if self.encoders else degrees

    @property
    def tick_degrees(self) -> float:
        """The degrees of a tick; 0 if the edition states no encoders: angles are not rounded."""
        return self.encoders.degrees if self.encoders else 0.0

    def reported_angles(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        """Return angles as the arm reports them."""
        return reported_angles(self.encoders, angles, self.steps) if self.encoders else angles

    def limits(self) -> list[tuple[float, float]]:
        """Return the lowest and the highest angle on a tick that each joint may have.

        If the first is above the second, no angle is allowed.
        """
        pairs = list(zip(self.minimum, self.maximum))
        if self.encoders is None:
            return pairs
        return [self.encoders.inside(joint, *pair) for joint, pair in enumerate(pairs)]

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
        while self.recording and self.record_at <= now and len(self.points) < MOST_POINTS:
            self.record_point(self.record_at)
            self.record_at += RECORD_EVERY_SECONDS

    def record_point(self, now: float) -> None:
        """Record the encoders and speeds of the joints."""
        encoders = tuple(self.encoder(joint, now) for joint in range(self.joints))
        pairs = zip(encoders, self.servo_speeds(now))
        self.points.append(tuple(part for pair in pairs for part in pair))

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
        """Return the speed of each servo in encoder steps per second; its sign is the direction."""
        if self.encoders is None:
            return (0,) * self.joints
        encoders, speeds = self.encoders, enumerate(self.angles.speed(now))
        return tuple(round(encoders.sign(joint) * v / encoders.degrees) for joint, v in speeds)

    def encoder(self, joint: int, now: float) -> int:
        """Return the encoder of a joint, counted from 0; after the last joint, the gripper's."""
        if joint >= self.joints:
            gripper, opening = self.gripper_facts, self.gripper.position(now)[0]
            return gripper.closed + round(opening * (gripper.open - gripper.closed) / 100)
        return (
            self.encoders.reading(joint, self.angles.position(now)[joint]) if self.encoders else 0
        )

    def opening_at(self, encoder: int) -> float:
        """Return how far the gripper is open, in percent, for a reading of its encoder."""
        gripper = self.gripper_facts
        return 100 * (encoder - gripper.closed) / (gripper.open - gripper.closed)

    def reported_coords(
        self, angles: tuple[float, ...], *, base: bool = False
    ) -> tuple[float, ...] | None:
        """Return the end's coordinates for angles, as the arm reports them.

        Without a geometry, return None. With ``base``, use the frame of the base, whatever
        reference frame is set.
        """
        pose = self.end(angles, base=base)
        if pose is None:
            return None
        coords = reported_coords(pose.coords, self.steps)
        return tuple(coords[place] for place in self.coordinates)

    def pose_of(self, values: Sequence[float], angles: tuple[float, ...]) -> Pose:
        """Return the end's pose; coordinates that the edition lacks are those of ``angles``."""
        return pose_with(values, self.coordinates, self.end(angles))

    def end(self, angles: tuple[float, ...], *, base: bool = False) -> Pose | None:
        """Return the pose of the flange or the tool, in the frame of the base or the world."""
        if self.geometry is None:
            return None
        pose = flange(self.geometry, angles)
        if self.tool is not None:
            pose = pose.then(Pose.of(self.tool))
        return pose if base or self.world is None else Pose.of(self.world).then(pose)

    def flange_for(self, end: Pose) -> Pose:
        """Return the flange's pose in the frame of the base when the end is at ``end``."""
        if self.tool is not None:
            end = end.then(Pose.of(self.tool).inverted())
        return end if self.world is None else Pose.of(self.world).inverted().then(end)
