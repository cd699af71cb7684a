"""Code that must type-check."""

from cobotwire import MyCobot
from cobotwire.editions.mycobot import Angles, Axis, Coords, ReferenceFrame, WifiAccount


def drive(arm: MyCobot) -> None:
    """What a user writes."""
    arm.send_angles([0, 0, 0, 0, 0, 0], speed=30)
    arm.send_angles((0.5, 0, 0, 0, 0, 0), 30)
    arm.send_angles(arm.get_angles(), 30)
    arm.send_coord(Axis.RX, 10.5, speed=20)
    arm.set_reference_frame(1)
    angles: Angles = arm.get_angles()
    x: float = arm.get_coords().x
    coords: Coords = arm.get_tool_reference()
    frame: ReferenceFrame = arm.get_reference_frame()
    powered: bool = arm.is_power_on()
    account: WifiAccount = arm.get_ssid_pwd()
    print(angles.j1 + x, coords, frame, powered, account.ssid)
    with MyCobot("/dev/ttyACM0", baudrate=1_000_000) as other:
        encoder: int = other.get_encoder(2)
        print(encoder)
