"""The drivers: thin loops between a link and the conversation; ``aio`` is the one for asyncio."""

from cobotwire.driver.blocking import Driver
from cobotwire.session import Traffic

__all__ = ["Driver", "Traffic"]
