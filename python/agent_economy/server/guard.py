"""Which requests reach the server: those of its own pages.

Without this check, pages of other sites could send requests to a server on this machine. Browsers
send the origin of a request (`Origin`, or at least `Sec-Fetch-Site`) and its destination (`Host`,
which reveals DNS rebinding); all are checked. Other machines also need a token. The server of a
drive needs one on this machine too: other users of it must not reach the robots.
"""

import hmac
from contextlib import suppress
from dataclasses import dataclass
from hashlib import sha256
from http.cookies import CookieError, SimpleCookie
from ipaddress import IPv4Address, IPv6Address, ip_address
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from agent_economy.live.warden.endpoint import is_of_other_site

REFUSAL = "Open the link with the token that was printed when the server was started."

TOKEN_NAME = "agent-economy-token"  # noqa: S105  (a name, no secret)
"""The field of a request that has the token, and the first part of the cookie's name; there the
port follows, because a browser sends the cookies of a host to all of its ports."""

POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

HEADERS = {
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
}


@dataclass(frozen=True)
class Guard:
    """An application that rejects requests of other sites, and those without the token.

    Attributes:
        app: The guarded application.
        host: The host name or address that the server is bound to.
        token: The token that requests need; None if they need none.
        connects: An address besides its own that its pages may send requests to.
    """

    app: ASGIApp
    host: str
    token: str | None
    connects: str | None = None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Forward a request to the application, or reject it."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        why = self.refusal(scope)
        if why is None:
            # It may leave before its request is complete: that is no error.
            with suppress(ClientDisconnect):
                await self.app(scope, receive, self._with_headers(scope, send))
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": why})
        else:
            await PlainTextResponse(why, 403)(scope, receive, send)

    def refusal(self, scope: Scope) -> str | None:
        """Return why a request is rejected; None if it is not."""
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._is_own(host):
            return f"{host!r} is not a name of this server."
        foreign = refusal_of_sender(scope, headers, host)
        if foreign is not None:
            return foreign
        if self.token is not None and not self._has_token(scope, headers):
            return REFUSAL
        return None

    def _is_own(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        # A name can be rebound to another address; an address cannot.
        is_address = not is_loopback(self.host) and address_of(name) is not None
        return is_loopback(name) or name == self.host.lower() or is_address

    def _has_token(self, scope: Scope, headers: Headers) -> bool:
        token = self.token or ""
        query = parse_qs(scope.get("query_string", b"").decode("latin-1"))
        is_in_address = any(is_same(each, token) for each in query.get("token", []))
        return is_in_address or is_same(cookie(headers), cookie_of(token))

    def _policy(self) -> str:
        if self.connects is None:
            return POLICY
        return f"{POLICY}; connect-src 'self' {self.connects}"

    def _with_headers(self, scope: Scope, send: Send) -> Send:
        query = parse_qs(scope.get("query_string", b"").decode("latin-1"))

        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update(HEADERS)
                headers["content-security-policy"] = self._policy()
                if self.token is not None and "token" in query:
                    name = cookie_name(Headers(scope=scope))
                    kept = f"{name}={cookie_of(self.token)}; HttpOnly; SameSite=Strict; Path=/"
                    headers.append("set-cookie", kept)
            await send(message)

        return sent


def refusal_of_sender(scope: Scope, headers: Headers, host: str) -> str | None:
    """Return why the page that sends a request may not; None if it is ours, or no page."""
    origin = headers.get("origin")
    if origin is not None:
        is_own = place_of(origin) == host
        return None if is_own else f"Pages of {origin} may not use this server."
    if is_of_other_site(headers) and not is_link(scope, headers):
        return "Pages of other sites may not use this server."
    if scope["type"] == "websocket" and headers.get("user-agent", "").startswith("Mozilla"):
        return "Requests of browsers need an Origin header."
    return None


def is_link(scope: Scope, headers: Headers) -> bool:
    """Return whether a request opens our page by a link, which may be in a page of another site."""
    is_of_page = (scope.get("method"), scope["path"]) == ("GET", "/")
    is_opened = headers.get("sec-fetch-mode") == "navigate"
    return is_of_page and is_opened and headers.get("sec-fetch-dest") == "document"


def is_loopback(host: str) -> bool:
    """Return whether a host name or address is that of this machine only."""
    address = address_of(host)
    return host == "localhost" if address is None else address.is_loopback


def address_of(name: str) -> IPv4Address | IPv6Address | None:
    """Parse an IP address; None if the name is not one."""
    try:
        return ip_address(name)
    except ValueError:
        return None


def place_of(origin: str) -> str | None:
    """Return the host and port of an origin; None if it has none."""
    try:
        return urlsplit(origin).netloc
    except ValueError:
        return None


def is_same(given: str, wanted: str) -> bool:
    """Return whether two secrets are equal, in a time that does not depend on where they differ."""
    return hmac.compare_digest(given.encode(), wanted.encode())


def cookie_of(token: str) -> str:
    """Return the value of the cookie, which the token does not follow from.

    A browser sends it to servers of other users too, on other ports of this host.
    """
    return sha256(f"cookie of {token}".encode()).hexdigest()


def cookie(headers: Headers) -> str:
    """Return the cookie of a request; empty if there is none."""
    name = cookie_name(headers)
    try:
        kept = SimpleCookie(headers.get("cookie", ""))
    except CookieError:
        return ""
    return kept[name].value if name in kept else ""


def cookie_name(headers: Headers) -> str:
    """Return the name of the cookie, which contains the port that the browser connects to."""
    _, separator, port = headers.get("host", "").rpartition(":")
    return f"{TOKEN_NAME}-{port if separator and port.isdigit() else 80}"
