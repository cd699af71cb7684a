"""Compare the models of editions, not their text.

Every difference is a finding of one rule. Each rule has a level, and the levels determine the
version bump.
"""

from cobotwire_codegen.diff.editions import diff, diff_all
from cobotwire_codegen.diff.finding import Finding, bump, bump_before_1_0, fails
from cobotwire_codegen.diff.rules import LEVELS, RULES

__all__ = [
    "LEVELS",
    "RULES",
    "Finding",
    "bump",
    "bump_before_1_0",
    "diff",
    "diff_all",
    "fails",
]
