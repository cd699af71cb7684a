"""The clients: thin loops between a transport and the exchange; ``aio`` is the one for asyncio."""

from cobotwire.client.blocking import Client
from cobotwire.session import Traffic

__all__ = ["Client", "Traffic"]
