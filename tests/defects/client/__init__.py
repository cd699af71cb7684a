"""Independent clients: one in plain Python, from the document alone, and one in C.

Nothing in this folder imports the package that is tested.
"""
