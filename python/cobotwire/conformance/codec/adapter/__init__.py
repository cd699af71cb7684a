"""Implementations of the line protocol that come with cobotwire.

python -m cobotwire.conformance.codec.adapter native|reference|pymycobot
"""
