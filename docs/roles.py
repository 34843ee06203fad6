"""Show the roles of docstrings, such as :meth:`Voxels.mesh`, as code on the pages."""

from __future__ import annotations

import re
from typing import Any

_ROLE = re.compile(r":(?:attr|class|data|func|meth|mod):<code>(~?)([^<]*)</code>")


def on_page_content(html: str, **_: Any) -> str:  # noqa: ANN401 - what mkdocs passes
    """Turn each role into code; one that starts with ``~`` shows the last name only."""
    return _ROLE.sub(lambda role: f"<code>{_shown(*role.groups())}</code>", html)


def _shown(tilde: str, name: str) -> str:
    return name.rpartition(".")[2] if tilde else name
