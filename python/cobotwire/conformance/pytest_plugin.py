"""``pytest --conform-device URL``: every test case for every command of an edition is a test.

pytest --conform-device /dev/ttyUSB0 --conform-edition mycobot280 --conform-allow setting
"""

from __future__ import annotations

import pytest

HELP = "Conformance of a device (cobotwire)"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options; without the first of them nothing is collected."""
    group = parser.getgroup("conform", HELP)
    group.addoption("--conform-device", metavar="URL", help="Test the device at URL.")
    group.addoption("--conform-edition", help="The edition [mycobot280].")
    group.addoption("--conform-allow", default="", help="Permissions, separated by commas.")
    group.addoption("--conform-max-speed", type=int, help="Percent; motion needs it.")
    group.addoption("--conform-workspace", help="LOW:HIGH in degrees; motion needs it.")


def pytest_collection_modifyitems(
    session: pytest.Session, config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Add the tests of the device after the others."""
    if config.getoption("--conform-device"):
        # Imported here because pytest loads this module in every run.
        from cobotwire.conformance.pytest_items import DeviceUnderTest
        from cobotwire.protocol.errors import CobotwireError

        try:
            device = DeviceUnderTest(config)
        except CobotwireError as error:
            raise pytest.UsageError(str(error)) from error
        config.add_cleanup(device.close)
        items.extend(device.items(session))
