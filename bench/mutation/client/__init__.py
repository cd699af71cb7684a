"""Clients that are broken in one place each, for the referee to find."""
