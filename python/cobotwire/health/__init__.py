"""How an arm and its line are: an examination with advice, and a watch over what it says."""

from cobotwire.health.advice import Complaint
from cobotwire.health.examination import Examination, Report, Times
from cobotwire.health.monitor import Monitor, Sample

__all__ = ["Complaint", "Examination", "Monitor", "Report", "Sample", "Times"]
