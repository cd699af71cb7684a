"""Import what this package uses of LeRobot 0.4.4 to 0.6.1; no other module imports LeRobot."""

from lerobot.cameras import CameraConfig as CameraConfig
from lerobot.cameras import make_cameras_from_configs as make_cameras_from_configs
from lerobot.robots import Robot as Robot
from lerobot.robots import RobotConfig as RobotConfig
from lerobot.teleoperators import Teleoperator as Teleoperator
from lerobot.teleoperators import TeleoperatorConfig as TeleoperatorConfig
from lerobot.utils.errors import DeviceAlreadyConnectedError as DeviceAlreadyConnectedError
from lerobot.utils.errors import DeviceNotConnectedError as DeviceNotConnectedError
