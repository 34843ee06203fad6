"""The studio's web application: page, websocket, uploads and downloads."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import zlib
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from mimetypes import guess_type
from typing import Any, Final, TypeVar

from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from voxsoft.design.robots import robot_picture
from voxsoft.errors import FileError, VoxSoftError
from voxsoft.studio.documents.uploads import safe_name
from voxsoft.studio.outputs.page import page_file
from voxsoft.studio.outputs.thumbnails import NoPictureError
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.codec import ProtocolError, decode, encode
from voxsoft.studio.protocol.tab import Tab
from voxsoft.studio.protocol.wire import LARGEST_UPLOAD, PROTOCOL, CloseCode
from voxsoft.studio.server.security import Guard, cookie_name, is_token
from voxsoft.studio.server.session import Session

Found = TypeVar("Found")

#: Seconds in which a tab must say hello.
HELLO_WITHIN: Final = 20.0
#: Wrong messages in a row after which a tab is cut off.
MOST_WRONG: Final = 200

#: Longest reason given when a websocket is closed [bytes].
LONGEST_REASON: Final = 120

#: Seconds between two looks whether somebody still waits for a body that is solved.
LOOK_AGAIN: Final = 0.2

_NO_PAGE: Final = """<!doctype html><meta charset="utf-8"><title>VoxSoft studio</title>
<p>The server runs, but there is no page: run <code>make studio</code> in the sources,
or install VoxSoft from a wheel.</p>"""


def make_app(session: Session, token: str, port: int) -> Guard:
    """Join the routes of a session, behind its guard.

    Parameters
    ----------
    session
        The session.
    token
        Token that a browser must know.
    port
        Port of the server.
    """
    pages = _Pages(session, token, port)
    routes = [
        Route("/", pages.index),
        Route("/assets/{path:path}", pages.asset),
        Route("/still", pages.still),
        Route("/picture", pages.picture),
        Route("/robot/{name}", pages.robot),
        Route("/{name}", pages.file),
        Route("/download/{id}", pages.download),
        Route("/thumbnail/{run:path}", pages.thumbnail),
        Route("/upload", pages.upload, methods=["POST"]),
        Route("/export", pages.export, methods=["POST"]),
        Route("/molds", pages.molds, methods=["POST"]),
        Route("/mesh", pages.mesh, methods=["POST"]),
        Route("/table", pages.table, methods=["POST"]),
        Route("/coupons", pages.coupons, methods=["POST"]),
        WebSocketRoute("/ws", pages.websocket),
    ]

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        session.start()
        yield
        session.end()
        pages.end()

    return Guard(Starlette(routes=routes, lifespan=lifespan), token, port)


class _Pages:
    """The routes of one session."""

    def __init__(self, session: Session, token: str, port: int) -> None:
        self._session, self._token, self._port = session, token, port
        # One thread for commands, so that they follow each other as they were sent.
        self._commands = ThreadPoolExecutor(1, "studio-commands")
        self._files = ThreadPoolExecutor(2, "studio-files")
        # Solving for pictures takes long: other files must not wait for it.
        self._stills = ThreadPoolExecutor(2, "studio-stills")
        # One picture at a time: a study that runs, and the view, need the processor more.
        self._pictures = ThreadPoolExecutor(1, "studio-pictures")

    def end(self) -> None:
        self._commands.shutdown(wait=False, cancel_futures=True)
        self._files.shutdown(wait=False, cancel_futures=True)
        self._stills.shutdown(wait=False, cancel_futures=True)
        self._pictures.shutdown(wait=False, cancel_futures=True)

    async def index(self, request: Request) -> Response:
        page = page_file("index.html")
        response = HTMLResponse(page or _NO_PAGE, headers={"cache-control": "no-store"})
        # An old address, as from the history of the browser, must not take the right cookie away.
        if is_token(request.query_params.get("token", ""), self._token):
            response.set_cookie(
                cookie_name(self._port), self._token, httponly=True, samesite="strict", path="/"
            )
        return response

    async def asset(self, request: Request) -> Response:
        return _from_page(f"assets/{request.path_params['path']}", request)

    async def file(self, request: Request) -> Response:
        return _from_page(request.path_params["name"], request)

    async def download(self, request: Request) -> Response:
        found = self._session.download(request.path_params["id"])
        if found is None:
            return _problem(404, "download", "is not there any more", "export it again")
        return FileResponse(found, filename=found.name, headers={"cache-control": "no-store"})

    async def thumbnail(self, request: Request) -> Response:
        picture = await self._aside(self._session.thumbnail, request.path_params["run"])
        if picture is None:
            return _problem(404, "thumbnail", "there is none")
        return FileResponse(picture, headers={"cache-control": "no-cache"})

    async def robot(self, request: Request) -> Response:
        """Answer with the picture of a finished robot."""
        moving = "moving" in request.query_params
        try:
            picture = robot_picture(request.path_params["name"], moving=moving)
        except VoxSoftError as error:
            return _problem(404, error.where, error.what, error.hint)
        return Response(picture, media_type="image/webp", headers={"cache-control": "no-cache"})

    async def still(self, request: Request) -> Response:
        """Answer with a body at rest; solving it ends when nobody waits for it any more."""
        try:
            content = await self._awaited(self._stills, self._session.stills.packed, request)
        except VoxSoftError as error:
            return _problem(422, error.where, error.what, error.hint)
        if content is None:
            return Response(status_code=499)
        headers = {"cache-control": "no-store"}
        return Response(content, media_type="application/octet-stream", headers=headers)

    async def picture(self, request: Request) -> Response:
        """Answer with a small picture of a design; one that nobody waits for is not begun."""
        try:
            found = await self._awaited(self._pictures, self._session.picture, request)
        except NoPictureError:
            return Response(status_code=204)  # the list shows it without one
        except VoxSoftError as error:
            return _problem(422, error.where, error.what, error.hint)
        if found is None:
            return Response(status_code=499)
        headers = {
            "cache-control": "no-cache",
            "x-voxsoft-state": "rest" if found.at_rest else "unloaded",
            "x-voxsoft-pixels-per-meter": repr(found.per_meter),
        }
        return Response(found.content, media_type="image/png", headers=headers)

    async def _awaited(
        self,
        executor: ThreadPoolExecutor,
        work: Callable[[str, threading.Event], Found],
        request: Request,
    ) -> Found | None:
        """Result of some work for the name `of` of a request; None where nobody waits any more."""
        cancelled, name = threading.Event(), request.query_params.get("of", "")
        begun = asyncio.get_running_loop().run_in_executor(executor, work, name, cancelled)
        begun.add_done_callback(lambda done: done.cancelled() or done.exception())
        try:
            while not begun.done():
                await asyncio.wait([begun], timeout=LOOK_AGAIN)
                if not begun.done() and await request.is_disconnected():
                    return None
            return begun.result()
        finally:
            cancelled.set()

    async def upload(self, request: Request) -> Response:
        try:
            name = safe_name(request.query_params.get("name", ""))
            content = await _body_within(request, LARGEST_UPLOAD, name)
            stored = await self._aside(self._session.store_upload, name, content)
        except _TooLargeError as error:
            refused = _problem(413, error.where, error.what, error.hint)
            refused.headers["connection"] = "close"  # or the rest would still be sent
            return refused
        except ClientDisconnect:
            return Response(status_code=499)
        except VoxSoftError as error:
            return _problem(422, error.where, error.what, error.hint)
        answer = {"name": stored.name, "path": str(stored), "size": len(content)}
        return JSONResponse(answer)

    async def export(self, request: Request) -> Response:
        try:
            asked = await _asked(request)
            options = asked.get("options") or {}
            if not isinstance(options, dict):
                raise ValueError("options: expected an object")
            found = await self._aside(self._session.export, str(asked.get("format", "")), options)
        except VoxSoftError as error:
            return _problem(422, error.where, error.what, error.hint)
        except (ValueError, UnicodeError, RecursionError) as error:
            return _problem(400, "export", str(error))
        return JSONResponse({"format": found.format, "url": found.url, "name": found.name})

    async def molds(self, request: Request) -> Response:
        """Answer with the molds of the document; making them takes seconds."""
        return await self._made(self._session.molds, request)

    async def mesh(self, request: Request) -> Response:
        """Answer with the size and the unit of a mesh that was uploaded."""
        return await self._made(self._session.mesh, request)

    async def table(self, request: Request) -> Response:
        """Answer with the uses of a table that was dropped."""
        return await self._made(self._session.table, request)

    async def coupons(self, request: Request) -> Response:
        """Answer with the models fitted to tests of a material; it takes a second."""
        return await self._made(self._session.coupons, request)

    async def _made(
        self, make: Callable[[dict[str, Any]], events.Event], request: Request
    ) -> Response:
        """Answer with a message that is made of a request, or with its problem."""
        try:
            made = await self._aside(make, await _asked(request))
        except VoxSoftError as error:
            return _problem(422, error.where, error.what, error.hint)
        except (ValueError, UnicodeError, RecursionError) as error:
            return _problem(400, request.url.path.strip("/"), str(error))
        return Response(encode(made), media_type="application/json")

    async def websocket(self, socket: WebSocket) -> None:
        await socket.accept()
        tab = Tab(socket)
        try:
            if not await self._greet(socket, tab):
                return
        except (TimeoutError, WebSocketDisconnect, RuntimeError):
            with contextlib.suppress(RuntimeError):
                await socket.close(CloseCode.NO_HELLO, "the page said no hello in time")
            return
        tabs = self._session.tabs
        tabs.join(tab)
        pump = asyncio.create_task(tab.pump())
        try:
            await self._aside_in_order(self._session.send_snapshot, tab)
            await self._listen(socket, tab)
        except (WebSocketDisconnect, RuntimeError):
            pass  # the tab was closed
        finally:
            tab.closed = True
            tabs.leave(tab)
            pump.cancel()
            with contextlib.suppress(BaseException):
                await pump
            self._session.left(tab)

    async def _greet(self, socket: WebSocket, tab: Tab) -> bool:
        """Hear the first message, which must say that both speak the same protocol."""
        text = await asyncio.wait_for(_receive(socket), HELLO_WITHIN)
        try:
            hello = decode(text)
        except ProtocolError as error:
            hello = None
            what = error.what
        if isinstance(hello, commands.Hello) and hello.protocol == PROTOCOL:
            tab.seq = hello.seq
            return True
        if isinstance(hello, commands.Hello):
            what = f"the page speaks version {hello.protocol}, the server version {PROTOCOL}"
            error_event = events.Error(
                seq=hello.seq, where="hello", what=what, hint="reload the page"
            )
        else:
            what = what if hello is None else "hello must come first"
            error_event = events.Error(seq=0, where="hello", what=what)
        await socket.send_text(encode(error_event))
        code = CloseCode.WRONG_MESSAGES if hello is None else CloseCode.OTHER_PROTOCOL
        await socket.close(code, what.encode()[:LONGEST_REASON].decode(errors="ignore"))
        return False

    async def _listen(self, socket: WebSocket, tab: Tab) -> None:
        wrong = 0
        while not tab.closed:
            try:
                command = decode(await _receive(socket))
            except ProtocolError as error:
                wrong += 1
                tab.put(events.Error(seq=0, where=error.where, what=error.what, hint=error.hint))
                if wrong >= MOST_WRONG:
                    what = f"{wrong} messages in a row were none of the protocol's"
                    await socket.close(CloseCode.WRONG_MESSAGES, what)
                    return
                continue
            wrong = 0
            tab.seq = command.seq
            if isinstance(command, commands.Ack):
                tab.ack()
                self._session.repaint(tab)
            else:
                await self._aside_in_order(self._session.handle, tab, command)

    async def _aside_in_order(self, call: Any, *arguments: Any) -> Any:  # noqa: ANN401
        return await asyncio.get_running_loop().run_in_executor(self._commands, call, *arguments)

    async def _aside(self, call: Any, *arguments: Any) -> Any:  # noqa: ANN401
        try:
            return await asyncio.get_running_loop().run_in_executor(self._files, call, *arguments)
        except asyncio.CancelledError:
            raise FileError("studio", "was ended before this was done") from None


class _TooLargeError(FileError):
    """More came than is taken."""


async def _body_within(request: Request, limit: int, name: str) -> bytes:
    """Read the body of a request, and stop as soon as it is too large."""
    what = f"is larger than {limit // 2**20} MB"
    hint = "coarsen the mesh, or open the file by its path: voxsoft studio FILE"
    declared = request.headers.get("content-length", "0")
    if declared.isdigit() and int(declared) > limit:
        raise _TooLargeError(name, what, hint)
    parts, size = [], 0
    async for part in request.stream():
        size += len(part)
        if size > limit:
            raise _TooLargeError(name, what, hint)
        parts.append(part)
    return b"".join(parts)


async def _asked(request: Request) -> dict[str, Any]:
    asked = await request.json()
    if not isinstance(asked, dict):
        raise ValueError("expected an object")
    return asked


async def _receive(socket: WebSocket) -> str | bytes:
    """The next message, text or not: any other kind is refused by the decoder."""
    message = await socket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message.get("code", 1000))
    text = message.get("text")
    return text if text is not None else message.get("bytes") or b""


def _from_page(name: str, request: Request) -> Response:
    content = page_file(name)
    if content is None:
        return _problem(404, name[:80], "there is no such file")
    # The browser asks each time whether a file changed: another version keeps its names.
    headers = {"cache-control": "no-cache", "etag": f'"{zlib.crc32(content):08x}"'}
    if request.headers.get("if-none-match") == headers["etag"]:
        return Response(status_code=304, headers=headers)
    return Response(content, headers=headers, media_type=guess_type(name)[0])


def _problem(status: int, where: str, what: str, hint: str = "") -> JSONResponse:
    return JSONResponse({"where": where, "what": what, "hint": hint}, status)
