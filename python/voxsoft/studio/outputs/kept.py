"""A run folder of the state on the screen, with its live loads and pulls."""

from __future__ import annotations

from pathlib import Path

import msgspec

from voxsoft import files
from voxsoft.design.tendon import PULLS
from voxsoft.files.designs import read_document
from voxsoft.files.toml_edits import with_value
from voxsoft.jobs import DesignSource, RunSpec
from voxsoft.jobs.copies import with_copies
from voxsoft.jobs.folder import write_job
from voxsoft.studio.outputs.exports import Shown
from voxsoft.units import format_quantity


def keep(shown: Shown, base: Path, folder: Path) -> str:
    """Write the shown state as a run folder; nothing is solved again.

    Parameters
    ----------
    shown
        The shown state.
    base
        Base of relative paths of the design.
    folder
        Folder to write.

    Returns
    -------
    str
        Description of the kept state, in a sentence.

    Raises
    ------
    VoxSoftError
        The state cannot be measured, or the folder not written.
    """
    result = shown.measured()
    pulls = {"pulls": [msgspec.to_builtins(pull) for pull in shown.pulls]}
    files.write_run(result, folder, more=pulls if shown.pulls else {})
    # With the text as it was typed the parameters can go on to be varied.
    design = DesignSource(text=with_live_loads(shown), folder=str(base))
    write_job(with_copies(RunSpec(design=design, kept=True), folder), folder)
    return f"{folder.name}: {result.message}{_under(shown)}"


def with_live_loads(shown: Shown) -> str:
    """The text of the design with loads and tendons as they are where hands changed them."""
    text = shown.text
    live = shown.body.under(shown.factors).design.document
    written = read_document(text, shown.name)
    loads, count = written.get("loads", []), len(shown.body.setup.design.loads)
    for index, factor in enumerate(shown.factors[:count]):
        if factor != 1.0 and index < len(loads):
            text = with_value(text, ["loads", index, "value"], live["loads"][index]["value"])
    tendons = written.get("tendons", [])
    for index, factor in enumerate(shown.factors[count:]):
        if factor != 1.0 and index < len(tendons):
            table = live["tendons"][index]
            for key in {*PULLS} & {*table, *tendons[index]}:
                text = with_value(text, ["tendons", index, key], table.get(key))
    return text


def _under(shown: Shown) -> str:
    """Describe the live loads and pulls that hold the state beside the design."""
    phrases = []
    for load, factor in zip(shown.body.loads, shown.factors, strict=True):
        if factor != 1.0:
            phrases.append(f"{load.label} {format_quantity(factor * load.value, load.quantity)}")
    if shown.pulls:
        total = sum(sum(part**2 for part in pull.force) ** 0.5 for pull in shown.pulls)
        count = "1 pull" if len(shown.pulls) == 1 else f"{len(shown.pulls)} pulls"
        phrases.append(f"{count} by hand, {format_quantity(float(f'{total:.3g}'), 'force')}")
    return f" under {', '.join(phrases)}" if phrases else ""
