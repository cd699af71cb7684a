"""A web page that shows an arm, its line and recordings, served on the loopback interface.

:func:`cobotwire.studio.serving.serve` runs the server. It needs the extra ``studio``.
"""
