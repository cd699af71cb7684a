"""The methods of the maker's class for the myBuddy that one request cannot express."""

from __future__ import annotations

import time
from collections.abc import Sequence
from importlib import import_module
from typing import Any, Self

from cobotwire.protocol.errors import MotionTimeout, ProtocolError, UsageError
from cobotwire.pymycobot.layer import results
from cobotwire.pymycobot.layer.client import CompatibleClient
from cobotwire.pymycobot.layer.naming import naming

# The pins of the board by their numbers of the processor (BCM).
_PINS: dict[int | str, int] = {
    **dict(enumerate((7, 8, 25, 24, 23, 18, 11, 9, 10, 22, 27, 17, 3, 2, 6, 5), start=1)),
    "SCL0": 6,
    "SDA0": 5,
}
# A pin is an output.
OUTPUT = 1
_WAIST, _ROTATIONS = 3, 4


class Limbs(CompatibleClient):
    """Targets and coordinates of an arm, of the waist, or of the whole robot."""

    @naming(address="id", target="data", left="data", right="data", waist="data", kind="mode")
    def is_in_position(self, id: int, data: Sequence[Any], mode: int) -> Any:
        """Check whether a target is reached: angles, or coordinates if ``mode`` is 1.

        ``data`` has six numbers for an arm, one for the waist, and three rows for the whole robot.
        """
        device = self.arm.at(id)
        if len(data) == 1:
            return self._query(int, device.is_waist_in_position, data[0], mode)
        if len(data) != 3:
            return self._query(int, device.is_in_position, data, mode)
        left, right, waist = data
        return self._query(int, device.is_robot_in_position, left, right, waist[0], mode)

    def get_base_coords(self, *args: Any) -> Any:
        """Read the coordinates of both arms in the base's frame, or convert those of one arm to it.

        Without arguments it calls ``get_base_coords()``, with ``coords, arm`` it calls
        ``single_to_base_coords(coords, arm)``.
        """
        if not args:
            return self._query(results.plain, self.arm.get_base_coords)
        if len(args) != 2:
            message = f"get_base_coords() takes coords and arm, or nothing, not {len(args)} values"
            raise UsageError("get_base_coords", message=message)
        return self._query(results.plain, self.arm.single_to_base_coords, *args)

    @naming(address="id", axis="joint_id")
    def get_coord(self, id: int, joint_id: int) -> Any:
        """Read a coordinate, in millimetres or degrees; the waist's is in degrees."""
        degrees = id == _WAIST or (isinstance(joint_id, int) and joint_id >= _ROTATIONS)
        scale = 100 if degrees else 10
        return self._query(lambda raw: raw / scale, self.arm.at(id).get_coord, joint_id)

    @naming(address="id", speeds="speed")
    def set_encoders(self, id: int, encoders: Sequence[int], speed: int | Sequence[int]) -> Any:
        """Send all joints of an arm to encoder positions.

        ``speed`` is one number, in percent, or a row with the speed of each servo.
        """
        kind = "speed" if isinstance(speed, int) else "speeds"
        self.arm.at(id).set_encoders(encoders, **{kind: speed})

    @naming(address="id", angles="degrees")
    def sync_send_angles(
        self, id: int, degrees: Sequence[float], speed: int, timeout: float = 15
    ) -> Self:
        """Move all joints of an arm to angles, and wait for them, as ``move_angles`` does.

        Raises:
            MotionTimeout: the arm does not arrive in time; it is then sent ``stop``. With
                ``errors="return"`` nothing is raised.
            ProtocolError: the arm refuses the motion, or a reply is not allowed; otherwise as
                MotionTimeout.
        """
        return self._reached(self.arm.at(id).move_angles, degrees, speed, timeout=timeout)

    @naming(address="id")
    def sync_send_coords(
        self, id: int, coords: Sequence[float], speed: int, mode: int = 0, timeout: float = 15
    ) -> Self:
        """Move the end of an arm to coordinates, and wait for it, as ``move_coords`` does.

        Raises:
            MotionTimeout: as ``sync_send_angles``.
        """
        return self._reached(self.arm.at(id).move_coords, coords, speed, mode, timeout=timeout)

    def _reached(self, move: Any, *arguments: Any, timeout: float) -> Self:
        try:
            move(*arguments, timeout=timeout)
        except (MotionTimeout, ProtocolError):
            if self._raises:
                raise
        return self

    def wait(self, t: float) -> Self:
        """Sleep for some seconds."""
        time.sleep(t)
        return self


class LimbPins(CompatibleClient):
    """The port and the pins of the board of a myBuddy; pins by the packages RPi.GPIO and smbus2."""

    def is_open(self) -> bool:
        """Return whether the port is open."""
        return self._is_open

    def set_gpio_init_mode(self, mode: int = 1) -> None:
        """Number the pins as the processor does (BCM).

        Raises:
            UsageError: ``mode`` is not 0. The other methods use the processor's numbers, so with
                the board's numbers they would drive other pins; the library fails there, too.
        """
        if mode != 0:
            raise UsageError("mode", mode, "0, the numbers of the processor (BCM)")
        self.gpio: Any = import_module("RPi.GPIO")
        self.gpio.setmode(self.gpio.BCM)

    def set_gpio_setup(self, pin_no: int | str, mode: int) -> None:
        """Make a pin an output if ``mode`` is 1, else an input."""
        gpio = self._gpio()
        gpio.setup(self.base_io_to_gpio(pin_no), gpio.OUT if mode == OUTPUT else gpio.IN)

    def set_gpio_output(self, pin_no: int | str, v: int) -> None:
        """Set a pin to 0 or 1."""
        self._gpio().output(self.base_io_to_gpio(pin_no), v)

    def get_gpio_input(self, pin_no: int | str) -> int:
        """Read a pin: 0 or 1."""
        return int(self._gpio().input(self.base_io_to_gpio(pin_no)))

    def set_gpio_pwm_start(self, pin_no: int | str, freq: float = 0.5, dc: float = 0.5) -> None:
        """Start pulses on a pin, at a frequency in hertz and a duty cycle in percent."""
        self.pwm: Any = self._gpio().PWM(self.base_io_to_gpio(pin_no), freq)
        self.pwm.start(dc)

    def set_gpio_pwm_change_freq(self, freq: float) -> None:
        """Change the frequency of the pulses, in hertz."""
        self._pwm().ChangeFrequency(freq)

    def set_gpio_pwm_change_dc(self, dc: float) -> None:
        """Change the duty cycle of the pulses, in percent."""
        self._pwm().ChangeDutyCycle(dc)

    def set_gpio_pwm_stop(self) -> None:
        """Stop the pulses."""
        self._pwm().stop()

    def set_gpio_clearup(self, pin_no: int | str | None = None) -> None:
        """Release a pin, or all of them."""
        gpio = self._gpio()
        if pin_no:
            gpio.cleanup(self.base_io_to_gpio(pin_no))
        else:
            gpio.cleanup()

    def set_iic_init(self, IIC_NO: int) -> Any:
        """Return the bus 0 or 1 of the board, opened by smbus2."""
        return import_module("smbus2").SMBus(IIC_NO)

    def base_io_to_gpio(self, pin: int | str) -> int:
        """Return the processor's number of a pin of the board.

        Raises:
            UsageError: the board has no such pin.
        """
        if pin not in _PINS:
            raise UsageError("pin", pin, "1..16, SCL0, SDA0")
        return _PINS[pin]

    def _gpio(self) -> Any:
        if not hasattr(self, "gpio"):
            raise UsageError("gpio", message="call set_gpio_init_mode() before using a pin")
        return self.gpio

    def _pwm(self) -> Any:
        if not hasattr(self, "pwm"):
            raise UsageError("pwm", message="call set_gpio_pwm_start() before changing the pulses")
        return self.pwm
