"""Errors that end a study although its question is valid."""

from agent_economy._core import InputError


class StudyError(RuntimeError):
    """A study cannot continue, although its question is valid; it can be resumed later."""


class StoreError(StudyError, InputError):
    """A study's folder is damaged, locked, full, or of another version.

    It is also an `InputError`, so that callers can catch all errors of a folder as one type.
    """


class NoConfigurationError(InputError):
    """No configuration of a study can be run, so nothing can be selected."""


class NoMoreRunsError(Exception):
    """Only stored runs are used, and the next ones are missing: a study ends as if stopped."""
