"""Measure how many planted defects are found, and how many messages name the cause."""
