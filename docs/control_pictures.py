"""Draw the pictures of the how-to on closed loops: ``python docs/control_pictures.py``.

The program of docs/how-to/control.md runs as it stands there, which takes a minute. Its frequency
response becomes docs/images/control_bode.png, and its last wave, with the predictive controller,
control_track.png.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final

from voxsoft.plot import plot_bode, plot_track

DOCS: Final = Path(__file__).parent
PAGE: Final = DOCS / "how-to" / "control.md"
IMAGES: Final = DOCS / "images"
#: Last heading of the page that the pictures need.
END: Final = "## Hold a grasp"


def main() -> None:
    """Run the page up to the grasp, and draw."""
    page = PAGE.read_text(encoding="utf-8")
    program = "\n".join(re.findall(r"```python\n(.*?)```", page[: page.index(END)], re.DOTALL))
    names: dict[str, Any] = {}
    exec(compile(program, str(PAGE), "exec"), names)
    plot_bode(names["bode"]).savefig(IMAGES / "control_bode.png")
    plot_track(names["track"]).savefig(IMAGES / "control_track.png")


if __name__ == "__main__":
    main()
