"""``voxsoft refine``: small voxels where the error of a design is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from voxsoft.cli.exits import NOT_AT_REST, errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import plain, print_json, say

if TYPE_CHECKING:
    from voxsoft.simulation import CheckReport


#: From this part of small voxels everywhere on these take no longer: a finger that is refined to
#: 0.8 takes 1.6 times their time, a block to 0.4 half of it (`evidence/local_refinement.py`).
_MOST = 0.6


def refine(
    design: DesignFile,
    sets: Sets = None,
    share: Annotated[
        str, typer.Option("--share", help="Share of the estimated error within small voxels.")
    ] = "90 %",
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File, replaced if it is there; default: DESIGN-refined."),
    ] = None,
    json: Json = False,
) -> None:
    """Solve a design, and halve its voxels where most of the error is.

    The file that is written has the voxels as boxes under [[refine]], after those that are there,
    and all else as it was.
    """
    from voxsoft import files
    from voxsoft.cli.progress import ProgressBar
    from voxsoft.comparison import refined
    from voxsoft.comparison.refining import check_share
    from voxsoft.design.document.documents import with_paths_from
    from voxsoft.errors import FileError
    from voxsoft.files.atomic import write_atomically
    from voxsoft.files.designs import read_text
    from voxsoft.files.toml_edits import with_document
    from voxsoft.simulation import Setup, check, simulate
    from voxsoft.units import si_value

    with errors_in_words(json=json):
        part = si_value(share, "number", "--share")
        loaded = files.load(design, assignments=sets or [])
        check_share(part)
        target = out or design.with_name(f"{design.stem}-refined.toml")
        if out is None and target.exists():
            what = "is there already, and its boxes may have been changed by hand"
            raise FileError(str(target), what, f"remove it, or write --out {target.name}")
        with ProgressBar("refining", 3, transient=True) as bar:
            bar.advance_to(1, "solving on the design's own voxels")
            result = simulate(loaded.replace(refine=()))
            if result.status != "ok":
                if json:
                    print_json({"status": result.status, "message": result.message})
                else:
                    say(f"[red]{result.status}[/red]: {plain(result.message)}")
                raise typer.Exit(NOT_AT_REST)
            bar.advance_to(2, "looking where the error is")
            found = refined(result, part)
            found = found.replace(refine=[*loaded.refine, *found.refine])
            report = check(found)
            bar.advance_to(3)
        text = with_document(read_text(design), with_paths_from(found.document, target.parent))
        write_atomically(target, text)
        before = Setup(result.design, result.mesh).elements
        summary: dict[str, Any] = {
            "file": str(target),
            "boxes": len(found.refine),
            "voxels": before,
            "refined_voxels": Setup.of(found).elements,
            "everywhere": 8 * before,
            "instead": f"refine = {2 * loaded.solver.refine} under [solver]",
        }
        if json:
            print_json(summary)
        else:
            _show(summary, report)


def _show(summary: dict[str, Any], report: CheckReport) -> None:
    say(
        f"{summary['boxes']} boxes of small voxels: {summary['refined_voxels']:,} voxels in place "
        f"of {summary['voxels']:,}; small ones everywhere would be {summary['everywhere']:,}"
    )
    if summary["refined_voxels"] > _MOST * summary["everywhere"]:
        instead = plain(summary["instead"])
        say(f"[yellow]that is most of them[/yellow]: {instead} is likely as quick, and better")
    if report.cost is not None:
        say(f"one run: {report.cost.sentence}")
    file = plain(summary["file"])
    say(f"wrote {file}; its numbers with error bars: voxsoft run {file}")
