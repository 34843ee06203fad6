"""The studio as a process: it listens on this machine alone until Ctrl-C."""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import uvicorn

from voxsoft.errors import StudyError
from voxsoft.studio.protocol.codec import LONGEST_MESSAGE
from voxsoft.studio.server.admission import Admission, admissions, admit
from voxsoft.studio.server.app import make_app
from voxsoft.studio.server.security import new_token
from voxsoft.studio.server.session import Session

#: The only address that the studio listens on.
ADDRESS = "127.0.0.1"


class StudioServer:
    """A session behind its web server.

    Parameters
    ----------
    source
        The design file or run folder to open.
    runs
        Folder of the runs.
    port
        Port of the server; 0 takes that of the last studio on these runs, or one that is free.
    token
        Token that a browser must know; default: that of the last studio on this port and these
        runs, by which its tabs come back, or a new random one.

    Attributes
    ----------
    session
        The session.
    port
        Port of the server.
    address
        Address for a browser; it holds the token.

    Raises
    ------
    FileError
        The source cannot be read.
    StudyError
        The port is taken.
    """

    def __init__(
        self, source: Path | None = None, *, runs: Path, port: int = 0, token: str | None = None
    ) -> None:
        self.session = Session(runs, source)
        known = [] if token else admissions(runs)
        again = _listen_again(known) if port == 0 else None
        self._listener = again or _listen(port)
        self.port = int(self._listener.getsockname()[1])
        self.token = token or next(
            (each.token for each in known if each.port == self.port), new_token()
        )
        if not token:
            admit(runs, self.port, self.token)
        self.address = f"http://{ADDRESS}:{self.port}/?token={self.token}"
        config = uvicorn.Config(
            make_app(self.session, self.token, self.port),
            log_level="warning",
            access_log=False,
            lifespan="on",
            ws="websockets-sansio",
            ws_max_size=LONGEST_MESSAGE,
            # Frames are random to a compressor, which would only cost time.
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=2,
            server_header=False,
        )
        self._server = uvicorn.Server(config)

    def run(self, ready: Callable[[str], None]) -> None:
        """Serve until Ctrl-C, or until :meth:`stop`; `ready` is called once with the address."""

        async def serving() -> None:
            task = asyncio.create_task(self._server.serve(sockets=[self._listener]))
            while not self._server.started and not task.done():
                await asyncio.sleep(0.01)
            if self._server.started:
                ready(self.address)
            await task

        # uvicorn ends tidily on Ctrl-C, and then raises it once more.
        with contextlib.suppress(KeyboardInterrupt), self._listener:
            asyncio.run(serving())

    def run_and_exit(self, ready: Callable[[str], None]) -> NoReturn:
        """Serve as the only work of this process, which then ends.

        Threads may still be in native code, such as that of a library being loaded. Some of
        it aborts where the interpreter is taken down around it, so the process ends at once: all
        that is kept has been written by then.
        """
        self.run(ready)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)

    def stop(self) -> None:
        """Let :meth:`run` end, which another thread has called."""
        self._server.should_exit = True


def _listen_again(known: list[Admission]) -> socket.socket | None:
    """Listen on the port of the last studio, if there was one and its port is free."""
    if not known:
        return None
    try:
        return _listen(known[0].port)
    except StudyError:
        return None


def _listen(port: int) -> socket.socket:
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if sys.platform != "win32":  # there it would let two programs have one port
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((ADDRESS, port))
    except (OSError, OverflowError) as error:
        listener.close()
        reason = getattr(error, "strerror", None) or str(error)
        hint = "leave --port away to take a free one"
        raise StudyError(f"port {port}", f"cannot be used: {reason}", hint) from None
    listener.listen(128)
    return listener
