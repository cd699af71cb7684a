"""The independent arm, with joints and a gripper that need time to move."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from conformance.independent.arm import Arm, signed

# At full speed: a quarter of a turn and half of the gripper's way in a second.
TICKS_PER_SECOND, PERCENT_PER_SECOND = 1024.0, 50.0
TICKS_PER_DEGREE = 4096 / 360


class Travel:
    """Numbers on their way to their goals, all at the same rate, which a pause holds."""

    def __init__(self, clock: Callable[[], float], start: Sequence[float]) -> None:
        self._clock = clock
        self.put(start)

    def put(self, place: Sequence[float]) -> None:
        """Be there, at rest."""
        self._start, self._goal, self._rate = list(place), list(place), 1.0
        self._since, self._held_at = self._clock(), None

    def go(self, goal: Sequence[float], rate: float) -> None:
        """Leave for a goal."""
        self._start, self._goal, self._rate = self.place(), list(goal), rate
        self._since, self._held_at = self._clock(), None

    def place(self) -> list[float]:
        """Return where the numbers are now."""
        until = self._clock() if self._held_at is None else self._held_at
        most = self._rate * (until - self._since)
        return [a + max(-most, min(most, b - a)) for a, b in zip(self._start, self._goal)]

    def hold(self) -> None:
        """Stay here for now."""
        self._held_at = self._clock()

    def resume(self) -> None:
        """Leave for the same goal again."""
        if self._held_at is not None:
            self.go(self._goal, self._rate)

    @property
    def moves(self) -> bool:
        """Whether any number is on its way."""
        return self._held_at is None and self.place() != self._goal

    @property
    def held(self) -> bool:
        """Whether a pause holds the numbers."""
        return self._held_at is not None

    _held_at: float | None


class MovingArm(Arm):
    """The arm. Motion to coordinates is not built: a run leaves these commands out."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._travel = Travel(clock, [0.0] * 6)
        # In the mode of interpolation, targets wait for the one before.
        self._queue: list[tuple[list[int], float]] = []
        super().__init__(clock)
        self._width = Travel(clock, [50.0])
        self._width_zero = 0.0

    @property
    def _ticks(self) -> list[int]:
        return [round(tick) for tick in self._travel.place()]

    @_ticks.setter
    def _ticks(self, ticks: Sequence[float]) -> None:
        self._travel.put(ticks)

    def _reply(self, id: int, data: bytes) -> bytes:
        if self._queue and not self._travel.moves and not self._travel.held:
            self._travel.go(*self._queue.pop(0))
        return super()._reply(id, data)

    def _answer(self, id: int, data: bytes) -> bytes | None:
        if id == 0x65:
            width = round(self._width.place()[0] - self._width_zero)
            return bytes([max(0, min(105, width))])
        flags = {0x27: self._travel.held, 0x2B: self._travel.moves, 0x69: self._width.moves}
        return bytes([flags[id]]) if id in flags else super()._answer(id, data)

    def _change(self, id: int, data: bytes) -> None:
        moves: dict[int, Callable[[bytes], None]] = {
            0x21: self._send_angle,
            0x22: lambda data: self._go_to_degrees(signed(data[:12]), data[12]),
            0x30: self._jog,
            0x31: self._send_angle,
            0x33: self._step,
            0x3A: lambda data: self._send_encoder(data[0], signed(data[1:3])[0]),
            0x3C: self._send_encoders,
            0x66: lambda data: self._grip(0 if data[0] else 100, data[1]),
            0x67: lambda data: self._grip(data[0], data[1]),
        }
        if id in (0x11, 0x13, 0x29, 0x34):
            self._queue = []
            self._travel.put(self._travel.place())
        if id == 0x26:
            self._travel.hold()
        elif id == 0x28:
            self._travel.resume()
        elif id == 0x68:
            self._width_zero = self._width.place()[0]
        elif id == 0x54:
            self._travel.put([0 if at == data[0] else t for at, t in enumerate(self._ticks, 1)])
        elif id not in moves:
            super()._change(id, data)
        elif self._powered:
            moves[id](data)

    def _grip(self, width: float, speed: int) -> None:
        self._width.go([width + self._width_zero], PERCENT_PER_SECOND * max(speed, 1) / 100)

    def _go(self, ticks: Sequence[float], speed: int) -> None:
        low, high = (
            [limit / 10 * TICKS_PER_DEGREE for limit in self._limits[id]] for id in (0x4A, 0x4B)
        )
        goal = [min(max(tick, a), b) for tick, a, b in zip(ticks, low, high)]
        target = ([round(tick) for tick in goal], TICKS_PER_SECOND * max(speed, 1) / 100)
        if self._travel.moves and not self._flags[0x16]:
            self._queue.append(target)
        else:
            self._queue = []
            self._travel.go(*target)

    def _go_to_degrees(self, hundredths: Sequence[float], speed: int) -> None:
        self._go([n / 100 * TICKS_PER_DEGREE for n in hundredths], speed)

    def _with(self, joint: int, tick: float) -> list[float]:
        """Return where all joints are, with another place of one."""
        return [tick if at == joint else now for at, now in enumerate(self._ticks, 1)]

    def _send_angle(self, data: bytes) -> None:
        goal = signed(data[1:3])[0] / 100 * TICKS_PER_DEGREE
        self._go(self._with(data[0], goal), data[3])

    def _step(self, data: bytes) -> None:
        by = signed(data[1:3])[0] / 100 * TICKS_PER_DEGREE
        self._go(self._with(data[0], self._ticks[data[0] - 1] + by), data[3])

    def _jog(self, data: bytes) -> None:
        self._go(self._with(data[0], 9999 if data[1] else -9999), data[2])

    def _send_encoder(self, joint: int, encoder: int) -> None:
        self._go(self._with(joint, self._of_encoder(joint, encoder)), 50)

    def _send_encoders(self, data: bytes) -> None:
        ticks = [self._of_encoder(at, n) for at, n in enumerate(signed(data[:12]), 1)]
        self._go(ticks, data[12])

    def _of_encoder(self, joint: int, encoder: int) -> float:
        return (encoder - 2048) * self._directions[joint - 1]

    _directions = (-1, -1, 1, -1, -1, -1)
