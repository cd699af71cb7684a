"""The rules for what a client sends, one small function each."""

# Importing a module enters its rules, in this order.
from cobotwire.conformance.client.rules import frames, orders, turns, values
from cobotwire.conformance.client.rules.rule import RULES, Judgement, Rule

__all__ = ["RULES", "Judgement", "Rule", "frames", "orders", "turns", "values"]
