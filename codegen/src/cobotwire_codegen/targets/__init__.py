"""Targets: the same protocol in other people's tools, each rendered from the model."""
