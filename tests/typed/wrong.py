"""Code that must not type-check: each line that ends in `# type: ignore`, and no other."""

import cobotwire
from cobotwire import AsyncMyArm300, AsyncMyCobot, MyArm300, MyCobot
from cobotwire.client import Client
from cobotwire.editions.mycobot import (
    GetAngles,
    GetAnglesReply,
    GetEncoder,
    GetEncoderReply,
    SendAngles,
)


def drive(arm: MyCobot) -> None:
    """Make the mistakes that a type checker must catch."""
    arm.send_angles("000000", speed=30)  # type: ignore
    arm.send_angles([0, 0, 0, 0, 0, 0])  # type: ignore
    arm.send_angles([0, 0, 0, 0, 0, 0], speed=2.5)  # type: ignore
    arm.send_angle(1, None, 20)  # type: ignore
    arm.send_angle(joint_id=1, angle=0, speed=20)  # type: ignore
    arm.set_free_mode("on")  # type: ignore
    arm.set_end_type("TOOL")  # type: ignore
    arm.get_angels()  # type: ignore
    angles: list[float] = arm.get_angles()  # type: ignore
    print(arm.get_coords().w)  # type: ignore
    print(cobotwire.Nothing)  # type: ignore
    print(angles)
    arm.power_on(ack_within=1.0)  # type: ignore
    arm.move_angles([0, 0, 0, 0, 0, 0], 30, 5)  # type: ignore
    arm.stream(GetAngles())  # type: ignore
    arm.stream(GetEncoder(2), 50)  # type: ignore
    arm.stream("get_angles", rate=50)  # type: ignore
    for sample in arm.stream(GetAngles(), GetEncoder(2), rate=50):
        print(sample.angles)  # type: ignore
        number: str = sample[GetEncoder(2)]  # type: ignore
        print(number, sample[GetAngles()].j7)  # type: ignore
        print(sample["get_angles"])  # type: ignore


async def drive_async(arm: AsyncMyCobot) -> None:
    """Forget await and async, the most frequent mistakes."""
    print(arm.get_angles().j1)  # type: ignore
    await arm.send_angles("000000", 30)  # type: ignore
    for sample in arm.stream(GetAngles(), rate=50):  # type: ignore
        print(sample)


def drive_delta(arm: MyArm300) -> None:
    """Use commands that a delta removes, and give the wrong arguments to a method of its base."""
    arm.jog_stop()  # type: ignore
    arm.get_angles_plan()  # type: ignore
    arm.set_HTS_gripper_torque("strong")  # type: ignore
    arm.get_movement_type(1)  # type: ignore


async def drive_delta_async(arm: AsyncMyArm300) -> None:
    """Make the same mistakes with the asyncio client."""
    await arm.jog_stop()  # type: ignore
    await arm.set_HTS_gripper_torque("strong")  # type: ignore
    arm.resume()  # type: ignore
    mode: int = await arm.is_paused(1)  # type: ignore
    print(mode)


def find(port: str) -> None:
    """Use methods that only some editions have, and assume the client of one edition."""
    arm = cobotwire.connect(port)
    arm.get_atom_version()  # type: ignore
    one: MyCobot = arm  # type: ignore
    print(one)


def two_arms() -> None:
    """Mix up classes and options of two arms."""
    robot = cobotwire.TwoArms(cobotwire.MercuryX1, "/dev/left_arm", "/dev/right_arm")
    left: MyCobot = robot.left  # type: ignore
    print(left, robot.middle)  # type: ignore
    cobotwire.TwoArms(cobotwire.AsyncMercuryX1, "/dev/left_arm", "/dev/right_arm")  # type: ignore
    cobotwire.TwoArms(cobotwire.MercuryX1, "/dev/left_arm", "/dev/right_arm", speed=1)  # type: ignore


def requests(client: Client) -> None:
    """Pass wrong arguments: types, number and names."""
    GetEncoder()  # type: ignore
    GetEncoder("2")  # type: ignore
    GetEncoder(2, 3)  # type: ignore
    GetEncoder(servo=2)  # type: ignore
    SendAngles([0, 0, 0, 0, 0, 0], speed="fast")  # type: ignore
    GetEncoder(2).joint = 3  # type: ignore
    print(GetEncoder(2).servo)  # type: ignore
    text: str = client._call(GetEncoder(2))  # type: ignore
    print(client._call(GetAngles()).j7)  # type: ignore
    client._send(GetAngles())  # type: ignore
    client._call(GetEncoderReply(2))  # type: ignore
    print(text)


def replies(reply: GetEncoderReply | GetAnglesReply) -> None:
    """Misuse fields of replies, also after a match."""
    print(reply.encoder)  # type: ignore
    GetAnglesReply(1)  # type: ignore
    match reply:
        case GetEncoderReply(encoder):
            print(encoder.j1)  # type: ignore
        case GetAnglesReply(angles):
            print(angles.x)  # type: ignore
