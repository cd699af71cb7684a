"""For other people's tests: a pytest plugin that gives them simulated arms; docs/testing.md."""
