"""The routes of the server. What a page sends is checked here before it is used."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable
from contextlib import AbstractAsyncContextManager
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Route, WebSocketRoute

from cobotwire.protocol.errors import CobotwireError, UsageError
from cobotwire.studio.access import Access
from cobotwire.studio.connections import Connections
from cobotwire.studio.exported import Selection, written
from cobotwire.studio.extras import PAGE
from cobotwire.studio.feed import Feed
from cobotwire.studio.forms import forms
from cobotwire.studio.gate import App, Gate
from cobotwire.studio.sending import NotPermitted
from cobotwire.studio.stage import Stage

KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}
# The files of the page by their address: no other file of the disk can be requested.
FILES = {
    "/" if path.name == "index.html" else "/" + path.relative_to(PAGE).as_posix(): path
    for path in sorted(PAGE.rglob("*"))
    if path.suffix in KINDS
}
Handler = Callable[[Request], Awaitable[Response]]
Lifespan = Callable[[Starlette], AbstractAsyncContextManager[None]]


def make_app(stage: Stage, access: Access, connections: Connections, lifespan: Lifespan) -> App:
    """Return the application that serves a stage to those who may see it."""
    routes: list[BaseRoute] = [Route(address, _file(address)) for address in FILES]
    api = _Api(stage)
    routes += [
        Route("/api/table", _answering(api.table)),
        Route("/api/entry/{number:int}", _answering(api.entry)),
        Route("/api/export", _answering(api.export)),
        Route("/api/preview", _answering(api.preview), methods=["POST"]),
        Route("/api/send", _answering(api.send), methods=["POST"]),
        Route("/api/control", _answering(api.control), methods=["POST"]),
        Route("/api/motion", _answering(api.motion), methods=["POST"]),
        Route("/api/scenario", _answering(api.scenario), methods=["POST"]),
        Route("/api/stop", _answering(api.stop), methods=["POST"]),
        WebSocketRoute("/api/feed", Feed(stage).serve),
    ]
    return Gate(Starlette(routes=routes, lifespan=lifespan), access, connections)


def _file(address: str) -> Handler:
    path = FILES[address]

    async def serve(request: Request) -> Response:
        return FileResponse(path, media_type=KINDS[path.suffix])

    return serve


def _answering(handler: Handler) -> Handler:
    """Return a handler that turns errors of cobotwire into HTTP responses."""

    async def answer(request: Request) -> Response:
        try:
            return await handler(request)
        except NotPermitted as error:
            status, text = 403, str(error)
        except UsageError as error:
            status, text = 400, str(error)
        except CobotwireError as error:
            status, text = 502, str(error)
        return JSONResponse({"error": text}, status)

    return answer


class _Api:
    """What pages request besides the feed."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._forms = forms(stage.offered)

    async def table(self, request: Request) -> Response:
        return JSONResponse({"commands": self._forms})

    async def entry(self, request: Request) -> Response:
        entry = self._stage.session.find(request.path_params["number"])
        if entry is None:
            return JSONResponse({"error": "this entry is no longer kept"}, 404)
        return JSONResponse(self._stage.explainer.explain(entry))

    async def preview(self, request: Request) -> Response:
        body = await _body(request)
        preparer = self._stage.preparer
        command = preparer.command(body.get("command"))
        arguments = preparer.arguments(command, body.get("arguments"))
        encoded = preparer.encoded(command, arguments)
        return JSONResponse(self._stage.explainer.frame(encoded.frame + encoded.text))

    async def send(self, request: Request) -> Response:
        body = await _body(request)
        result = await self._stage.send(
            _page(request),
            body.get("command"),
            body.get("arguments"),
            body.get("stops"),
            force=body.get("force") is True,
        )
        return JSONResponse({"result": result})

    async def control(self, request: Request) -> Response:
        body = await _body(request)
        self._stage.set_control(_page(request), body.get("take") is True)
        return JSONResponse({})

    async def motion(self, request: Request) -> Response:
        body = await _body(request)
        self._stage.set_motion(_page(request), body.get("on") is True)
        return JSONResponse({})

    async def scenario(self, request: Request) -> Response:
        body = await _body(request)
        self._stage.choose_scenario(_page(request), body.get("name"))
        return JSONResponse({})

    async def stop(self, request: Request) -> Response:
        await self._stage.stop()
        return JSONResponse({})

    async def export(self, request: Request) -> Response:
        selection, stage = Selection.of(request.query_params), self._stage

        def make() -> Any:
            session = stage.session
            chosen = selection.choose(session.entries(), stage.describer())
            return written(chosen, selection.format, session.interface, session.start_ns)

        file = await run_in_threadpool(make)
        disposition = {"content-disposition": f'attachment; filename="{file.name}"'}
        return Response(file.data, media_type="application/octet-stream", headers=disposition)


def _page(request: Request) -> str:
    return request.headers.get("x-studio-page", "")


async def _body(request: Request) -> dict[str, Any]:
    """Return the JSON object that a page sent.

    Raises:
        UsageError: it is something else.
    """
    try:
        body = json.loads(await request.body())
    except (ValueError, RecursionError):
        body = None
    if not isinstance(body, dict):
        raise UsageError("body", message="the request does not hold a JSON object")
    return body
