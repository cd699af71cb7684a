"""Does a codec, in whatever language, keep to an edition? Asked over standard input and output."""

from cobotwire.conformance.codec.expected import Expectation, read_expectations
from cobotwire.conformance.codec.implementation import Implementation, NoAnswer, Program
from cobotwire.conformance.codec.runner import Run
from cobotwire.conformance.codec.trials import Trial, derive

__all__ = [
    "Expectation",
    "Implementation",
    "NoAnswer",
    "Program",
    "Run",
    "Trial",
    "derive",
    "read_expectations",
]
