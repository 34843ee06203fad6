"""Ports and tokens that are kept for a restart, and when they are not."""

import os
import sys
import time

import httpx
import msgspec
import pytest

from voxsoft.studio.server.admission import LONGEST, MOST, Admission, admissions, admit
from voxsoft.studio.server.process import StudioServer


@pytest.fixture(autouse=True)
def own_state(tmp_path, monkeypatch):
    """A state folder of the test's own."""
    if sys.platform != "linux":
        pytest.skip("the folder is chosen by the system")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state" / "voxsoft" / "studios"


def opened(runs, **options):
    """Port and token of a server that never serves."""
    server = StudioServer(runs=runs, **options)
    server._listener.close()
    return server.port, server.token


def test_a_restart_has_its_port_and_its_token_again(tmp_path):
    first = opened(tmp_path / "runs")
    assert opened(tmp_path / "runs") == first
    assert opened(tmp_path / "runs", port=first[0]) == first
    # Other runs have others.
    assert opened(tmp_path / "others")[1] != first[1]
    # A port that is taken is left to its owner.
    server = StudioServer(runs=tmp_path / "runs")
    second = opened(tmp_path / "runs")
    server._listener.close()
    assert second[0] != first[0]
    assert second[1] != first[1]


def test_a_token_that_is_given_is_not_kept(tmp_path, own_state):
    opened(tmp_path / "runs", token="given")
    assert not own_state.exists()


def test_nobody_else_may_read_them(tmp_path, own_state):
    admit(tmp_path, 8080, "secret")
    (file,) = own_state.iterdir()
    assert file.stat().st_mode & 0o777 == 0o600
    assert own_state.stat().st_mode & 0o777 == 0o700


def test_old_and_damaged_ones_count_as_none(tmp_path, own_state):
    for port in range(MOST + 2):
        admit(tmp_path, port, f"token-{port}")
    assert [each.port for each in admissions(tmp_path)] == list(range(MOST + 1, 1, -1))
    (file,) = own_state.iterdir()
    old = Admission(1, "token", time.time() - LONGEST - 1.0)
    future = Admission(2, "token", time.time() + 3600.0)
    file.write_bytes(msgspec.json.encode([old, future]))
    assert admissions(tmp_path) == []
    file.write_text("{")
    assert admissions(tmp_path) == []


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root writes anywhere")
def test_a_state_folder_that_cannot_be_written_keeps_nobody_out(tmp_path):
    (tmp_path / "state").mkdir(mode=0o500)
    assert opened(tmp_path / "runs")[1]


def test_an_old_token_takes_no_cookie_away(studio):
    cookie = f"voxsoft_studio_{studio.port}={studio.token}"
    answer = httpx.get(f"{studio.origin}/?token=old", headers={"cookie": cookie})
    assert answer.status_code == 200
    assert "set-cookie" not in answer.headers


def test_a_person_reads_a_sentence_and_a_program_an_object(studio):
    answer = httpx.get(f"{studio.origin}/?token=old", headers={"accept": "text/html,*/*"})
    assert answer.status_code == 403
    assert answer.headers["content-type"].startswith("text/html")
    assert "<code>voxsoft studio</code>" in answer.text
    assert httpx.get(f"{studio.origin}/?token=old").json()["where"] == "request"
