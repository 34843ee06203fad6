"""Events about the fineness of a mesh, and the cost of finer voxels."""

from __future__ import annotations

import tomllib
from types import SimpleNamespace
from typing import Any, cast

import pytest
from own_loop import run

import voxsoft as vs
from voxsoft.comparison import error_bars
from voxsoft.comparison.error_bar import ErrorBar, ErrorBars, share_of
from voxsoft.comparison.refining import refined
from voxsoft.design import families
from voxsoft.errors import DesignError
from voxsoft.files.toml_edits import with_value
from voxsoft.studio.bodies.equilibrium import equilibrium_of, with_error
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.documents.fineness import fineness_of, halved
from voxsoft.studio.outputs.exports import Shown

BEAM = families.family_text("beam").replace('value = "100 mm"', 'value = "40 mm"')
TWO_PARTS = """
schema = "voxsoft/1"
name = "two"
voxel_size = "= wall/2"

[parameters]
wall = "4 mm"

[shapes]
low = { kind = "box", size = ["16 mm", "8 mm", "4 mm"] }
high = { kind = "box", size = ["16 mm", "8 mm", "4 mm"], corner = [0, 0, "4 mm"] }

[[parts]]
shape = "low"
material = "ecoflex-00-30"

[[parts]]
shape = "high"
material = "dragon-skin-10"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "gravity"
"""


def shown(text: str) -> tuple[Shown, DesignDocument, vs.Result]:
    document = DesignDocument(text, "design.toml")
    assert document.design is not None, document.diagnostics
    result = vs.simulate(document.design)
    body = SimpleNamespace(rev=document.rev, topology=3)
    state = SimpleNamespace(body=body, measured=lambda: result)
    return cast("Shown", state), document, result


def changed(text: str, changes: list[Any]) -> vs.Design:
    for path, value in changes:
        text = with_value(text, path, value)
    design = DesignDocument(text, "design.toml").design
    assert design is not None
    return design


def test_halving_is_an_edit_that_makes_the_voxels_half_as_large() -> None:
    for text in (BEAM, TWO_PARTS):
        state, document, result = shown(text)
        found = fineness_of(state, document)
        assert document.design is not None
        finer = changed(text, [(change.path, change.value) for change in found.halving])
        assert finer.voxel_size == pytest.approx(document.design.voxel_size / 2)
        assert found.half_voxels == 8 * found.voxels
        assert found.half_memory == 8 * found.memory > 0.0
        assert found.seconds == result.seconds
        assert found.half_seconds == pytest.approx(12.0 * result.seconds)


def test_a_formula_is_halved_again_and_again() -> None:
    design = changed(TWO_PARTS, halved(tomllib.loads(TWO_PARTS), families.beam()))
    assert design.voxel_size == pytest.approx(0.001)
    twice = with_value(TWO_PARTS, ["voxel_size"], "= (wall/2)/2")
    (_, value), *_ = halved(tomllib.loads(twice), families.beam())
    assert value == "= (wall/2)/4"


def test_bodies_keep_the_ratio_of_their_voxels() -> None:
    text = """
schema = "voxsoft/1"
name = "pair"
voxel_size = "4 mm"
[[bodies]]
name = "left"
voxel_size = "2 mm"
[[bodies]]
name = "right"
position = ["40 mm", 0, 0]
[shapes]
box = { kind = "box", size = ["16 mm", "8 mm", "8 mm"] }
[[parts]]
shape = "box"
material = "ecoflex-00-30"
body = "left"
[[parts]]
shape = "box"
material = "ecoflex-00-30"
body = "right"
"""
    design = DesignDocument(text, "pair.toml").design
    assert design is not None, DesignDocument(text, "pair.toml").diagnostics
    found = halved(tomllib.loads(text), design)
    assert found == [(["voxel_size"], "2 mm"), (["bodies", 0, "voxel_size"], "1 mm")]


def test_parts_can_be_refined_where_that_is_known() -> None:
    state, document, _ = shown(TWO_PARTS)
    found = fineness_of(state, document)
    assert found.refinable == ["low", "high"]
    design = changed(TWO_PARTS, [(["refine", found.refinements], {"part": "high"})])
    assert design.refine[0].part == "high"
    assert fineness_of(*shown(TWO_PARTS + '\n[[refine]]\npart = "low"\n')[:2]).refinable == ["high"]


def test_the_voxels_with_most_of_the_error_can_be_refined() -> None:
    state, document, result = shown(TWO_PARTS)
    found = fineness_of(state, document)
    design = changed(TWO_PARTS, [(each.path, each.value) for each in found.refining])
    assert design.refine == refined(result).refine != ()
    assert fineness_of(*shown(f'{TWO_PARTS}\n[[refine]]\npart = "low"\n')[:2]).refining == []


def test_a_design_without_refinable_parts_gives_the_reason() -> None:
    both = '[[refine]]\npart = "low"\n[[refine]]\npart = "high"'
    found = fineness_of(*shown(f"{TWO_PARTS}\n{both}\n")[:2])
    assert found.refinable == []
    assert "No other part" in found.not_refined


def test_one_part_is_not_refined_alone() -> None:
    found = fineness_of(*shown(BEAM)[:2])
    assert found.refinable == []
    assert "one part" in found.not_refined


def test_a_body_of_before_is_refused() -> None:
    state, document, _ = shown(BEAM)
    document.replace(BEAM.replace('"5 mm"', '"4 mm"'))
    with pytest.raises(DesignError, match="not the one that is shown"):
        fineness_of(state, document)


def test_errors_are_parts_of_the_numbers() -> None:
    """Error of a vector that is 5 long and 0.5 off, of a volume that grew by 2 and is 1 off."""
    vector = [ErrorBar(3.0, 3.0, 0.3, "length"), ErrorBar(4.0, 4.0, 0.4, "length")]
    assert share_of(vector) == pytest.approx(0.1)
    assert share_of([ErrorBar(12.0, 12.0, 1.0, "volume")], beside=10.0) == pytest.approx(0.5)
    assert share_of([ErrorBar(0.0, 0.0, 0.1, "length")]) is None
    assert share_of([ErrorBar(0.0, 0.0, 0.0, "length")]) == 0.0


def test_error_bars_can_be_asked_for_where_there_are_none() -> None:
    lattice = BEAM.replace('"ecoflex-00-30"', '"ecoflex-00-30-lattice"')
    result = vs.simulate(shown(lattice)[1].design)
    first = equilibrium_of(result, 1, 1, error_bars(result))
    assert first.askable
    assert first.probes[0].share is None
    asked = with_error(result, "finer")
    assert equilibrium_of(asked, 1, 1).looking
    # Finer voxels that failed once would fail again.
    assert not equilibrium_of(asked, 1, 1, ErrorBars.none("it failed", "larger voxels")).askable
    found = equilibrium_of(asked, 1, 1, error_bars(asked))
    assert not found.askable
    assert not found.looking
    assert all(probe.share is not None and probe.share > 0.0 for probe in found.probes)


def test_a_tab_asks_for_the_cost_and_for_the_errors(fresh_studio: Any) -> None:
    lattice = BEAM.replace('"ecoflex-00-30"', '"ecoflex-00-30-lattice"')

    async def scenario() -> None:
        async with fresh_studio.page() as page:
            await page.send("estimate")
            refused = await page.until("error")
            assert "equilibrium" in refused.what
            await page.send("text", rev=page.rev, text=lattice)
            await page.until("body", lambda b: b.voxels == 32)
            await page.send("rest")
            first = await page.until("equilibrium", lambda e: not e.looking)
            assert first.askable
            await page.send("fineness")
            cost = await page.until("fineness")
            assert (cost.topology, cost.voxels, cost.half_voxels) == (first.topology, 32, 256)
            await page.send("estimate")
            await page.until("equilibrium", lambda e: e.looking)
            found = await page.until("equilibrium", lambda e: not e.looking)
            assert found.metrics[0]["share"] > 0.0
            rev = page.rev
            await page.send("edits", rev=rev, changes=cost.halving)
            await page.until("body", lambda b: b.voxels == 256)
            await page.send("undo")
            await page.until("body", lambda b: b.voxels == 32)

    run(scenario())
