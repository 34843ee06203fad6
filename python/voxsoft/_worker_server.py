"""Server of the worker processes of a study, which may start before all else is imported."""

from __future__ import annotations

import multiprocessing
from multiprocessing.context import BaseContext

#: Module that the server imports once; every worker starts as a copy of the server.
_NEEDED = "voxsoft.study.outcome"


def worker_context() -> BaseContext:
    """Return the context that starts workers: `forkserver`, or `spawn` where there is none.

    A forked copy of a process that has run threads, as the solver does, can hang.
    """
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    if context.get_start_method() == "forkserver":
        context.set_forkserver_preload([_NEEDED])
    return context


def start_early() -> None:
    """Start the server, which then imports beside this process."""
    if worker_context().get_start_method() == "forkserver":
        from multiprocessing.forkserver import ensure_running

        ensure_running()
