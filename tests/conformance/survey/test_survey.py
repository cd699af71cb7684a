"""A survey names what is wrong with an arm, says nothing wrong of a correct one, and resumes."""

from __future__ import annotations
