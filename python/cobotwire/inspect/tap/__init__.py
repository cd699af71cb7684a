"""Pass bytes between a program and an arm, in a process that does nothing else, and show them.

program <-> pty or TCP -- Forwarder -- port <-> arm
                              | Copies: a pipe that never makes the forwarder wait
                 WatchingProcess: recording, lines
"""
