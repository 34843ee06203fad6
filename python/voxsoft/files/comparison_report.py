"""Report of a comparison: one self-contained HTML file."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from voxsoft.comparison import Comparison, Run
from voxsoft.comparison.quantities import in_words
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath
from voxsoft.files.run_folder import provenance
from voxsoft.plot.body import plot_body
from voxsoft.plot.comparison import (
    plot_agreement,
    plot_convergence,
    plot_errors,
    plot_shapes,
    plot_times,
)
from voxsoft.units import format_quantity

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem;
  color: #1a1a1a; background: #fff }
h1 { font-size: 1.6rem; margin-bottom: 0 } h2 { font-size: 1.15rem; margin-top: 2.2rem }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.88rem }
th, td { padding: 0.25rem 0.7rem; text-align: right; border-bottom: 1px solid #ddd }
th { border-bottom: 2px solid #888; font-weight: 600; vertical-align: bottom }
th:first-child, td:first-child, .words td:last-child { text-align: left }
.scroll { overflow-x: auto } img { max-width: 100%; height: auto }
.good { color: #00664b } .bad { color: #a63c00 } .quiet { color: #666 }
pre { background: #f5f5f5; padding: 0.8rem; overflow-x: auto; font-size: 0.8rem }
"""


def write_comparison(comparison: Comparison, path: FilePath) -> Path:
    """Write a comparison as one HTML file that needs no other file and no network.

    Parameters
    ----------
    comparison
        Result of :func:`voxsoft.compare`.
    path
        Path of the file; it is replaced if it exists.

    Raises
    ------
    FileError
        The file cannot be written.
    """
    target = Path(path)
    write_atomically(target, "\n".join(_page(comparison)) + "\n")
    return target


def _page(comparison: Comparison) -> Iterator[str]:
    design = comparison.design
    size = format_quantity(design.voxel_size, "length")
    yield '<!doctype html><html lang="en"><head><meta charset="utf-8">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>{escape(design.name)}: comparison</title><style>{_STYLE}</style></head><body>"
    yield f"<h1>{escape(design.name)}</h1>"
    made = provenance()
    versions = ", ".join(f"{key} {value}" for key, value in made["versions"].items())
    yield f'<p class="quiet">voxels of {size}, design {design.hash[:12]}, {escape(versions)}</p>'
    if design.description:
        yield f"<p>{escape(design.description)}</p>"
    yield f"<p>{_verdict(comparison)}</p>"
    yield from _section("Runs", _runs(comparison))
    yield from _section("Answers", _answers(comparison))
    yield from _picture(plot_agreement(comparison), "each quantity as each run has it")
    yield from _picture(plot_shapes(comparison), "where the probes went")
    yield from _section("Discretization error", _estimates(comparison))
    yield from _picture(plot_convergence(comparison), "answers over the size of voxels")
    for index, judged in enumerate(comparison.measured):
        source = f" <span class='quiet'>{escape(judged.source)}</span>" if judged.source else ""
        yield from _section(f"Measurement: {judged.name}", [source, *_measured(comparison, index)])
        yield from _picture(plot_errors(comparison, index), "distance from the measurement")
    yield from _section("Time", [])
    yield from _picture(plot_times(comparison), "time of each run")
    if comparison.base.result is not None and comparison.base.ok:
        yield from _section("The body", [])
        yield from _picture(plot_body(comparison.base.result), "the deformed body")
    yield from _section("The design", [f"<pre>{escape(str(design))}</pre>"])
    yield "</body></html>"


def _section(title: str, lines: Iterable[str]) -> Iterator[str]:
    yield f"<h2>{escape(title)}</h2>"
    yield from lines


def _picture(figure: Figure | None, words: str) -> Iterator[str]:
    if figure is None:
        return
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png")
    data = base64.b64encode(drawn.getvalue()).decode("ascii")
    yield f'<p><img alt="{escape(words)}" src="data:image/png;base64,{data}"></p>'


def _verdict(comparison: Comparison) -> str:
    """Summarize the result in a sentence or two."""
    base, best = comparison.base, comparison.yardstick
    if not base.ok:
        return f'<span class="bad">{escape(base.label)}: {escape(base.message)}</span>'
    if best is None:
        text = comparison.note or "no outside code answered"
        return f'<span class="bad">{escape(text)}</span>'
    shares = [
        abs(share)
        for name in comparison.quantities
        if base.quantities[name].kind == "length"
        and (share := comparison.difference(base, name)) is not None
    ]
    words = f"{escape(base.label)} and {escape(best.label)}"
    if shares:
        words += f" differ by at most {max(shares):.1%} of the displacement of a probe"
    agrees = [
        verdict
        for name in comparison.quantities
        if (verdict := comparison.agrees(name)) is not None
    ]
    if agrees:
        count = f"{sum(agrees)} of {len(agrees)} quantities"
        words += f"; {count} agree within the estimated discretization errors"
    return f"<strong>{words}.</strong>"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], kind: str = "numbers") -> str:
    top = "".join(f"<th>{cell}</th>" for cell in head)
    cells = ("".join(f"<td>{cell}</td>" for cell in row) for row in rows)
    body = "".join(f"<tr>{row}</tr>" for row in cells)
    table = f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"
    return f'<div class="scroll {kind}">{table}</div>'


def _runs(comparison: Comparison) -> Iterator[str]:
    head = ["run", "status", "cells", "time", ""]
    rows = []
    for run in comparison.runs:
        color = "good" if run.ok else "bad"
        status = f'<span class="{color}">{escape(run.status)}</span>'
        text = escape(run.detail if run.ok else run.message)
        cells = f"{run.cells:,}" if run.cells else ""
        rows.append([escape(run.label), status, cells, f"{run.seconds:.3g} s", text])
    yield _table(head, rows, "words")
    if comparison.note:
        yield f"<p>{escape(comparison.note)}</p>"


def _shown(value: float, kind: str) -> str:
    return escape(in_words(value, kind))


def _answers(comparison: Comparison) -> Iterator[str]:
    runs: tuple[Run, ...] = comparison.side_by_side
    if not runs:
        yield "<p>No run came to rest.</p>"
        return
    best = comparison.yardstick
    head = ["quantity", *(escape(run.label) for run in runs)]
    if best is not None:
        head += [f"{escape(comparison.solver)} off", "within the estimates"]
    rows = []
    for name in comparison.quantities:
        row = [escape(name)]
        for run in runs:
            known = run.quantities.get(name)
            row.append(_shown(known.value, known.kind) if known else "")
        if best is not None:
            share = comparison.difference(comparison.base, name)
            row.append("" if share is None else f"{share:+.2%}")
            verdict = comparison.agrees(name)
            words = {True: '<span class="good">yes</span>', False: '<span class="bad">no</span>'}
            row.append("" if verdict is None else words[verdict])
        rows.append(row)
    yield _table(head, rows)
    if best is not None:
        yield (
            '<p class="quiet">Differences are shares of the length of the vector (displacement, '
            f"force) or of the number itself, as {escape(best.label)} has it.</p>"
        )


def _estimates(comparison: Comparison) -> Iterator[str]:
    for warning in comparison.warnings:
        yield f'<p class="bad">{escape(str(warning))}</p>'
    if not comparison.estimates:
        yield "<p>No series has two runs that came to rest.</p>"
        return
    head = ["quantity", "series", "finest", "limit", "error of the finest", "order", "from"]
    rows = []
    for each in comparison.distinguished:
        estimate = each.estimate
        kind = comparison.known(each.quantity).kind
        small = estimate.error < 1e-4 * comparison.known(each.quantity).scale
        rows.append(
            [escape(each.quantity), escape(each.series)]
            + [_shown(number, kind) for number in (estimate.values[-1], estimate.limit)]
            + ["below 0.01 %" if small else _shown(estimate.error, kind)]
            + [f"{estimate.order:.2g}", escape(estimate.basis)]
        )
    yield _table(head, rows)
    yield (
        '<p class="quiet">"Split voxels" are the same body; other "voxel sizes" may change its '
        "shape as well. Errors are estimates with a safety factor (Richardson extrapolation), "
        "no bounds. Two sizes do not show their order, so that their estimates are wide; a third "
        "(--splits 1,2,3) narrows them.</p>"
    )


def _measured(comparison: Comparison, index: int) -> Iterator[str]:
    sag = comparison.measured[index].sag
    rows = []
    for run in comparison.runs:
        errors = comparison.errors(run, index)
        if errors is not None:
            mean, largest = float(errors.mean()), float(errors.max())
            share = f"{largest / sag:.1%}" if sag > 0 else ""
            row = [escape(run.label), _shown(mean, "length"), _shown(largest, "length"), share]
            rows.append(row)
    yield _table(["run", "mean error", "largest", "of the largest displacement"], rows)
