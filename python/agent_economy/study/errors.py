"""What ends a study besides what a user wrote."""


class StudyError(RuntimeError):
    """A study cannot go on, though nothing that was asked is wrong: asked again, it goes on."""
