"""Run a session over a transport: blocking, or in the modules ``aio*`` on asyncio."""

from cobotwire.client.blocking import Client
from cobotwire.session import Traffic

__all__ = ["Client", "Traffic"]
