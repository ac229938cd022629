"""Opens the sockets that servers listen on."""

import socket

from agent_economy._core import InputError


def listening_socket(host: str, port: int) -> socket.socket:
    """Return a socket that listens, so that clients wait from now on; port 0 is any free one.

    Raises:
        InputError: If the address cannot be used. The error does not name the address.
    """
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
        listening.listen()
    # Python encodes names for the DNS: an empty or long label is a UnicodeError.
    except (OSError, UnicodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is not the name of a host"
        message = f"cannot listen there: {why}; choose another"
        raise InputError(message) from None
    return listening
