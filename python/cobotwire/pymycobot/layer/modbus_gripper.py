"""The gripper of a Pro 450, which the arm reaches by Modbus frames."""

from __future__ import annotations

from typing import Any

from cobotwire.protocol.errors import ProtocolError, RequestRefused
from cobotwire.pymycobot.layer.client import DONE, CompatibleClient
from cobotwire.pymycobot.layer.ranges import check_range

READ, WRITE = 3, 6
# The number of a new gripper on the bus.
GRIPPER = 14
# The first bytes of a frame in the gripper's own format: the head, and its length.
OWN_HEAD = bytes([0xFE, 0xFE, 8])


def check_of(data: bytes) -> int:
    """Return the Modbus CRC of ``data``."""
    rest = 0xFFFF
    for each in data:
        rest ^= each
        for _ in range(8):
            rest = (rest >> 1) ^ (0xA001 if rest & 1 else 0)
    return rest


class ModbusGripper(CompatibleClient):
    """Reads and writes registers of the gripper by ``tool_serial_write_data``.

    A register that cannot be read, or a value that the gripper does not accept, raises
    ProtocolError; with ``errors="return"`` the result is -1.
    """

    def _write(
        self, register: int, value: int, allowed: tuple[str, int, int], gripper_id: int
    ) -> int:
        """Write a register; ``allowed`` is the parameter, its lowest and its highest value."""
        name, lowest, highest = allowed
        check_range(name, value, lowest, highest)
        return self._write_in(b"", register, value, gripper_id)

    def _write_in(self, head: bytes, register: int, value: int, gripper_id: int) -> int:
        check_range("gripper_id", gripper_id, 1, 254)
        size = len(head)
        reply = self._sent(head, WRITE, register, value, gripper_id)
        if isinstance(reply, int):
            return reply
        accepted = int.from_bytes(reply[size + 4 : size + 6], "big")
        if accepted == DONE:
            return DONE
        return self._fails(
            RequestRefused(f"the write of register {register}", "status", str(accepted), reply)
        )

    def _read(self, register: int, gripper_id: int) -> int:
        """Read a register."""
        check_range("gripper_id", gripper_id, 1, 254)
        reply = self._sent(b"", READ, register, 0, gripper_id)
        return reply if isinstance(reply, int) else int.from_bytes(reply[4:6], "big")

    def _sent(
        self, head: bytes, function: int, register: int, value: int, gripper_id: int
    ) -> bytes | int:
        """Send a frame; return the reply, or the result of a failed call."""
        data = bytes(
            [gripper_id, function, *register.to_bytes(2, "big"), *value.to_bytes(2, "big")]
        )
        # In a frame of the gripper's own kind the check covers the head; its high byte comes first.
        check = check_of(head + data).to_bytes(2, "big" if head else "little")
        reply: Any = self._query(bytes, self.arm.tool_serial_write_data, head + data + check)
        if isinstance(reply, int):
            return reply
        size = len(head)
        if len(reply) >= size + 6 and reply[size + 1 : size + 4] == data[1:4]:
            return bytes(reply)
        what = f"the gripper replied to another request than that for register {register}"
        return self._fails(ProtocolError("bad-value", size, reply, what))

    def _fails(self, error: ProtocolError) -> int:
        try:
            raise error
        except ProtocolError:
            return self._failed()


def percent(name: str) -> tuple[str, int, int]:
    """Return what is allowed for a parameter in percent."""
    return name, 0, 100
