"""Code that must type-check."""

from cobotwire import (
    AsyncMercuryX1,
    AsyncMyArm300,
    AsyncMyCobot,
    AsyncTwoArms,
    Limits,
    MercuryX1,
    MyArm300,
    MyCobot,
    MyPalletizer260,
    RetryPolicy,
    Sample,
    StreamReport,
    TwoArms,
    connect,
    connect_async,
)
from cobotwire.editions.mercury_a1 import PowerState
from cobotwire.editions.mycobot import (
    Angles,
    Axis,
    Coords,
    GetAngles,
    GetEncoder,
    ReferenceFrame,
    WifiAccount,
)
from cobotwire.editions.mycobot280 import AsyncMyCobot280, MyCobot280


def drive(arm: MyCobot) -> None:
    """Call methods as users do."""
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


def wait(arm: MyCobot280) -> None:
    """Wait for motions and acknowledgements."""
    arm.move_angles([0, 0, 0, 0, 0, 0], 30, timeout=5)
    arm.move_coords(arm.get_coords(), 30, wait=False)
    arm.set_color(1, 2, 3, ack_within=0.5)
    limits = Limits(joints=[(-90, 90), None, None, None, None, None], wider=True)
    MyCobot280("/dev/ttyACM0", limits=limits, retry=RetryPolicy(attempts=1)).close()


def sample(arm: MyCobot) -> StreamReport:
    """Sample several queries."""
    with arm.stream(GetAngles(), GetEncoder(2), rate=50, timeout=0.1) as stream:
        for one in stream:
            seen: Sample = one
            print(seen.number, one.replied_at - one.requested_at, one[GetEncoder(2)])
            angles: Angles = one[GetAngles()]
            encoder: int = one.reading(GetEncoder(2)).value
            print(angles.j1 + encoder)
    return stream.report


async def sample_async(arm: AsyncMyCobot) -> float:
    """Sample several queries with the asyncio client."""
    stream = arm.stream(GetAngles(), rate=50)
    async for one in stream:
        print(one.values, one.reading(GetAngles()).replied_at)
    return stream.report.reached


async def drive_async(port: str) -> float:
    """Call methods of the asyncio client as users do."""
    async with AsyncMyCobot(port) as arm:
        await arm.send_angles(await arm.get_angles(), 30)
    async with AsyncMyCobot280(port, timeout=1.0) as other:
        await other.move_angles([0, 0, 0, 0, 0, 0], 30)
        angles: Angles = await arm.get_angles()
    return angles.j1


class GuardedArm(MyArm300):
    """A client with overrides of methods that the delta takes from its base."""

    def is_paused(self) -> bool:
        """Check twice."""
        return super().is_paused() and super().is_paused()


class GuardedAsyncArm(AsyncMyArm300):
    """The same calls on asyncio."""

    async def is_paused(self) -> bool:
        """Check twice."""
        return await super().is_paused() and await super().is_paused()


async def find(port: str) -> float:
    """Use the client of whatever edition an arm speaks."""
    async with await connect_async(port) as found:
        powered: bool | PowerState = await found.is_power_on()
    with connect(port, timeout=1.0) as arm:
        arm.stop()
        print(powered, arm.get_angles()[0])
        if isinstance(arm, MyPalletizer260):
            return arm.get_coords().x
        return arm.get_angles()[3] if isinstance(arm, MyCobot280) else 0.0


def two_arms() -> None:
    """Open both arms of a robot."""
    with TwoArms(MercuryX1, "/dev/left_arm", "/dev/right_arm", timeout=1.0) as robot:
        left: MercuryX1 = robot.left
        print(left.get_angles().j7, robot.right.get_angles().j7)


async def two_arms_async() -> None:
    """Open both arms of a robot with asyncio."""
    async with AsyncTwoArms(AsyncMercuryX1, "/dev/left_arm", "/dev/right_arm") as robot:
        print((await robot.right.get_angles()).j7)
