"""Only this machine's own browser, with the token of this run, gets in."""

import httpx
import pytest


def get(studio, path="/", **headers):
    return httpx.get(f"{studio.origin}{path}", headers=headers)


@pytest.mark.parametrize("path", ["/", "/assets/index.js", "/download/x", "/thumbnail/x"])
def test_without_the_token_nothing_is_served(studio, path):
    answer = get(studio, path)
    assert answer.status_code == 403
    assert "the address that `voxsoft studio` printed" in answer.json()["what"]
    assert get(studio, f"{path}?token=wrong").status_code == 403


def test_the_token_becomes_a_cookie_that_scripts_cannot_read(studio):
    answer = get(studio, f"/?token={studio.token}")
    assert answer.status_code == 200
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert answer.headers["cache-control"] == "no-store"
    pair = cookie.partition(";")[0]
    assert get(studio, cookie=pair).status_code == 200
    assert get(studio, cookie=f"{pair}x").status_code == 403


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "localhost.evil:80"])
def test_another_host_is_refused(studio, host):
    answer = get(studio, f"/?token={studio.token}", host=host)
    assert answer.status_code == 403
    assert "not the studio's own" in answer.json()["what"]


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1", ""])
def test_another_origin_is_refused(studio, origin):
    assert get(studio, f"/?token={studio.token}", origin=origin).status_code == 403


def test_a_change_without_an_origin_is_refused(studio):
    url = f"{studio.origin}/upload?name=a.toml&token={studio.token}"
    assert httpx.post(url, content=b"").status_code == 403
    assert httpx.post(url, content=b"", headers={"origin": studio.origin}).status_code == 200


NO_FILES = ["/assets/..%2f..%2fserver.py", "/..%2fapp.py", "/assets/x.js", "/assets/%00", "/%00"]
NO_FILES += [
    f"/assets/{'a' * 300}",
    f"/{'a' * 5000}",
    "/assets/%ff",
    "/thumbnail/%00",
    "/download/%00",
]
NO_FILES += [f"/thumbnail/{'a' * 300}", "/thumbnail/..%2f..", "/assets/" + "a/" * 1000]


@pytest.mark.long
@pytest.mark.parametrize("path", NO_FILES, ids=lambda path: path[:30])
def test_only_the_bundle_is_served(studio, path):
    answer = get(studio, path, cookie=f"voxsoft_studio_{studio.port}={studio.token}")
    assert answer.status_code == 404
