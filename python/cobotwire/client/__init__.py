"""Run the session's exchange over a transport, for blocking programs and (``aio``) for asyncio."""

from cobotwire.client.blocking import Client
from cobotwire.session import Traffic

__all__ = ["Client", "Traffic"]
