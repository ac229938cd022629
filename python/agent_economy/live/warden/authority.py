"""Which client is the operator: one at a time, and only while it is seen."""

import math

from agent_economy.types.warden import Operator

SEEN_S = 3.0
"""A client that has sent nothing for this time is no operator any more."""

MAX_CLIENT_LENGTH = 100


class Authority:
    """Knows the operator, by the random id that each client makes for itself."""

    def __init__(self) -> None:
        """Start without an operator."""
        self._client, self._seen_s = "", -math.inf

    def operator(self, now_s: float) -> str:
        """Return the id of the operator; empty while there is none."""
        return self._client if now_s - self._seen_s <= SEEN_S else ""

    def see(self, client: object, now_s: float) -> None:
        """Note that a client has sent a request."""
        if client and client == self.operator(now_s):
            self._seen_s = now_s

    def role(self, client: object, now_s: float) -> Operator | None:
        """Return what a client has to know: whether itself or another one is the operator."""
        operator = self.operator(now_s)
        if not operator:
            return None
        return "you" if client == operator else "other"

    def take(self, client: object, now_s: float, *, take_over: bool) -> None:
        """Let a client be the operator.

        Raises:
            ValueError: If it has no valid id, or another client is the operator and is not to be
                replaced.
        """
        name = check_client(client)
        if not take_over:
            self.check(name, now_s)
        self._client, self._seen_s = name, now_s

    def give_up(self) -> None:
        """Let there be no operator."""
        self._client = ""

    def check(self, client: object, now_s: float) -> None:
        """Refuse a client while another one is the operator.

        Raises:
            ValueError: If another one is.
        """
        if self.role(client, now_s) == "other":
            message = "another client is the operator"
            raise ValueError(message)


def check_client(client: object) -> str:
    """Return the id of a client.

    Raises:
        ValueError: If it is no string, empty or too long.
    """
    if not isinstance(client, str) or not 0 < len(client) <= MAX_CLIENT_LENGTH:
        message = f"client must be a string of 1 to {MAX_CLIENT_LENGTH} characters"
        raise ValueError(message)
    return client
