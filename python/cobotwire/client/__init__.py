"""The clients: thin loops between a transport and the exchange; ``aio`` is the one for asyncio."""

from cobotwire.client.blocking import Client
from cobotwire.protocol.light import TYPE_CHECKING

if TYPE_CHECKING:
    from cobotwire.session import Traffic as Traffic
else:
    from cobotwire.protocol.lazy import lazy_names

    __getattr__, __dir__ = lazy_names(__name__, {"cobotwire.session": ["Traffic"]}, ())

__all__ = ["Client", "Traffic"]
