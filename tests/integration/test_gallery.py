"""The gallery of the documentation: at least twelve robots, each made by its command."""

import importlib.util
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def gallery():
    spec = importlib.util.spec_from_file_location("gallery", DOCS / "gallery.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["gallery"] = module  # where its dataclasses look for their types
    spec.loader.exec_module(module)
    yield module
    del sys.modules["gallery"]


@pytest.fixture
def magnetic(gallery, tmp_path, monkeypatch):
    """Files made for the robot that is solved soonest."""
    monkeypatch.setattr(gallery, "MADE", tmp_path)
    entry = next(each for each in gallery.ENTRIES if each.name == "magnetic_gripper")
    return entry, *gallery.made(entry)


def test_twelve_robots_have_a_design_and_a_picture(gallery):
    assert len({entry.name for entry in gallery.ENTRIES}) >= 12
    for entry in gallery.ENTRIES:
        assert entry.design.is_file()
        assert entry.picture.read_bytes()[8:12] == b"WEBP"
        assert entry.heading
        assert entry.words.endswith(".")


def test_the_page_has_one_place_for_the_robots(gallery):
    assert (DOCS / gallery.PAGE).read_text(encoding="utf-8").count(gallery.PLACE) == 1


@pytest.mark.slow
def test_a_robot_is_shown_with_live_page_command_figure_and_text(gallery, magnetic):
    entry, page, result = magnetic
    assert result["status"] == "ok"
    assert "voxsoft-scene" in page.read_text(encoding="utf-8")
    text = gallery.section(entry, result)
    assert 'href="magnetic_gripper.html"' in text
    assert "    voxsoft run examples/magnetic_gripper.toml\n" in text
    assert " ± " in text
    assert "name = &quot;magnetic gripper&quot;" in text
    # Existing files are not made again.
    before = page.stat().st_mtime_ns
    gallery.made(entry)
    assert page.stat().st_mtime_ns == before


def test_a_figure_has_as_many_digits_as_its_error_lets_be_known(gallery):
    figure = gallery.along("tip", "tip", "z")
    bar = {"value": -0.0126, "estimate": -0.01403661, "error": 0.00033}
    result = {"error_bars": {"probes": {"tip": {"z": bar}}, "metrics": {}}}
    assert gallery.shown(figure, result) == "-14.04 ± 0.33 mm"
    result["error_bars"]["probes"]["tip"]["z"] = bar | {"error": 0.0033}
    assert gallery.shown(figure, result) == "-14.0 ± 3.3 mm"
    bare = {"error_bars": {}, "probes": {"tip": {"displacement": [0, 0, -0.0126]}}}
    assert gallery.shown(figure, bare) == "-12.6 mm, without an error bar"


def test_a_command_that_fails_ends_the_build(gallery):
    with pytest.raises(RuntimeError, match="voxsoft check examples/nobody"):
        gallery.voxsoft("check", "examples/nobody.toml")
