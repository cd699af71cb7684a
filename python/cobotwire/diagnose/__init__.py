"""Diagnose noise: servo packets, firmware text, reboots, echoes, damaged frames.

:class:`Diagnoser` takes the events of a framer, and returns frames and findings. It does no I/O.
"""

from cobotwire.diagnose import registry
from cobotwire.diagnose.diagnoser import Diagnoser, Item
from cobotwire.diagnose.findings import Finding, Span
from cobotwire.diagnose.registry import *  # noqa: F403 - the registry lists the classes of noise
from cobotwire.diagnose.summary import Summary, summarize

__all__ = ["Diagnoser", "Finding", "Item", "Span", "Summary", "summarize"]
__all__ += registry.__all__
