"""Differences of two texts, line by line, with some lines around each change."""

from __future__ import annotations

from difflib import SequenceMatcher
from typing import Final

from voxsoft.studio.protocol import events

#: Lines that are shown around a change.
AROUND: Final = 3
#: Texts of more lines are not compared: that would take long.
MOST_LINES: Final = 20_000


def line_differences(before: str, after: str) -> list[events.DifferentLine] | None:
    r"""Tell how to come from one text to another: lines that stay, go and come, gaps between.

    Parameters
    ----------
    before, after
        The texts.

    Returns
    -------
    list of DifferentLine or None
        Empty where both are equal; None where they are too long to be compared.

    Examples
    --------
    >>> found = line_differences("a = 1\nb = 2", "a = 1\nb = 3")
    >>> [(each.mark, each.text) for each in found]
    [('same', 'a = 1'), ('gone', 'b = 2'), ('new', 'b = 3')]
    """
    old, new = before.splitlines(), after.splitlines()
    if len(old) + len(new) > MOST_LINES:
        return None
    lines: list[events.DifferentLine] = []
    groups = SequenceMatcher(None, old, new, autojunk=False).get_grouped_opcodes(AROUND)
    for number, group in enumerate(groups):
        if number:
            lines.append(events.DifferentLine(mark="gap", text="", before=group[0][1]))
        for tag, first, last, new_first, new_last in group:
            if tag == "equal":
                for at, text in enumerate(old[first:last]):
                    places = {"before": first + at + 1, "after": new_first + at + 1}
                    lines.append(events.DifferentLine(mark="same", text=text, **places))
                continue
            for at, text in enumerate(old[first:last], first + 1):
                lines.append(events.DifferentLine(mark="gone", text=text, before=at))
            for at, text in enumerate(new[new_first:new_last], new_first + 1):
                lines.append(events.DifferentLine(mark="new", text=text, after=at))
    return lines
