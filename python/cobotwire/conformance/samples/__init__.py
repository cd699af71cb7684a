"""Derive from a table every value that test cases send or expect.

The kinds of values are: ordinary, corner, illegal, plain (the request that does the least),
harmless, and revealing (a wrong scale, sign or order changes them). All testers use them.
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
