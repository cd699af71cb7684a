"""Read what other programs wrote: dumps, logs, and captures of networks and logic analysers.

A reader turns a file into chunks of bytes. :mod:`.recognising` chooses it, and turns its chunks
into the blocks of a recording, for all readers of recordings.
"""
