"""The tutorials, and the guides to the simulated arm, to tests, and to programs of pymycobot."""

from __future__ import annotations

from newcomer.website.planned import INSTALLED, Expected, NotRun, Plan, Program
from newcomer.website.plans.readme import SIM

# Replace the client class of another robot: it ignores the page's port and opens a simulated arm.
SIMULATED = """\
from cobotwire.editions import load
from cobotwire.simulator import PtyServer, RunningClock, SimulatedArm
def simulate(edition):
    module, clock = load(edition), RunningClock(50.0)
    class Simulated(module.CLIENT):
        def __init__(self, port, **options):
            self.server = PtyServer(SimulatedArm(module.TABLE, clock=clock, powered=True), clock)
            super().__init__(self.server.__enter__().url, **options)
    setattr(module, module.CLIENT.__name__, Simulated)
    return module
"""

DRIVE = Plan(
    programs={
        "from cobotwire.editions.mybuddy import MyBuddy": Program(
            f"{SIMULATED}\nsimulate('mybuddy')"
        ),
        "from cobotwire import TwoArms": Program("simulate('mercury_x1')", r"\AAngles\(j1=0\.0"),
        "for event in arm.events(MotionEnded, timeout=5):": Program(
            "MotionEnded = simulate('mercury_a1').MotionEnded\n"
            "arm = load('mercury_a1').MercuryA1('')\n"
            "arm.send_angle(1, 5, 100)\n",
            r"\A\S+\n\Z",
        ),
    }
)

SIMULATION = Plan(
    prepare="""
        printf '0 0 0 0 0 0 0\\n1 10 0 0 0 0 0\\n' > hand.txt
        cobotwire --edition mycobot280 call /dev/ttyACM0 get_angles --record arm.pcapng
    """,
    commands={
        "cobotwire sim": SIM,
        "cobotwire sim --tcp 127.0.0.1:9000": Expected(r"socket://127\.0\.0\.1:9000", served=True),
        "cobotwire sim --speed 10 --json": Expected(r'\{.*"/dev/pts/\d+"', served=True),
        "cobotwire sim --led hand.txt": SIM,
        "cobotwire plot arm.pcapng -o arm.svg": Expected(),
        "cobotwire plot arm.pcapng --pose -o pose.png": Expected(),
        "cobotwire sim --list-scenarios": Expected(r"late-replies"),
        "cobotwire sim --scenario merged-acks": SIM,
        "cobotwire sim --scenario ./monday.yaml --seed 7": SIM,
    },
    programs={
        "from cobotwire.editions.mycobot280 import TABLE": Program(output=r"get_angles|b'"),
        "from cobotwire import codec": Program(output=r"\A(.*\n)*Angles\(j1=0\.0"),
    },
)

STUDIO_PAGE = r"http://127\.0\.0\.1:\d+"
STUDIO = Plan(
    prepare="cobotwire call /dev/ttyACM0 get_angles --record arm.pcapng",
    commands={
        "pip install 'cobotwire[studio]'": INSTALLED,
        "cobotwire studio": Expected(STUDIO_PAGE, served=True),
        "cobotwire studio /dev/ttyACM0": Expected(STUDIO_PAGE, served=True),
        "cobotwire studio /dev/ttyACM0 --allow-motion": Expected(STUDIO_PAGE, served=True),
        "cobotwire studio arm.pcapng": Expected(STUDIO_PAGE, served=True),
        "cobotwire sim --tcp 127.0.0.1:9000": Expected(r"socket://127\.0\.0\.1:9000", served=True),
        "cobotwire studio socket://127.0.0.1:9000": NotRun("no arm is served there any longer"),
    },
)

ARMS = NotRun("its arms serve LeRobot, which needs torch: tests/adapters/lerobot/on_lerobot.py")
LEROBOT = Plan(
    commands={
        "pip install lerobot_robot_cobotwire": NotRun("it installs torch"),
        "cobotwire sim --powered --tcp 127.0.0.1:9001": ARMS,
        "cobotwire sim --powered --tcp 127.0.0.1:9002 --led hand.txt": ARMS,
        "cobotwire call socket://127.0.0.1:9001 get_angles": ARMS,
    },
)

ROS2 = Plan(
    commands={
        "pip install 'cobotwire[ros2]'": NotRun("not every machine has a wheel"),
        "cobotwire sim --tcp 127.0.0.1:9000": Expected(r"socket://127\.0\.0\.1:9000", served=True),
        "cobotwire ros2 socket://127.0.0.1:9000": NotRun("the extra is not installed"),
        "cobotwire ros2 socket://127.0.0.1:9000 --allow-motion": NotRun("as above"),
    },
    programs={"import rclpy": NotRun("ROS 2 is not installed")},
)

MCP = Plan(
    commands={
        "pip install 'cobotwire[mcp]'": INSTALLED,
    },
)

URDF = Plan(
    prepare="cobotwire urdf mycobot280 -o pro630.urdf",
    commands={
        "cobotwire urdf mycobot280 -o mycobot280.urdf": Expected("wrote mycobot280.urdf"),
        "cobotwire urdf mycobot280 --prefix left_ -o left.urdf": Expected("wrote left.urdf"),
        "pip install 'cobotwire[urdf]'": INSTALLED,
        "cobotwire --edition pro630 sim --geometry pro630.urdf": Expected(
            "unverified", served=True
        ),
        "cobotwire --edition pro630 studio --geometry pro630.urdf": Expected(
            STUDIO_PAGE, served=True
        ),
    },
)

TAP = Plan(
    {
        "cobotwire tap /dev/ttyACM0": Expected(r"/dev/pts/\d+", served=True),
        "cobotwire tap /dev/ttyACM0 --record run.pcapng": Expected(
            r"follow:run\.pcapng", served=True
        ),
        "cobotwire studio follow:run.pcapng": NotRun("the recording does not grow any longer"),
        "cobotwire monitor follow:run.pcapng": NotRun("the recording does not grow any longer"),
    }
)

PYMYCOBOT = Plan(
    programs={
        "from cobotwire import MyCobot280": Program(
            setup="with __import__('cobotwire').MyCobot280('/dev/ttyACM0') as arm: arm.power_on()",
            output=r"\A(9\.\d+|10\.\d+)\n",
        ),
        "angles = arm.get_angles()": Program(setup="arm = MyCobot280('/dev/ttyACM0')"),
    },
)

CLONE = "it is for a clone, and takes minutes"
SEARCHES = Plan(
    commands=dict.fromkeys(
        [
            "make nightly",
            'make nightly SEARCHES="fuzz layer"',
            "make fuzz",
            "make fuzz FUZZ_SECONDS=600",
            "make attack",
            "make attack ATTACK_SECONDS=600",
            "make attack CLIENT=rust",
            "make attack CLIENT=node",
            'make attack ATTACK="--profile late --seed 7"',
            "make figures-page",
            "make bench",
            "make bench-compare",
            "make bench-compare REV=main COMPARE=\"--rows 'scan|raw' --rounds 31\"",
            "make bench-archive",
            "make rust-asan",
        ],
        NotRun(CLONE),
    )
)
CONFIRM = Plan(
    commands={
        "cobotwire survey /dev/ttyACM0 -o survey.zip": NotRun("it needs an arm"),
        "cobotwire-gen evidence add survey.zip": NotRun(CLONE),
    }
)
ATTACK = Plan(commands={"make attack": NotRun(CLONE)})
C = Plan(
    commands={
        "arm-none-eabi-gcc -std=c99 -Os -mcpu=cortex-m0plus -mthumb -ffreestanding -fstack-usage"
        " -c targets/c/mycobot280/mycobot280.c && arm-none-eabi-size mycobot280.o": NotRun(
            "it needs a compiler for Arm; tests/targets/c runs it"
        )
    }
)
TARGETS = Plan(
    commands={
        "cobotwire-gen render commands.csv.j2 spec/editions/mycobot280.yaml --out commands.csv": (
            Expected()
        )
    }
)
