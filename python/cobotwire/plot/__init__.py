"""Pictures of what went over a line. ``drawing`` alone knows matplotlib (the extra ``plot``)."""

from cobotwire.plot.series import Series, of_recording, of_stream

__all__ = ["Series", "of_recording", "of_stream"]
