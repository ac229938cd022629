"""What ends a study besides what a user wrote."""

from agent_economy._core import InputError


class StudyError(RuntimeError):
    """A study cannot go on, though nothing that was asked is wrong: asked again, it goes on."""


class StoreError(StudyError, InputError):
    """A study's folder is damaged, taken, full, or another version's: not what was asked is wrong.

    It is an `InputError` too, so that who calls from Python catches all that a folder can be.
    """
