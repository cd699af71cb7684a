"""Test whether a codec, in any language, conforms to an edition, over its standard input."""

from cobotwire.conformance.codec.expected import Expectation, read_expectations
from cobotwire.conformance.codec.implementation import Implementation, NoAnswer, Program
from cobotwire.conformance.codec.options import CodecOptions
from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.codec.runner import Run
from cobotwire.conformance.codec.suite import SUITE, derive_questions

__all__ = [
    "SUITE",
    "CodecOptions",
    "Expectation",
    "Implementation",
    "NoAnswer",
    "Program",
    "Question",
    "Run",
    "derive_questions",
    "read_expectations",
]
