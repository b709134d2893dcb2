"""Access to the page: for whoever has its address with the token, from this machine; nothing is loaded from
elsewhere."""

from __future__ import annotations

import hmac
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlsplit

Scope = MutableMapping[str, Any]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Any, Send], Awaitable[None]]

_POLICY = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; connect-src 'self' {sockets}; "
    "frame-ancestors 'none'; form-action 'self'; base-uri 'self'"
)


class Guard:
    """An ASGI application before another: who has no token, or calls the machine by another name, is refused.

    The token comes in the address (`?token=...`) once, then in a cookie; another page in the same browser has neither
    (SameSite=Strict; and a socket from another origin is refused). The policy of contents lets the browser load
    nothing but from here.
    """

    def __init__(self, app: App, token: str, port: int) -> None:
        self._app = app
        self._token = token
        self._hosts = {f"{name}:{port}" for name in ("127.0.0.1", "localhost")}
        self._cookie = f"bem_{port}"  # cookies do not tell ports apart
        sockets = " ".join(f"ws://{host}" for host in sorted(self._hosts))
        self._policy = _POLICY.format(sockets=sockets).encode()

    async def __call__(self, scope: Scope, receive: Any, send: Send) -> None:
        """See ASGI."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        asked = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        by_address, by_cookie = self._is(asked), self._is(_cookie(headers.get("cookie", ""), self._cookie))
        origin = headers.get("origin")
        here = headers.get("host", "") in self._hosts and (origin is None or urlsplit(origin).netloc in self._hosts)
        if not here or not (by_address or by_cookie):
            await _refuse(scope, send)
            return

        async def marked(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                more = [
                    (b"content-security-policy", self._policy),
                    (b"referrer-policy", b"no-referrer"),
                    (b"x-content-type-options", b"nosniff"),
                ]
                if by_address:
                    text = f"{self._cookie}={self._token}; HttpOnly; SameSite=Strict; Path=/"
                    more.append((b"set-cookie", text.encode()))
                message["headers"] = [*message.get("headers", ()), *more]
            await send(message)

        await self._app(scope, receive, marked)

    def _is(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self._token.encode())


def _cookie(header: str, name: str) -> str:
    try:
        found = SimpleCookie(header).get(name)
    except CookieError:
        return ""
    return "" if found is None else found.value


async def _refuse(scope: Scope, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    text = b"bem app: open the address that `bem app` printed, with its token\n"
    head = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(text)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": head})
    await send({"type": "http.response.body", "body": text})
