"""Does a client keep to the protocol? An arm that judges every byte which it is sent."""

from cobotwire.conformance.client.manners import MISDEEDS, Manners
from cobotwire.conformance.client.referee import Referee
from cobotwire.conformance.client.script import Told

__all__ = ["MISDEEDS", "Manners", "Referee", "Told"]
