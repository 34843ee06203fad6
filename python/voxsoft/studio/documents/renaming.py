"""Another name for a named thing of a design, everywhere the text speaks of it.

Lines are changed where they stand, so that comments, layout and texts that are no design yet stay.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection
from typing import Final

from voxsoft.design.document.formula import is_formula, with_renamed
from voxsoft.errors import DesignError
from voxsoft.studio.protocol.commands import Named

#: Lists whose entries hold their names, in place of keys before their tables.
_LISTS: Final[frozenset[Named]] = frozenset({"bodies", "objects"})

#: Lines that refer to names: a probe called like a shape must not rename the shape.
_SPEAKING: Final[dict[Named, re.Pattern[str] | None]] = {
    "bodies": re.compile(r"\b(?:body|object|cavity|probe)\s*="),
    "objects": re.compile(r"\bobject\s*="),
    "parameters": re.compile(""),
    "shapes": re.compile(r"\b(?:of|shape|by|base|inner|outer)\s*="),
    "materials": re.compile(r"\bmaterial\s*="),
    "histories": re.compile(r"\bhistory\s*="),
    "chambers": re.compile(r"\bcavity\s*="),
    "probes": re.compile(r"\bprobe\s*="),
    "objectives": None,
    "constraints": None,
}

_NAME: Final = re.compile(r"[A-Za-z_][\w-]*", re.ASCII)
#: Formulas read a minus sign where the name of a parameter had one.
_IN_FORMULAS: Final = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_HEADER: Final = re.compile(r"\s*\[\[?\s*([\w-]+)", re.ASCII)
_TEXT: Final = re.compile(r'"((?:\\.|[^"\\])*)"|\'([^\']*)\'')


def renamed(text: str, section: Named, name: str, to: str) -> str:
    r"""Give one thing of a design's text another name.

    Parameters
    ----------
    text
        The text of a design, good or not.
    section
        Section of the thing.
    name, to
        Its name as it is, and its name from now on: letters, digits, `_` and, but for
        parameters, `-`.

    Raises
    ------
    DesignError
        The new name is none or is taken, nothing in the section has the old one, or a table on
        one line holds it.

    Examples
    --------
    >>> text = '[parameters]\nwall = "5 mm"\n[shapes]\nrod = { size = ["= 2*wall", 1, 1] }'
    >>> print(renamed(text, "parameters", "wall", "skin"))
    [parameters]
    skin = "5 mm"
    [shapes]
    rod = { size = ["= 2*skin", 1, 1] }
    """
    own = section == "parameters"
    if not (_IN_FORMULAS if own else _NAME).fullmatch(to):
        hint = "use letters, digits and _" if own else "use letters, digits, _ and -"
        raise DesignError(f"{section}.{name}", f"cannot be called {to!r}", hint)
    known = _names(text, section)
    if to in known:
        raise DesignError(f"{section}.{name}", f"cannot be called {to!r}: the name is taken")
    lines = []
    current = ""
    defined = False
    for line in text.split("\n"):
        code, comment = _parted(line)
        header = _HEADER.match(code)
        if header:
            current = header[1]
        after = code
        if section not in _LISTS:
            after = _redefined(code, current == section and not header, section, name, to)
        own_entry = section in _LISTS and current == section and re.match(r"\s*name\s*=", after)
        pair = section in _LISTS and current == "contact"
        speaking = _SPEAKING[section]
        changed = after
        if own_entry or pair or (speaking and speaking.search(after)):
            changed = _mentioned(after, section, name, to)
        defined |= after != code or bool(own_entry and changed != after)
        lines.append(changed + comment)
    if not defined and name in known:
        what = f"{name!r} stands in a table on one line"
        raise DesignError(section, what, "rename it in the text")
    if not defined:
        raise DesignError(section, f"has nothing called {name!r}", "look at the text as it is now")
    return "\n".join(lines)


def _names(text: str, section: Named) -> Collection[str]:
    """Names in a section; none while the text is no TOML."""
    try:
        found = tomllib.loads(text).get(section, {})
    except tomllib.TOMLDecodeError:
        return ()
    if section in _LISTS:
        return [str(each.get("name")) for each in found if isinstance(each, dict)]
    return list(found) if isinstance(found, dict) else ()


def _parted(line: str) -> tuple[str, str]:
    """Split a line into its code and its comment."""
    quote = ""
    at = 0
    while at < len(line):
        letter = line[at]
        if quote:
            if letter == "\\" and quote == '"':
                at += 1
            elif letter == quote:
                quote = ""
        elif letter in "\"'":
            quote = letter
        elif letter == "#":
            return line[:at], line[at:]
        at += 1
    return line, ""


def _redefined(code: str, inside: bool, section: Named, name: str, to: str) -> str:
    """Change the key itself, where its section defines it."""
    key = f'"?{re.escape(name)}"?'
    header = re.compile(rf"(\s*\[\s*{section}\s*\.\s*){key}(\s*[\].])")
    entry = re.compile(rf"(\s*){key}(\s*[=.])")
    for pattern in (header, *([entry] if inside else [])):
        if found := pattern.match(code):
            return f"{found[1]}{to}{found[2]}{code[found.end() :]}"
    return code


def _mentioned(code: str, section: Named, name: str, to: str) -> str:
    """Change mentions in texts: whole texts name things, formulas name parameters."""

    def changed(found: re.Match[str]) -> str:
        text = found[1] if found[1] is not None else found[2]
        quote = found[0][0]
        if section == "parameters":
            return f"{quote}{with_renamed(text, name, to)}{quote}" if is_formula(text) else found[0]
        # Names in a body begin with its name: left.tip.
        if section == "bodies" and text.startswith(f"{name}."):
            return f"{quote}{to}{text[len(name) :]}{quote}"
        return f"{quote}{to}{quote}" if text == name else found[0]

    return _TEXT.sub(changed, code)
