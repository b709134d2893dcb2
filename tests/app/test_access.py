"""The guard before the page: token, host, origin."""

import asyncio

import pytest

from bem.app.access import Guard

pytestmark = pytest.mark.internal

TOKEN, PORT = "secret", 8420
HERE = f"127.0.0.1:{PORT}"


def ask(headers, query="", kind="http"):
    """What the guard answers, and whether the page was reached."""
    sent, reached = [], []

    async def inner(scope, receive, send):
        reached.append(scope)
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def send(message):
        sent.append(message)

    scope = {
        "type": kind,
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in headers.items()],
    }
    asyncio.run(Guard(inner, TOKEN, PORT)(scope, None, send))
    return sent, bool(reached)


def test_the_token_opens_once_and_a_cookie_afterwards():
    sent, reached = ask({"host": HERE}, "token=secret")
    assert reached
    head = dict(sent[0]["headers"])
    assert b"HttpOnly; SameSite=Strict" in head[b"set-cookie"]
    assert b"default-src 'self'" in head[b"content-security-policy"]
    assert ask({"host": HERE, "cookie": f"other=1; bem_{PORT}=secret"})[1]


@pytest.mark.parametrize(
    ("headers", "query"),
    [
        ({"host": HERE}, ""),
        ({"host": HERE}, "token=secreT"),
        ({"host": HERE, "cookie": f"bem_{PORT}=wrong"}, ""),
        ({"host": HERE, "cookie": "bem_1=secret"}, ""),  # that of a page on another port
        ({"host": HERE, "cookie": "\x00=;;"}, ""),
        ({"host": f"evil.example:{PORT}"}, "token=secret"),  # a name made to point here
        ({}, "token=secret"),
        ({"host": HERE, "origin": "http://evil.example", "cookie": f"bem_{PORT}=secret"}, ""),
    ],
)
@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_others_are_refused(headers, query, kind):
    sent, reached = ask(headers, query, kind)
    assert not reached
    assert sent[0].get("status") == 403 or sent[0] == {"type": "websocket.close", "code": 1008}
