"""Clients with one fault each, which the referee must find."""
