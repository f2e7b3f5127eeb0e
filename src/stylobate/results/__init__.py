"""Folders of results: what a command left in one, read and typed, and what it was asked."""

from .command_request import CommandRequest
from .reading import Comparison, Kind, Numbers, Result, RunResult, SeveralRuns, StudyFolder, read_folder, read_results

__all__ = [
    "CommandRequest",
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
