"""Methods of the Pro 450 class that classes of other robots lack."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from struct import unpack_from
from typing import Any

from cobotwire import codec
from cobotwire.protocol.errors import ProtocolError, ReplyTimeout
from cobotwire.pymycobot.layer.client import DONE
from cobotwire.pymycobot.layer.closed_loop import HOME_SPEED, REPORTS_ENDS, ClosedLoop
from cobotwire.pymycobot.layer.modbus_gripper import GRIPPER, OWN_HEAD, ModbusGripper, percent
from cobotwire.pymycobot.layer.naming import naming
from cobotwire.pymycobot.layer.ranges import check_range
from cobotwire.pymycobot.layer.results import plain
from cobotwire.session.request import RequestEncoder

# A trajectory has ended when this many queries in a row find the arm at rest.
STILL_TIMES = 2
TRAJECTORY_SECONDS = 0.01
# The Modbus request that reads the force sensor.
FORCE_SENSOR = bytes([0x01, 0x04, 0x00, 0x00, 0x00, 0x0C, 0xF0, 0x0F])
SENSOR_REPLY = 27
# The speeds of the bus at which a gripper is searched for.
SEARCHED_SPEEDS = (115200, 1000000)
# The timeouts of the bus during the search and otherwise, in milliseconds.
SEARCH_TIMEOUT, USUAL_TIMEOUT = 250, 10000
# How often a gripper is queried after it was switched to Modbus.
SEARCH_TIMES = 3


class Gripper450(ModbusGripper):
    """The gripper with force control: each method reads or writes one register."""

    def get_pro_gripper_firmware_version(self, gripper_id: int = GRIPPER) -> float:
        """Read the version of the firmware, such as 1.2."""
        found = self._read(1, gripper_id)
        return found / 10 if found >= 0 else found

    def get_pro_gripper_firmware_modified_version(self, gripper_id: int = GRIPPER) -> int:
        """Read the revision of the firmware."""
        return self._read(2, gripper_id)

    def set_pro_gripper_id(self, target_id: int, gripper_id: int = GRIPPER) -> int:
        """Give the gripper another number on the bus."""
        return self._write(3, target_id, ("target_id", 1, 254), gripper_id)

    def get_pro_gripper_id(self, gripper_id: int = GRIPPER) -> int:
        """Read the number on the bus."""
        return self._read(4, gripper_id)

    def set_pro_gripper_baud(self, baud_rate: int = 0, gripper_id: int = GRIPPER) -> int:
        """Set the speed of the bus: 0 is 115200, 1 1000000, 2 57600, 3 19200, 4 9600, 5 4800."""
        return self._write(5, baud_rate, ("baud_rate", 0, 5), gripper_id)

    def get_pro_gripper_baud(self, gripper_id: int = GRIPPER) -> int:
        """Read the speed of the bus, as a number 0 to 5."""
        return self._read(6, gripper_id)

    def set_pro_gripper_enabled(self, state: int, gripper_id: int = GRIPPER) -> int:
        """Enable the gripper (1), or release it (0)."""
        return self._write(10, state, ("state", 0, 1), gripper_id)

    def set_pro_gripper_angle(self, gripper_angle: int, gripper_id: int = GRIPPER) -> int:
        """Move the gripper to an opening in percent."""
        return self._write(11, gripper_angle, percent("gripper_angle"), gripper_id)

    def get_pro_gripper_angle(self, gripper_id: int = GRIPPER) -> int:
        """Read the opening in percent."""
        return self._read(12, gripper_id)

    def set_pro_gripper_open(self, gripper_id: int = GRIPPER) -> int:
        """Open the gripper."""
        return self.set_pro_gripper_angle(100, gripper_id)

    def set_pro_gripper_close(self, gripper_id: int = GRIPPER) -> int:
        """Close the gripper."""
        return self.set_pro_gripper_angle(0, gripper_id)

    def set_pro_gripper_calibration(self, gripper_id: int = GRIPPER) -> int:
        """Make the present position the zero."""
        return self._write_in(b"", 13, 0, gripper_id)

    def get_pro_gripper_status(self, gripper_id: int = GRIPPER) -> int:
        """Read whether the gripper moves (0), stopped (1), holds something (2), or lost it (3)."""
        return self._read(14, gripper_id)

    def set_pro_gripper_mini_pressure(self, pressure_value: int, gripper_id: int = GRIPPER) -> int:
        """Set the smallest pressure."""
        return self._write(25, pressure_value, ("pressure_value", 0, 254), gripper_id)

    def get_pro_gripper_mini_pressure(self, gripper_id: int = GRIPPER) -> int:
        """Read the smallest pressure."""
        return self._read(26, gripper_id)

    def set_pro_gripper_torque(self, gripper_torque: int, gripper_id: int = GRIPPER) -> int:
        """Set the torque in percent."""
        return self._write(27, gripper_torque, percent("gripper_torque"), gripper_id)

    def get_pro_gripper_torque(self, gripper_id: int = GRIPPER) -> int:
        """Read the torque in percent."""
        return self._read(28, gripper_id)

    def set_pro_gripper_io_open_angle(self, gripper_angle: int, gripper_id: int = GRIPPER) -> int:
        """Set the opening in percent to which the input pin opens the gripper."""
        return self._write(30, gripper_angle, percent("gripper_angle"), gripper_id)

    def get_pro_gripper_io_open_angle(self, gripper_id: int = GRIPPER) -> int:
        """Read the opening in percent to which the input pin opens the gripper."""
        return self._read(34, gripper_id)

    def set_pro_gripper_io_close_angle(self, gripper_angle: int, gripper_id: int = GRIPPER) -> int:
        """Set the opening in percent to which the input pin closes the gripper."""
        return self._write(31, gripper_angle, percent("gripper_angle"), gripper_id)

    def get_pro_gripper_io_close_angle(self, gripper_id: int = GRIPPER) -> int:
        """Read the opening in percent to which the input pin closes the gripper."""
        return self._read(35, gripper_id)

    def set_pro_gripper_speed(self, speed: int, gripper_id: int = GRIPPER) -> int:
        """Set the speed in percent."""
        return self._write(32, speed, ("speed", 1, 100), gripper_id)

    def get_pro_gripper_speed(self, gripper_id: int = GRIPPER) -> int:
        """Read the speed in percent."""
        return self._read(33, gripper_id)

    def set_pro_gripper_abs_angle(self, gripper_angle: int, gripper_id: int = GRIPPER) -> int:
        """Move the gripper to an opening in percent, whatever it holds."""
        return self._write(36, gripper_angle, percent("gripper_angle"), gripper_id)

    def set_pro_gripper_protection_current(
        self, current_value: int, gripper_id: int = GRIPPER
    ) -> int:
        """Set the protective current."""
        return self._write(43, current_value, ("current_value", 100, 300), gripper_id)

    def get_pro_gripper_protection_current(self, gripper_id: int = GRIPPER) -> int:
        """Read the protective current."""
        return self._read(44, gripper_id)

    def set_pro_gripper_modbus(
        self, state: int, custom_mode: bool = False, gripper_id: int = GRIPPER
    ) -> int:
        """Switch Modbus on or off; with ``custom_mode``, by a frame in the gripper's own format."""
        check_range("state", state, 0, 1)
        return self._write_in(OWN_HEAD if custom_mode else b"", 47, state, gripper_id)


class MethodsOfPro450(ClosedLoop, Gripper450):
    """Methods that send several requests, or none."""

    def set_limit_switch(self, limit_mode: int, state: int) -> None:
        """Let motions wait for their end, or return at once; ``limit_mode`` 1 changes nothing."""
        check_range("limit_mode", limit_mode, 1, 2)
        check_range("state", state, 0, 1)
        if limit_mode == REPORTS_ENDS:
            self._waits = bool(state)

    def _move(self, call: Callable[..., None], *arguments: Any, quiet: bool = False) -> Any:
        """Move as other robots do, but jog only if the arm queues targets, as the library does.

        Raises:
            UsageError: an argument is not allowed; nothing was sent, not even the query.
            ArmNotReady: a new target replaces the present one; with ``errors="return"`` the result
                is -1.
        """
        name = call.__name__
        if name.startswith("jog_"):
            table = self.arm.table
            encoder = RequestEncoder(codec.load(table))
            encoder.encode_request(table.command(name).request_type(*arguments))
            if self.arm.get_fresh_mode():
                return self._not_ready(name, "jogging needs queued targets; call set_fresh_mode(0)")
        return super()._move(call, *arguments, quiet=quiet)

    def power_on(self, mode: int = 1) -> Any:
        """Power the arm."""
        return self._query(plain, self.arm.power_on, mode)

    def go_home(self, speed: int = HOME_SPEED, _async: bool = False) -> Any:
        """Send all joints to 0 degrees."""
        return self._move(self.arm.send_angles, [0] * self.arm.table.joints, speed, quiet=_async)

    def fourier_trajectories(self, trajectory: int, _async: bool = False) -> Any:
        """Move along a trajectory for identification, and wait until the arm stands still."""
        result = self._send_acked(self.arm.fourier_trajectories, trajectory, quiet=_async)
        still = 0
        with self._stopping():
            while not _async and result == 1 and still < STILL_TIMES:
                still = 0 if self.arm.is_moving() else still + 1
                self.arm.listen(TRAJECTORY_SECONDS)
        return result if _async or result != 1 else 0

    @naming(data="can_data")
    def base_external_can_control(self, can_id: int, can_data: Sequence[int]) -> Any:
        """Send a message on the CAN bus of the base; return its reply: 2, the id, the bytes."""
        check_range("can_id", can_id, 1, 65535)
        data = [*can_id.to_bytes(4, "big"), *can_data]
        return self._query(_external, self.arm.base_external_control, data)

    def base_external_485_control(self, data: Sequence[int]) -> Any:
        """Send bytes on the RS485 bus of the base; return its reply: 1, and the bytes."""
        return self._query(_external, self.arm.base_external_control, data)

    def set_pro_gripper_init(self, gripper_id: int = GRIPPER) -> bool:
        """Find the gripper at two speeds of the bus, and switch it to Modbus at 115200 baud.

        Returns:
            Whether the gripper was found.
        """
        check_range("gripper_id", gripper_id, 1, 254)
        self._send_acked(self.arm.set_tool_serial_timeout, SEARCH_TIMEOUT)
        found = self._is_there(gripper_id)
        if found:
            self.set_pro_gripper_modbus(1, gripper_id=gripper_id)
        speeds = iter(SEARCHED_SPEEDS)
        while not found and (speed := next(speeds, None)) is not None:
            self._send_acked(self.arm.set_tool_serial_baud_rate, speed)
            found = self._is_there(gripper_id) or self._switches_to_modbus(gripper_id)
        if found:
            self.set_pro_gripper_baud(0, gripper_id)
            self._send_acked(self.arm.set_tool_serial_baud_rate, SEARCHED_SPEEDS[0])
            self._send_acked(self.arm.set_tool_serial_timeout, USUAL_TIMEOUT)
        return found

    def _is_there(self, gripper_id: int) -> bool:
        try:
            return self.get_pro_gripper_angle(gripper_id) >= 0
        except (ProtocolError, ReplyTimeout):
            return False

    def _switches_to_modbus(self, gripper_id: int) -> bool:
        try:
            switched = self.set_pro_gripper_modbus(1, True, gripper_id) == DONE
        except (ProtocolError, ReplyTimeout):
            return False
        return switched and any(self._is_there(gripper_id) for _ in range(SEARCH_TIMES))

    def get_force_sensor_data(self) -> Any:
        """Read the force sensor at the end of the arm: six numbers."""
        return self._query(_six_numbers, self.arm.tool_serial_write_data, FORCE_SENSOR)


def _six_numbers(reply: bytes) -> list[float]:
    """Return the numbers of the force sensor, which follow three bytes.

    Raises:
        ProtocolError: the reply is shorter.
    """
    if len(reply) < SENSOR_REPLY:
        raise ProtocolError("bad-length", 0, reply, "the force sensor did not send six numbers")
    return list(unpack_from(">6f", reply, 3))


def _external(reply: bytes) -> list[int]:
    """Return the bytes of a reply; in one from the CAN bus the id of the message is one number."""
    if reply[:1] == b"\x02":
        return [2, int.from_bytes(reply[1:5], "big"), *reply[5:]]
    return list(reply)
