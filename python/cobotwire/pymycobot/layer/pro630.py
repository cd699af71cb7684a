"""What the computer inside of a Pro 630 does: it switches the arm's power, and drives pins."""

from __future__ import annotations

import time
from importlib import import_module
from typing import Any, ClassVar

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.layer.closed_loop import Reporting

NO_MONITOR = "the Pro 630 has no monitor mode"


class MethodsOfPro630(Reporting):
    """Has the constants of the class, in millimetres and in numbers of the processor's pins."""

    joint_number: ClassVar[int] = 6
    arm_span_maximum: ClassVar[int] = 630
    power_control_1: ClassVar[int] = 3
    power_control_2: ClassVar[int] = 4
    pin_numbered_mapping_table: ClassVar[dict[int, int]] = {1: 17, 2: 27, 3: 22, 4: 5, 5: 6, 6: 19}

    def set_monitor_mode(self, mode: int) -> None:
        """Raise NotImplementedError, as the library does: the arm has no monitor mode."""
        raise NotImplementedError(NO_MONITOR)

    def get_monitor_mode(self) -> None:
        """Raise NotImplementedError, as the library does: the arm has no monitor mode."""
        raise NotImplementedError(NO_MONITOR)


class PinsOfPro630(MethodsOfPro630):
    """Switches the power of the arm and its base's pins, by the package RPi.GPIO.

    The numbers of pins are those of the processor (BCM).
    """

    def power_on(self, delay: float = 2) -> Any:
        """Switch the power on, wait some seconds, and power the arm."""
        if not isinstance(delay, int | float) or not delay >= 0:
            raise UsageError("delay", delay, "seconds, 0 or more")
        self.power_on_only()
        time.sleep(delay)
        return super().power_on()

    def power_off(self) -> Any:
        """Take the power from the arm, and switch it off."""
        result = self._send_acked(self.arm.power_off)
        gpio = self._gpio()
        gpio.output(self.power_control_2, gpio.LOW)
        return result

    def power_on_only(self) -> None:
        """Switch the power on; the motors have none yet."""
        gpio = self._gpio()
        gpio.output(self.power_control_2, gpio.HIGH)

    def set_basic_output(self, pin_no: int, pin_signal: int) -> None:
        """Set a pin of the base to 0 or 1."""
        pin, gpio = self._pin(pin_no), self._gpio()
        gpio.setup(pin, gpio.OUT)
        gpio.output(pin, pin_signal)

    def get_basic_input(self, pin_no: int) -> int:
        """Read a pin of the base: 0 or 1."""
        pin, gpio = self._pin(pin_no), self._gpio()
        gpio.setup(pin, gpio.IN)
        return int(gpio.input(pin))

    def _pin(self, number: int) -> int:
        found = self.pin_numbered_mapping_table.get(number)
        if found is None:
            raise UsageError("pin_no", number, "1..6")
        return found

    def _gpio(self) -> Any:
        """Return the package for pins; prepare the pins of the power before their first use.

        Raises:
            UsageError: the package is not installed.
        """
        if not hasattr(self, "_pins"):
            try:
                gpio: Any = import_module("RPi.GPIO")
            except ImportError:
                message = (
                    "pins need the package RPi.GPIO, on the computer inside of the arm; "
                    "from another computer, use Pro630Client"
                )
                raise UsageError("gpio", message=message) from None
            gpio.setmode(gpio.BCM)
            gpio.setwarnings(False)
            gpio.setup(self.power_control_1, gpio.IN)
            gpio.setup(self.power_control_2, gpio.OUT)
            self._pins: Any = gpio
        return self._pins
