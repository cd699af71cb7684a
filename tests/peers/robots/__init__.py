"""Describe the maker's classes for comparisons, and let them drive our simulated robots.

``classes`` has a module for each class.
"""
