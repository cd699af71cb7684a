"""The registers of the grippers of a 320, for which our client has a method each."""

from __future__ import annotations

from typing import Any

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.layer.client import CompatibleClient
from cobotwire.pymycobot.layer.naming import naming
from cobotwire.pymycobot.layer.results import plain

# The methods that read one register, or write a value into it.
READ = {
    1: "get_hand_firmware_major_version",
    2: "get_hand_firmware_minor_version",
    4: "get_hand_gripper_id",
    12: "get_pro_gripper_angle",
    14: "get_pro_gripper_status",
    28: "get_pro_gripper_torque",
    33: "get_pro_gripper_speed",
}
WRITTEN = {
    3: "set_hand_gripper_id",
    10: "set_hand_gripper_enabled",
    11: "set_pro_gripper_angle",
    27: "set_pro_gripper_torque",
    32: "set_pro_gripper_speed",
    36: "set_pro_gripper_abs_angle",
}
# The methods that write 0 into one register.
SWITCHED = {
    13: "set_pro_gripper_calibration",
    37: "set_pro_gripper_pause",
    38: "set_pro_gripper_resume",
    39: "set_pro_gripper_stop",
}
# Registers of a joint of the hand. A reply that names no joint could belong to any of them.
OF_A_JOINT = {
    16: "get_hand_gripper_p",
    18: "get_hand_gripper_d",
    20: "get_hand_gripper_i",
    22: "get_hand_gripper_clockwise",
    24: "get_hand_gripper_counterclockwise",
    26: "get_hand_gripper_min_pressure",
}


class Registers(CompatibleClient):
    """Reads and writes registers by their numbers."""

    def get_pro_gripper(self, address: int, gripper_id: int = 14) -> Any:
        """Read a register of a gripper. Register 1 holds the firmware version in tenths.

        Raises:
            UsageError: an argument is not allowed, or each joint of the hand has the register; the
            message then names the method that takes the joint.
        """
        if address in OF_A_JOINT:
            message = f"register {address} belongs to a joint of the hand"
            message += f"; call {OF_A_JOINT[address]}(joint_id, gripper_id)"
            raise UsageError("address", address, message=message)
        if address in READ:
            return self._query(plain, getattr(self.arm, READ[address]), gripper_id)
        return self._query(plain, self.arm.get_pro_gripper, address, gripper_id)

    @naming(number="value", enabled="value", torque="value", speed="value")
    def set_pro_gripper(self, address: int, value: int, gripper_id: int = 14) -> Any:
        """Write a register of a gripper; some move it.

        Raises:
            UsageError: an argument is not allowed. The registers 13 and 37 to 39 take only 0.
        """
        if address in SWITCHED:
            if value != 0:
                raise UsageError("value", value, "0")
            return self._send_acked(getattr(self.arm, SWITCHED[address]), gripper_id)
        if address in WRITTEN:
            return self._send_acked(getattr(self.arm, WRITTEN[address]), value, gripper_id)
        return self._send_acked(self.arm.set_pro_gripper, address, value, gripper_id)
