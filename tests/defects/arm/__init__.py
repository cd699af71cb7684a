"""A simulated arm in plain Python, written only from the document, and its planted defects.

Nothing in this folder imports the package that is tested.
"""
