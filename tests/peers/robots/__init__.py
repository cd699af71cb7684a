"""Compare the maker's classes with our editions, and let them drive our simulated robots.

``classes`` has a module for each class. ``python -m robots`` prints the table of ``make robots``.
"""
