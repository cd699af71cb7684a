"""A scripted peer that counts: it takes what it hears apart into frames, and answers each."""

from __future__ import annotations

import os
import time

from field_notes.case import Case, Script
from scripted_peer import ScriptedPeer, ScriptedTcpPeer, _Peer

HEADER = b"\xfe\xfe"


class _Counting(_Peer):
    """Plays a case. Mixed into a peer that has a line."""

    def __init__(self, case: Case) -> None:
        super().__init__()
        self.frames: list[bytes] = []
        self.garbled = 0
        self._case = case
        self._rest = b""

    def settle(self, frames: int | None) -> None:
        """Wait until so many frames were heard, and a moment longer for those too many."""
        until = time.monotonic() + 1
        while len(self.frames) < (frames or 0) and time.monotonic() < until:
            time.sleep(0.002)
        time.sleep(0.01)

    def _play(self) -> None:
        while not self._stop:
            if self._case.deaf:
                time.sleep(0.02)
                continue
            data = self._hear()
            if not data:
                time.sleep(0.001)
            self.heard += data
            for frame in self._taken_apart(data):
                number = len(self.frames)
                self.frames.append(frame)
                if not self._perform(self._case.answer(frame, number)):
                    return

    def _taken_apart(self, data: bytes) -> list[bytes]:
        """By header and length alone, as the firmware does; what is no frame is counted."""
        self._rest += data
        frames = []
        while len(self._rest) >= 3:
            if not self._rest.startswith(HEADER):
                self._rest, self.garbled = self._rest[1:], self.garbled + 1
                continue
            size = self._rest[2] + 3
            if len(self._rest) < size:
                break
            frames.append(self._rest[:size])
            self._rest = self._rest[size:]
        return frames

    def _perform(self, script: Script) -> bool:
        for step in script:
            if step is None:
                self.unplug()
                return False
            if isinstance(step, bytes):
                self.say(step)
            else:
                time.sleep(step)
        return True


class CountingPtyPeer(_Counting, ScriptedPeer):
    """On a pseudo-terminal; left as the system makes it (XON/XOFF and all) where the case says."""

    def __init__(self, case: Case) -> None:
        super().__init__(case)
        if case.cooked:
            os.close(self._master)
            os.close(self._slave)
            self._master, self._slave = os.openpty()
            self.url = os.ttyname(self._slave)


class CountingTcpPeer(_Counting, ScriptedTcpPeer):
    """Over TCP; each step of bytes is a packet of its own."""


COUNTING_PEERS = {"pty": CountingPtyPeer, "tcp": CountingTcpPeer}
