"""The command line's `studio`, as a process."""

import re
import signal
import socket
import subprocess
import sys

import httpx
import pytest
from typer.testing import CliRunner

from voxsoft.cli.app import app


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals as they are on Unix")
def test_it_prints_its_address_and_ends_with_ctrl_c(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", "from voxsoft.cli import main; main()", "studio", "--no-browser"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        line = process.stdout.readline()
        address = re.fullmatch(r"(http://127\.0\.0\.1:\d+/\?token=[\w-]{32})\n", line)[1]
        assert httpx.get(address).status_code == 200
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == 0
        assert "Traceback" not in process.stderr.read()
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()


def test_a_port_that_is_taken_is_reported(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        outcome = CliRunner().invoke(app, ["studio", "--no-browser", "--port", port])
    assert outcome.exit_code == 2
    assert "cannot be used" in outcome.stderr


@pytest.mark.parametrize("content", [None, b"\xff\xfe"])
def test_a_source_that_cannot_be_read_is_reported(tmp_path, monkeypatch, content):
    monkeypatch.chdir(tmp_path)
    source = tmp_path / "folder"
    if content is None:
        source.mkdir()
    else:
        source.write_bytes(content)
    outcome = CliRunner().invoke(app, ["studio", "--no-browser", str(source)])
    assert outcome.exit_code == 3
    assert "run folder" in outcome.stderr or "UTF-8" in outcome.stderr
