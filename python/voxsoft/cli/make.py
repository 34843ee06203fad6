"""``voxsoft make``: molds for casting a robot, and a sheet that says how."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import INVALID, USAGE, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import plain, print_json, quantity, say, show_table
from voxsoft.errors import DesignError

if TYPE_CHECKING:
    from voxsoft.fabrication import Fabrication


def make(
    design: DesignFile,
    sets: Sets = None,
    way: Annotated[
        str | None,
        typer.Option(
            "--way",
            help="cast, core, halves, lost-core, printed, or first for the first that the shape "
            "allows; default: that of the design's molds, else first.",
        ),
    ] = None,
    body: Annotated[
        str | None, typer.Option("--body", help="The body to make, of a design with several.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder; default: runs/NAME-make.")
    ] = None,
    printer: Annotated[
        list[str] | None,
        typer.Option(
            "--printer",
            metavar="NAME=VALUE",
            help="A limit of the printer: wall='0.8 mm', clearance, tube, vent, pour, resolution, "
            "dowel, draft='1 deg', volume='220 mm, 220 mm, 220 mm'. Repeatable.",
        ),
    ] = None,
    shrinkage: Annotated[
        str | None,
        typer.Option(
            "--shrinkage",
            help="Shrinkage of all castings, '0.2 %'; default: that of the design's "
            "molds, else of the silicone.",
        ),
    ] = None,
    stl: Annotated[bool, typer.Option("--stl", help="Parts as STL in mm, not as 3MF.")] = False,
    shift: Annotated[
        bool,
        typer.Option(
            "--shift", help="Also run the design with cores 0.2 mm aside, and say what changes."
        ),
    ] = False,
    json: Json = False,
) -> None:
    """Make molds, cores and plates for casting a robot, and prove them before they are written."""
    from voxsoft import files
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.comparison.core_shift import core_shift
    from voxsoft.fabrication import ASKED_WAYS, Printer, one_body
    from voxsoft.fabrication import make as make_molds
    from voxsoft.files.fabrication import fabrication_summary, write_fabrication
    from voxsoft.units import parse

    if way is not None and way not in ASKED_WAYS:
        say(f"--way: {plain(way)} is not known; expected {', '.join(ASKED_WAYS)}")
        raise typer.Exit(USAGE)
    with errors_in_words(json=json):
        limits = dict(_limit(each) for each in printer or [])
        loaded = files.load(design, assignments=sets or [])
        if body is not None:
            loaded = one_body(loaded, body)
        printers = Printer() if loaded.molds is None else loaded.molds.printer
        wanted = next((each for each in ASKED_WAYS if each == way), None)
        with ProgressBar("molds", 1) as bar:

            def report(done: int, total: int) -> None:
                bar.set_total(total)
                bar.advance_to(done)

            made = make_molds(
                loaded,
                way=wanted,
                printer=printers.replace(**limits),
                shrinkage=None if shrinkage is None else parse(shrinkage, "number"),
                progress=report,
            )
        summary = fabrication_summary(made, ".stl" if stl else ".3mf")
        if shift and not made.problems:
            summary["core_shift"] = [_shift(each) for each in core_shift(loaded)]
        if not made.problems:
            folder = out or Path("runs") / f"{folder_name(loaded.name)}-make"
            write_fabrication(made, folder, stl=stl)
            summary["folder"] = str(folder)
        if json:
            print_json(summary)
        else:
            _show(made, summary)
    if made.problems:
        raise typer.Exit(INVALID)


def _limit(text: str) -> tuple[str, Any]:
    name, equals, value = text.partition("=")
    if not equals:
        raise DesignError("printer", f"{text!r} came; expected NAME=VALUE", "wall='0.8 mm'")
    if name.strip() == "volume":
        return "volume", [each.strip() for each in value.split(",")]
    return name.strip(), value.strip()


def _shift(each: Any) -> dict[str, Any]:  # noqa: ANN401 - a CoreShift, imported when used
    return {
        "probe": each.probe,
        "shift": each.shift,
        "displacement": list(each.displacement),
        "changes": [list(row) for row in each.changes],
        "largest": each.largest,
    }


def _show(made: Fabrication, summary: dict[str, Any]) -> None:
    color = "red" if made.problems else "green"
    why = f": {plain(made.why)}" if made.why else ""
    say(f"[{color}]{made.way}[/{color}]{why}")
    rows = [
        [
            each["name"],
            quantity(each["volume"], "volume"),
            quantity(each["poured"], "volume"),
            f"{1e3 * each['deviation']:.3f} mm",
            quantity(each["trapped_air"], "volume"),
            f"{1e3 * each['mass']:.1f} g",
        ]
        for each in summary["castings"]
    ]
    heads = ["casting", "volume", "in the mold", "deviation", "trapped air", "mass"]
    if rows:
        show_table("Castings", heads, rows)
        pour = summary["pour"]
        say(f"mix {1e3 * pour['a']:.1f} g of A and {1e3 * pour['b']:.1f} g of B")
    for note in made.notes:
        say(plain(note))
    for problem in made.problems:
        say(f"[red]{plain(str(problem))}[/red]")
    for each in summary.get("core_shift", []):
        shown = f"{quantity(each['shift'], 'length')} changes {plain(each['probe'])}"
        say(f"a core shift of {shown} by at most {each['largest']:.1%}")
    if "folder" in summary:
        say(f"wrote {plain(summary['folder'])}: sheet.html says how")
