"""The suites that `make conform` runs."""

from __future__ import annotations

from collections.abc import Callable

from cobotwire.editions import mycobot, mycobot280
from mutation.client.suite import ClientSuite
from mutation.codec.suite import CodecSuite
from mutation.device.suite import DeviceSuite
from mutation.suite import Suite

SUITES: tuple[Callable[[], Suite], ...] = (
    lambda: DeviceSuite(mycobot.TABLE),
    lambda: DeviceSuite(mycobot280.TABLE),
    lambda: ClientSuite(mycobot.TABLE, with_script=True),
    lambda: ClientSuite(mycobot280.TABLE, with_script=True),
    lambda: ClientSuite(mycobot280.TABLE, with_script=False),
    lambda: CodecSuite(mycobot.TABLE),
    lambda: CodecSuite(mycobot280.TABLE),
)
