"""Test whether a codec conforms to an edition; it may be a program in any language."""

from cobotwire.conformance.codec.implementation import Implementation, NoAnswer, Program
from cobotwire.conformance.codec.options import CodecOptions
from cobotwire.conformance.codec.questions.question import Question
from cobotwire.conformance.codec.runner import Run
from cobotwire.conformance.codec.suite import SUITE, derive_questions
from cobotwire.conformance.expected import Expectation, read_expectations

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
