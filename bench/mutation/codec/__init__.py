"""Codecs that are broken in one place each, for the runner to find."""
