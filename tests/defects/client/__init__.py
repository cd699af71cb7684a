"""Independent clients: one in plain Python, written only from the document, and one in C.

Nothing in this folder imports the package that is tested.
"""
