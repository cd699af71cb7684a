"""Generates a typed Python API, its reference and its tables from a protocol in YAML.

Data flows one way: ``load`` (YAML to nodes with file, line and column), ``build`` (nodes to the
model), ``check`` (the model against its rules), ``render`` (the model to text), ``emit`` (text to
files).
"""
