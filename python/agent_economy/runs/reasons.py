"""Why goals are not served, in words."""

REASONS = {
    "unreachable": "no robot can reach it",
    "capability": "no robot has the capability",
    "deadline": "every robot would be too late",
    "battery": "no battery lasts",
    "full": "every robot serves, or the controllers own, their maximum number of goals",
    "lease": "the service takes longer than a lease",
    "out_of_service": "the robots are out of service",
    "no_robot": "no robot is in range",
    "ownership_lost": "no majority of controllers votes for an owner",
    "no_controller": "no controller works that could own it",
    "position": "no robot knows its position well enough",
    "done_in_error": "a robot reported that it served it, which it had not",
    "invalid": "its numbers are impossible",
}
"""Reasons that controllers report."""


def reason_label(reason: str) -> str:
    """Return why a goal is not served, in words."""
    return REASONS.get(reason, reason)
