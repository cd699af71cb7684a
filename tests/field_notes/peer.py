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
        self._silences = 0

    def settle(self) -> None:
        """Wait until all that was written has been heard and answered; a client wrote it before."""
        until = time.monotonic() + 3
        silences = self._silences + 2
        while self._silences < silences and self._thread.is_alive() and not self._case.deaf:
            if time.monotonic() > until:
                return
            time.sleep(0.002)

    def _play(self) -> None:
        while not self._stop:
            if self._case.deaf:
                time.sleep(0.02)
                continue
            data = self._hear()
            if not data:
                # Over TCP, a client that is gone is silent at once.
                time.sleep(0.001)
                self._silences += 1
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
