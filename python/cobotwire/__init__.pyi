"""The names of the package for type checkers and editors; ``__init__.py`` imports them late."""

from cobotwire.client.aio_dead_man import AsyncDeadMan as AsyncDeadMan
from cobotwire.client.aio_two_arms import AsyncTwoArms as AsyncTwoArms
from cobotwire.client.dead_man import DeadMan as DeadMan
from cobotwire.client.two_arms import TwoArms as TwoArms
from cobotwire.codec import chosen
from cobotwire.editions.clients import *  # noqa: F403  (the names of its __all__)
from cobotwire.inspect.identification import connect as connect
from cobotwire.inspect.identification import connect_async as connect_async
from cobotwire.inspect.identification import identify as identify
from cobotwire.protocol.errors import CaptureError as CaptureError
from cobotwire.protocol.errors import CobotwireError as CobotwireError
from cobotwire.protocol.errors import EditionUnknown as EditionUnknown
from cobotwire.protocol.errors import FollowFailed as FollowFailed
from cobotwire.protocol.errors import LinkError as LinkError
from cobotwire.protocol.errors import MotionTimeout as MotionTimeout
from cobotwire.protocol.errors import ProtocolError as ProtocolError
from cobotwire.protocol.errors import ReplyTimeout as ReplyTimeout
from cobotwire.protocol.errors import RequestRefused as RequestRefused
from cobotwire.protocol.errors import UsageError as UsageError
from cobotwire.protocol.joints import Joint as Joint
from cobotwire.protocol.limits import Limits as Limits
from cobotwire.session.paths import FollowReport as FollowReport
from cobotwire.session.paths import PathLimits as PathLimits
from cobotwire.session.paths import Waypoint as Waypoint
from cobotwire.session.pending import RetryPolicy as RetryPolicy
from cobotwire.session.sample import Sample as Sample
from cobotwire.session.sample import StreamReport as StreamReport

codec_in_use = chosen
__version__: str
