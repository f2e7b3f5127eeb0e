"""Folders of results: what a command left in one, read and typed, and what it was asked."""

from .asked import Asked
from .reading import Comparison, Kind, Numbers, Result, RunResult, SeveralRuns, StudyFolder, read_folder, read_results

__all__ = [
    "Asked",
    "Comparison",
    "Kind",
    "Numbers",
    "Result",
    "RunResult",
    "SeveralRuns",
    "StudyFolder",
    "read_folder",
    "read_results",
]
