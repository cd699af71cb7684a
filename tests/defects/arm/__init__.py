"""An arm in plain Python, from the document alone, that moves in time; and its planted defects.

Nothing in this folder imports the package that is tested.
"""
