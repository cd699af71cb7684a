"""Test whether a client conforms to an edition: a simulated arm checks every byte."""

from cobotwire.conformance.client.delivery import FAULTS, faulty_replies, possible_faults
from cobotwire.conformance.client.options import ClientOptions
from cobotwire.conformance.client.referee import Referee
from cobotwire.conformance.client.script import ScriptLine
from cobotwire.conformance.client.suite import SUITE

__all__ = [
    "FAULTS",
    "SUITE",
    "ClientOptions",
    "Referee",
    "ScriptLine",
    "faulty_replies",
    "possible_faults",
]
