"""What a folder is of: a study, or a selection by `select_best`."""

from agent_economy._core import InputError

SELECTION = 'kind = "select_best"\n'
"""First line of the study.toml of a selection."""


def is_selection(question: str) -> bool:
    """Return whether a study.toml is that of a selection."""
    return question.startswith(SELECTION)


def check_study(place: str, question: str) -> None:
    """Check that a study.toml, which is in a place, is that of a study.

    Raises:
        InputError: If it is that of a selection.
    """
    if is_selection(question):
        message = (
            f"{place}: is a selection by select_best, not a study: to continue it, repeat its call "
            "of select_best; for a study, use another folder"
        )
        raise InputError(message)
