"""Stand in for OpenCV, by which demos play videos on the robot's display: no video has a frame."""

import time
from typing import Any

WINDOW_NORMAL = WND_PROP_FULLSCREEN = WINDOW_FULLSCREEN = 0


class VideoCapture:
    def __init__(self, *arguments: Any) -> None:
        """Open nothing."""

    def read(self) -> tuple[bool, None]:
        return False, None

    def release(self) -> None:
        """Do nothing: nothing is open."""


def waitKey(*arguments: Any) -> int:
    time.sleep(1)
    return 255


def nothing(*arguments: Any) -> None:
    """Show nothing."""


namedWindow = setWindowProperty = imshow = destroyAllWindows = nothing
