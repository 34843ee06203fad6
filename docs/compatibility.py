"""Write the page of features and uses from the table: ``python docs/compatibility.py``."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from voxsoft.simulation.compatibility import USES, reason_of
from voxsoft.simulation.features import FEATURES

PAGE: Final = Path(__file__).with_suffix(".md")
HEAD: Final = """# Features and uses

Each feature of a design with each use of it. **+** works; a number is a refusal, with its reason
below the table. The program refuses by the same table (`voxsoft.simulation.compatibility`), this
page is written from it (`python docs/compatibility.py`), and the tests run its cells on a small
body (`tests/property/test_compatibility.py`). Features in a pair, such as *symmetry and contact*,
are refused together alone.

A setting that the chosen method does not use is refused too, and some refusals depend on more than
the design: a derivative where surfaces slip, or a path along a number that changes the mesh.
"""


def page() -> str:
    """Return the text of the page."""
    cells = {(f, u): reason_of(f, u) for f in FEATURES for u in USES}
    refused = {cell: reason for cell, reason in cells.items() if reason is not None}
    texts = list(dict.fromkeys(refused.values()))
    works = len(cells) - len(refused)
    share = 100 * works / len(cells)
    lines = [
        HEAD,
        f"{works} of {len(cells)} cells work ({share:.1f} %).",
        "",
        "| feature | " + " | ".join(use.title for use in USES.values()) + " |",
        "|---" * (1 + len(USES)) + "|",
    ]
    for feature in FEATURES:
        row = [
            str(1 + texts.index(refused[feature, use])) if (feature, use) in refused else "+"
            for use in USES
        ]
        lines.append(f"| {feature} | " + " | ".join(row) + " |")
    lines += ["", "## Reasons", ""]
    for number, reason in enumerate(texts, start=1):
        of_it = [cell for cell, own in refused.items() if own == reason]
        features = ", ".join(dict.fromkeys(feature for feature, _ in of_it))
        uses = ", ".join(dict.fromkeys(USES[use].title for _, use in of_it))
        lines.append(f"{number}. **{features}** ({uses}): {reason.what}. Instead: {reason.hint}.")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
