"""What a simulated arm remembers, and where it stands."""

from __future__ import annotations

from dataclasses import dataclass, field

from cobotwire.sim.kinematics import DEGREES_A_TICK, Geometry, Pose, flange
from cobotwire.sim.kinematics.ticks import (
    ZERO_TICK,
    angle_at,
    encoder_at,
    inside,
    on_tick,
    told_angles,
    told_coords,
)
from cobotwire.sim.motion import Axes
from cobotwire.sim.settings import Settings

# Facts of the 280, from the protocol notes on kinematics.
DEGREES_A_SECOND = 1.5  # for each percent of speed
FASTEST = 150.0  # degrees a second
ACCELERATION = 200.0  # degrees a square second
# No source says how a gripper moves: full way in two thirds of a second, up to speed at once.
OPENING_A_SECOND = 1.5
OPENING_ACCELERATION = 10_000.0
ENCODER_MOST = 4096

# The document's chart of servo registers with their initial values (lines 1280-1291).
SERVO_REGISTERS = {20: 0, 21: 10, 22: 0, 23: 1, 24: 0}


@dataclass
class ArmState:
    """Every setting of the arm, and its axes. Angles are in degrees."""

    joints: int
    geometry: Geometry | None = None
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
    # Frequency in hertz and share in 256ths, by pin.
    pulses: dict[int, tuple[int, int]] = field(default_factory=dict)
    # How often the controller has started.
    starts: int = 1
    gripper: Axes = field(default_factory=lambda: Axes((0.0,), OPENING_ACCELERATION))
    settings: Settings = field(default_factory=Settings)
    # What happened in the request of the moment that no answer tells; the arm makes notes of it.
    remarks: list[str] = field(default_factory=list)
    angles: Axes = field(init=False)
    enabled: list[bool] = field(init=False)
    minimum: list[float] = field(init=False)
    maximum: list[float] = field(init=False)
    registers: list[dict[int, int]] = field(init=False)

    def __post_init__(self) -> None:
        self.angles = Axes((0.0,) * self.joints, ACCELERATION)
        self.enabled = [False] * self.joints
        self.minimum = [-165.0] * self.joints
        self.maximum = [165.0] * self.joints
        # One servo more than joints: newer firmware counts the gripper's as the last.
        self.registers = [dict(SERVO_REGISTERS) for _ in range(self.joints + 1)]

    def standing(self, now: float) -> tuple[float, ...]:
        """Where the joints are, on their encoders' ticks."""
        return self.on_ticks(self.angles.position(now))

    def on_ticks(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        """Where joints would stand that are sent to angles: on the nearest ticks."""
        return tuple(map(on_tick, angles)) if self.geometry else angles

    def told_angles(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        """Angles as the arm tells them."""
        return told_angles(angles) if self.geometry else angles

    def limits(self) -> list[tuple[float, float]]:
        """The lowest and the highest angle at which each joint may stand, on ticks.

        Where the first is above the second, there is none.
        """
        pairs = list(zip(self.minimum, self.maximum))
        return [inside(low, high) for low, high in pairs] if self.geometry else pairs

    def halt(self, now: float) -> None:
        """End every motion of the arm at once, as where the torque is gone."""
        self.angles.halt(now)

    def servo_speeds(self, now: float) -> tuple[int, ...]:
        """How fast each joint's servo turns, in encoder steps a second; it counts as they do."""
        speeds = enumerate(self.angles.speed(now))
        return tuple(round(self._sign(joint) * v / DEGREES_A_TICK) for joint, v in speeds)

    def encoder(self, joint: int, now: float) -> int:
        """The encoder of a joint, counted from 0; the gripper's, behind the last joint."""
        if joint >= self.joints:
            return ZERO_TICK + round(self.gripper.position(now)[0])
        reading = encoder_at(self.angles.position(now)[joint], self._sign(joint))
        return min(max(reading, 0), ENCODER_MOST)

    def angle_at(self, joint: int, encoder: int) -> float:
        """The angle of a joint, counted from 0, whose encoder reads so much."""
        return angle_at(encoder, self._sign(joint))

    def _sign(self, joint: int) -> int:
        return self.geometry.encoder_signs[joint] if self.geometry else 1

    def told_coords(
        self, angles: tuple[float, ...], *, base: bool = False
    ) -> tuple[float, ...] | None:
        """The end's coordinates for angles, as the arm tells them; None: nobody knows them.

        With ``base`` they are in the base's frame, whatever reference frame is set.
        """
        pose = self.end(angles, base=base)
        return None if pose is None else told_coords(pose.coords)

    def end(self, angles: tuple[float, ...], *, base: bool = False) -> Pose | None:
        """Where the end is: flange or tool, in the base's frame or the world's, as it is set."""
        if self.geometry is None:
            return None
        pose = flange(self.geometry, angles)
        if self.end_type:
            pose = pose.then(Pose.of(self.tool))
        return Pose.of(self.world).then(pose) if self.reference_frame and not base else pose

    def flange_for(self, end: Pose) -> Pose:
        """The flange's pose in the base's frame when the end is at ``end``."""
        if self.end_type:
            end = end.then(Pose.of(self.tool).inverted())
        return Pose.of(self.world).inverted().then(end) if self.reference_frame else end
