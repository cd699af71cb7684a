"""Codecs with one fault each, which the runner must find."""
