"""Code that must not type-check: each line that ends in `# wrong` is an error, and no other."""

import cobotwire
from cobotwire import AsyncMyArm300, AsyncMyCobot, MyArm300, MyCobot
from cobotwire.editions.mycobot import GetAngles, GetEncoder


def drive(arm: MyCobot) -> None:
    """Make the mistakes that a type checker must catch."""
    arm.send_angles("000000", speed=30)  # wrong
    arm.send_angles([0, 0, 0, 0, 0, 0])  # wrong
    arm.send_angles([0, 0, 0, 0, 0, 0], speed=2.5)  # wrong
    arm.send_angle(1, None, 20)  # wrong
    arm.send_angle(joint_id=1, angle=0, speed=20)  # wrong
    arm.set_free_mode("on")  # wrong
    arm.set_end_type("TOOL")  # wrong
    arm.get_angels()  # wrong
    angles: list[float] = arm.get_angles()  # wrong
    print(arm.get_coords().w)  # wrong
    print(cobotwire.Nothing)  # wrong
    print(angles)
    arm.power_on(ack_within=1.0)  # wrong
    arm.move_angles([0, 0, 0, 0, 0, 0], 30, 5)  # wrong
    arm.stream(GetAngles())  # wrong
    arm.stream(GetEncoder(2), 50)  # wrong
    arm.stream("get_angles", rate=50)  # wrong
    for sample in arm.stream(GetAngles(), GetEncoder(2), rate=50):
        print(sample.angles)  # wrong
        number: str = sample[GetEncoder(2)]  # wrong
        print(number, sample[GetAngles()].j7)  # wrong
        print(sample["get_angles"])  # wrong


async def drive_async(arm: AsyncMyCobot) -> None:
    """Forget await and async, the most frequent mistakes."""
    print(arm.get_angles().j1)  # wrong
    await arm.send_angles("000000", 30)  # wrong
    for sample in arm.stream(GetAngles(), rate=50):  # wrong
        print(sample)


def drive_delta(arm: MyArm300) -> None:
    """Use what a delta withdraws, and give the wrong arguments to a method of its base."""
    arm.jog_stop()  # wrong
    arm.get_angles_plan()  # wrong
    arm.set_HTS_gripper_torque("strong")  # wrong
    arm.get_movement_type(1)  # wrong


async def drive_delta_async(arm: AsyncMyArm300) -> None:
    """Make the same mistakes with the asyncio client."""
    await arm.jog_stop()  # wrong
    await arm.set_HTS_gripper_torque("strong")  # wrong
    arm.resume()  # wrong
    mode: int = await arm.is_paused(1)  # wrong
    print(mode)


def find(port: str) -> None:
    """Use methods that only some editions have, and assume the client of one edition."""
    arm = cobotwire.connect(port)
    arm.get_atom_version()  # wrong
    one: MyCobot = arm  # wrong
    print(one)


def two_arms() -> None:
    """Mix up classes and options of two arms."""
    robot = cobotwire.TwoArms(cobotwire.MercuryX1, "/dev/left_arm", "/dev/right_arm")
    left: MyCobot = robot.left  # wrong
    print(left, robot.middle)  # wrong
    cobotwire.TwoArms(cobotwire.AsyncMercuryX1, "/dev/left_arm", "/dev/right_arm")  # wrong
    cobotwire.TwoArms(cobotwire.MercuryX1, "/dev/left_arm", "/dev/right_arm", speed=1)  # wrong
