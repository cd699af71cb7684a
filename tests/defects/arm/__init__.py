"""An arm in plain Python, written only from the document, that moves in time; and its planted
defects.

Nothing in this folder imports the package that is tested.
"""
