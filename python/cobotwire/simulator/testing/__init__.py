"""A pytest plugin that provides simulated arms for your tests; see docs/testing.md."""
