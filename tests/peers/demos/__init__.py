"""Run the maker's public demos with the maker's library, with our layer, and rewritten.

The demos are fetched for the run; they are not part of this project.
"""
