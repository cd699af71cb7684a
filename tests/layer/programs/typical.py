"""Use the maker's library as a typical program does."""

import sys
import time

from pymycobot import PI_BAUD, utils
from pymycobot.error import MyCobot280DataException
from pymycobot.genre import Angle, Coord
from pymycobot.mycobot280 import MyCobot280

mc = MyCobot280(sys.argv[1], PI_BAUD)
mc.power_on()
mc.set_color(0, 0, 255)
mc.send_angles([0, 10, 0, 0, 0, 0], 80, _async=True)
mc.send_angle(Angle.J1.value, 20, 90)
mc.sync_send_angles([20, 10, 0, 0, 0, 0], 90)
print("angles", [round(angle) for angle in mc.get_angles()])
print("powered", mc.is_power_on(), "version", mc.get_system_version())
print("axis", Coord.Rx.value, "ports", type(utils.get_port_list()).__name__)
try:
    mc.send_angle(1, 500, 50)
except MyCobot280DataException:
    print("rejected")
mc.wait(0.01).stop()
if sys.argv[2:] == ["fail"]:
    mc.send_angles([90, 0, 0, 0, 0, 0], 1)
    raise RuntimeError("a mistake in the program")
if sys.argv[2:] == ["forever"]:
    mc.send_angles([90, 0, 0, 0, 0, 0], 1)
    print("moving", flush=True)
    time.sleep(60)
