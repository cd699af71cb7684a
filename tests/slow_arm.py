"""An arm on a pseudo-terminal whose replies to get_encoder come late."""

from __future__ import annotations

import os
import select
import threading
import time
import tty


def encoder_reply(joint: int) -> bytes:
    return bytes.fromhex("FE FE 04 3B 00") + bytes([joint]) + b"\xfa"


class SlowArm:
    """An arm that replies to get_encoder(joint) with the joint's number, after its delay."""

    def __init__(self, delays: dict[int, float]) -> None:
        self._delays = delays
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self.url = os.ttyname(self._slave)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def _serve(self) -> None:
        due: list[tuple[float, bytes]] = []
        while not self._stop.is_set():
            if select.select([self._master], [], [], 0.005)[0]:
                request = os.read(self._master, 4096)
                if request[3] == 0x3B:
                    delay = self._delays.get(request[4], 0)
                    due.append((time.monotonic() + delay, encoder_reply(request[4])))
            for entry in [entry for entry in due if entry[0] <= time.monotonic()]:
                due.remove(entry)
                os.write(self._master, entry[1])

    def close(self) -> None:
        self._stop.set()
        self._thread.join()
        os.close(self._master)
        os.close(self._slave)
