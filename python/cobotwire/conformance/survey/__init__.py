"""Survey a real arm: which facts of its edition it confirms and contradicts, with the bytes."""

from cobotwire.conformance.survey.facts import ASPECTS, Fact
from cobotwire.conformance.survey.file import read_survey, survey_file
from cobotwire.conformance.survey.survey import Survey

__all__ = ["ASPECTS", "Fact", "Survey", "read_survey", "survey_file"]
