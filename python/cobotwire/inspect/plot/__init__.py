"""Draw recordings and poses; matplotlib (the extra ``plot``) is imported when one is drawn."""

from cobotwire.inspect.plot.pictures import check_output, draw_charts, draw_pose
from cobotwire.inspect.plot.series import Series, series_of_bytes, series_of_packets

__all__ = [
    "Series",
    "check_output",
    "draw_charts",
    "draw_pose",
    "series_of_bytes",
    "series_of_packets",
]
