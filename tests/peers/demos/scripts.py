"""The maker's programs that are run, and why the others are not."""

from __future__ import annotations

from typing import NamedTuple

REPOSITORY = "https://github.com/elephantrobotics/pymycobot"
# The commit of the demos in the table.
COMMIT = "44d7fb1"
# The folders whose programs are listed here.
FOLDERS = ("demo", "tests")


class Demo(NamedTuple):
    """A program of the maker.

    Attributes:
        path: its file in the repository.
        edition: our edition of the robot that it drives.
        typed: lines that a person types.
        keys: keys that a person presses afterwards, one after another.
        is_test: whether it is run by pytest.
        refused: why our layer rejects what the library sends; empty if it does not.
    """

    path: str
    edition: str = "mycobot280"
    typed: str = ""
    keys: str = ""
    is_test: bool = False
    refused: str = ""


# What a person types for port_setup: the number of the port, the speed, debugging.
_CHOSEN = "1\n\nn\n"
# Record, stop, save, load, play, release, quit.
_TEACHING = "rcslpfqqq"
_MYARM = (
    *("all_run_test", "dexterous_hands", "four_piece_chess", "gripper_aikit_v2", "hand_gripper"),
    *("myarm_agv_demo", "pump_aikit_v2", "pump_test", "rgb_led", "rgb_test", "space_arm_angle"),
    *("start_run_demo", "wave_hand", "xiaqi"),
)
_ACTIONS = (
    *("ChewingGum", "catch_the_ball", "comeOn", "dack", "pass_the_ball", "petCat"),
    *("piano", "play_ball_cooperatively", "praise", "reject", "symphony", "thanHeart"),
)
_BEYOND = "sends joint 1 to 180 degrees, beyond the 165 that the maker lists"
_BUDDY = "demo/mybuddy_demo/"
DEMOS = [
    Demo("demo/Client.py"),
    Demo("demo/basic.py", typed=_CHOSEN),
    Demo("demo/drag_trial_teaching.py", typed=f"1\n\n{_CHOSEN}", keys=_TEACHING),
    Demo("demo/drag_trial_teaching_myArm.py", "myarm300", typed="1\nn\n", keys=_TEACHING),
    Demo("demo/gripper.py", typed=_CHOSEN),
    Demo("demo/gripper_set.py"),
    Demo("demo/loop.py", typed=_CHOSEN),
    Demo("demo/pid_read_write.py"),
    Demo("demo/reader.py", typed=_CHOSEN),
    Demo("demo/send_angle.py", typed=f"{_CHOSEN}50\n10,20,30,0,0,0\n0,0,0,0,0,0\n"),
    Demo("demo/sync.py", typed=_CHOSEN),
    Demo("demo/tools/pump_demo_M5.py"),
    Demo("demo/tools/pump_demo_PI.py"),
    Demo("demo/myCobot_280_demo/280_draw_gcode.py", typed="1\n4\n"),
    Demo(
        "demo/myCobot_320_demo/drag_trial_teaching_myCobot_320.py",
        "mycobot320",
        typed=_CHOSEN,
        keys=_TEACHING,
    ),
    Demo("demo/myCobot_320_demo/myCobot_320_servo_info.py", "mycobot320"),
    *(Demo(f"demo/myArm_demo/{name}.py", "myarm300") for name in _MYARM),
    Demo("demo/myBuddy_set_PID_CN.py", "mybuddy", typed="1\n"),
    Demo("demo/myBuddy_set_PID_EN.py", "mybuddy", typed="4\n"),
    Demo(f"{_BUDDY}drag_trial_teaching_mubuddy.py", "mybuddy", typed=_CHOSEN, keys=_TEACHING),
    Demo(f"{_BUDDY}drag_trial_teaching_sync_mubuddy.py", "mybuddy", keys=_TEACHING),
    Demo(f"{_BUDDY}gpio_test.py", "mybuddy"),
    Demo(f"{_BUDDY}myBuddy_gpio_test.py", "mybuddy"),
    Demo(f"{_BUDDY}mybuddy_change_pid.py", "mybuddy"),
    Demo(f"{_BUDDY}mybuddy_encoders_test.py", "mybuddy"),
    Demo(f"{_BUDDY}mybuddy_send_angles_auto.py", "mybuddy"),
    *(Demo(f"{_BUDDY}myBuddy_Action/{name}.py", "mybuddy") for name in _ACTIONS),
    Demo(f"{_BUDDY}myBuddy_Action/dance.py", "mybuddy", refused=_BEYOND),
    Demo("tests/special_angles.py"),
    Demo("tests/test_api.py", typed=_CHOSEN, is_test=True),
    Demo("tests/test_socket.py"),
    Demo("tests/test_utils.py"),
]

_WINDOW = "opens a window"
# Programs that are not run, by a pattern of their paths, and why; the first pattern counts.
NOT_RUN = {
    "demo/[Ss]erver*.py": "is a server for the computer in the robot; it uses no class",
    "demo/change_pid.py": _WINDOW,
    "demo/drag_trial_teaching_cobotx.py": "uses the class CobotX, which the library no longer has",
    "demo/get_port.py": "uses no class",
    "demo/handle_control/*": "needs a gamepad",
    "demo/myAGVPro_Composite_Kit/*": "needs a gamepad and a vehicle",
    "demo/myArm_M&C_demo/myarm_[cm].py": "is one of two programs that talk to each other",
    "demo/myArm_M&C_demo_v1.1/myarm_[cm].py": "is one of two programs that talk to each other",
    "demo/myArm_M&C_demo/utils.py": "uses no class",
    "demo/myArm_M&C_demo*": _WINDOW,
    "demo/myArm_demo/myarm_handle_control.py": "needs a gamepad",
    "demo/myCobot_320_demo/*testtool*": _WINDOW,
    "demo/mybuddy_demo/mybuddy_emoticon_demo.py": "plays videos on the robot's display only",
    "demo/mybuddy_emo.py": "plays videos on the robot's display only",
    "demo/mycobot_pi_bluetooth/*": "needs Bluetooth",
    "demo/port_setup.py": "is a part of other demos",
    "demo/pro630_3D_Kit_Code/*": "uses ElephantRobot, a text protocol without an edition",
    "demo/ultraArm_P340_demo/*": "uses ultraArmP340, a text protocol without an edition",
    "tests/*_gui.py": _WINDOW,
    "tests/__init__.py": "is empty",
    "tests/conftest.py": "is empty",
    "tests/test_generator.py": "uses MyCobotCommandGenerator, which the library no longer has",
}
