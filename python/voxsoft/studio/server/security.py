"""Who may talk to the studio: this machine's own browser, with the token of this run."""

from __future__ import annotations

import hmac
import json
import re
import secrets
from collections.abc import Mapping
from http.cookies import CookieError, SimpleCookie
from typing import Final
from urllib.parse import parse_qs

from starlette.types import ASGIApp, Message, Receive, Scope, Send

#: Names by which a browser on this machine reaches it.
LOOPBACK: Final = ("127.0.0.1", "localhost")

_REFUSAL: Final = {
    "token": "this studio opens only by the address that `voxsoft studio` printed",
    "host": "this address is not the studio's own; open the one that `voxsoft studio` printed",
    "origin": "another page asked for this; the studio answers its own page only",
}


_REFUSED_PAGE: Final = """<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width"><meta name="color-scheme" content="dark light">
<link rel="icon" href="data:,"><title>VoxSoft studio</title>
<style>body{{font:16px/1.5 system-ui,sans-serif;max-width:40em;margin:20vh auto;padding:0 1em}}
</style><h1>This address is no longer valid</h1><p>{sentence}</p>
<p>Start <code>voxsoft studio</code> if it does not run, and open the address that it prints.
What was edited is kept.</p></html>"""


def new_token() -> str:
    """Make a token that nobody guesses."""
    return secrets.token_urlsafe(24)


def is_token(given: str, token: str) -> bool:
    """Check a token, in a time that tells nothing of it."""
    return hmac.compare_digest(given.encode(), token.encode())


def content_policy(port: int) -> str:
    """Write the policy for the page: it may load its own files, and nothing from elsewhere."""
    # A policy cannot name an IPv6 address, and reports one as an error.
    sockets = " ".join(f"ws://{host}:{port}" for host in LOOPBACK if not host.startswith("["))
    rules = (
        "default-src 'none'",
        "script-src 'self' 'wasm-unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self'",
        f"connect-src 'self' {sockets}",
        "worker-src 'self' blob:",
        "media-src 'self' blob:",
        "manifest-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "frame-ancestors 'none'",
    )
    return "; ".join(rules)


class Guard:
    """Passes requests of the studio's own page, and refuses the rest in words.

    Every request needs the name of this machine as its host, which no page of another name can
    send (DNS rebinding), and the token, in a cookie or in the query. A websocket and whatever
    changes something needs the page's own origin as well.

    Parameters
    ----------
    app
        The application that is guarded.
    token
        The token.
    port
        Port of the server.
    """

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self._app, self._token, self._port = app, token, port
        self._hosts = {f"{host}:{port}" for host in LOOPBACK}
        if port == 80:
            self._hosts |= set(LOOPBACK)
        self._origins = {f"http://{host}" for host in self._hosts}
        self.cookie = cookie_name(port)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            await self._app(scope, receive, self._with_headers(send))
        elif scope["type"] == "websocket":
            # Before it is accepted, closing a websocket answers its request with 403.
            await send({"type": "websocket.close", "code": 1008, "reason": refusal})
        else:
            await _answer(self._with_headers(send), refusal, page=_wants_page(scope))

    def _refusal(self, scope: Scope) -> str | None:
        headers = {
            name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]
        }
        if headers.get("host", "").lower() not in self._hosts:
            return _REFUSAL["host"]
        origin = headers.get("origin")
        reads = scope["type"] == "http" and scope["method"] in ("GET", "HEAD")
        if (origin is None and not reads) or (origin is not None and origin not in self._origins):
            return _REFUSAL["origin"]
        return None if self._knows_token(scope, headers) else _REFUSAL["token"]

    def _knows_token(self, scope: Scope, headers: Mapping[str, str]) -> bool:
        query = parse_qs(scope.get("query_string", b"").decode("latin-1"))
        given = [*query.get("token", [])]
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(self.cookie)
        except CookieError:
            cookie = None
        if cookie is not None:
            given.append(cookie.value)
        return any(is_token(each, self._token) for each in given)

    def _with_headers(self, send: Send) -> Send:
        added = [
            (b"content-security-policy", content_policy(self._port).encode()),
            (b"cross-origin-opener-policy", b"same-origin"),
            (b"cross-origin-embedder-policy", b"require-corp"),
            (b"cross-origin-resource-policy", b"same-origin"),
            (b"x-content-type-options", b"nosniff"),
            (b"referrer-policy", b"no-referrer"),
        ]

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                message = {**message, "headers": [*message.get("headers", []), *added]}
            await send(message)

        return with_headers


def cookie_name(port: int) -> str:
    """Name of the cookie: browsers do not tell the ports of one host apart."""
    return f"voxsoft_studio_{port}"


def _wants_page(scope: Scope) -> bool:
    """True for a request of the address bar, whose answer is read by a person."""
    accepted = dict(scope["headers"]).get(b"accept", b"")
    return scope["path"] == "/" and b"text/html" in accepted


async def _answer(send: Send, refusal: str, *, page: bool) -> None:
    if page:
        kind, body = b"text/html; charset=utf-8", _page(refusal).encode()
    else:
        kind = b"application/json"
        body = json.dumps({"where": "request", "what": refusal, "hint": ""}).encode()
    headers = [(b"content-type", kind), (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _page(refusal: str) -> str:
    # The code marks are those of the sentence; an icon of its own keeps the browser from asking.
    sentence = re.sub(r"`([^`]*)`", r"<code>\1</code>", f"{refusal[:1].upper()}{refusal[1:]}.")
    return _REFUSED_PAGE.format(sentence=sentence)
