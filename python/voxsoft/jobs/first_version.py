"""Jobs as the studio wrote them before ``job.toml``: read, and never written again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

from voxsoft.errors import FileError

#: File name of a job of the first version.
FIRST: Final = "job.json"


def read_first(folder: Path) -> dict[str, Any]:
    """Read a job of the first version as the entries of a :class:`voxsoft.jobs.Job`.

    Raises
    ------
    FileError
        The file is damaged.
    """
    try:
        content = json.loads((folder / FIRST).read_bytes())
        spec = {key: value for key, value in content["spec"].items() if key not in ("name", "data")}
        spec = {key: value for key, value in spec.items() if value is not None}
        spec["design"] = {"text": content["design"], "folder": content["base"]}
        if spec["kind"] == "calibrate":
            spec["data"] = content["tables"]
        if spec["kind"] == "study" and spec.get("sampler", "grid") == "grid":
            spec.pop("budget", None)
        return {"spec": spec, "version": content.get("version", "")}
    except OSError as error:
        raise FileError(str(folder), f"holds no job: {error.strerror}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise FileError(str(folder / FIRST), f"is damaged: {error!r}") from None
