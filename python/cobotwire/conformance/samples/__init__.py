"""Derive from a table every value that test cases send or expect.

Values are ordinary, corners, illegal, plain (the request that does the least), harmless, or
revealing: a wrong scale, sign or order changes them. All testers use them.
"""

from cobotwire.conformance.samples.physical import named_values, physical_values
from cobotwire.conformance.samples.raw import illegal_samples, ordinary, plainest, samples

__all__ = [
    "illegal_samples",
    "named_values",
    "ordinary",
    "physical_values",
    "plainest",
    "samples",
]
