"""Helps editors: problems, hover, completion and definitions, without any protocol.

``server`` offers them by the Language Server Protocol; it is the only importer of that library.
"""
