"""Coroutines in a loop of their own, also where Playwright keeps one running in the main thread."""

import asyncio
from collections.abc import Coroutine
from concurrent.futures import ThreadPoolExecutor
from typing import Any


def run(scenario: Coroutine[Any, Any, Any], seconds: float = 60.0) -> Any:
    """Return the result of a coroutine, if it comes in time."""

    def in_thread() -> Any:
        return asyncio.run(asyncio.wait_for(scenario, seconds))

    with ThreadPoolExecutor(1) as threads:
        return threads.submit(in_thread).result()
