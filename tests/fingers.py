"""A study of fingers of several lengths, and the atlas that shows it."""

import tomllib
from concurrent.futures import ThreadPoolExecutor

from voxsoft.design import Design
from voxsoft.study import Study

LENGTHS = [0.025, 0.03, 0.035, 0.04, 0.045, 0.05]
#: Number of loaded pictures of designs.
SEEN = "[...document.querySelectorAll('.trial-frame img')].filter(i => i.naturalWidth > 0).length"
GOAL = '[objectives]\nsag = { minimize = "displacement", probe = "tip", axis = "z" }\n'


def study_fingers(text, folder):
    """Study six fingers, and one that is too short to hold a voxel; returns the design's text."""
    text = text.replace('min = "20 mm"', 'min = "1 um"').replace(', step = "5 mm"', "")
    design = Design.from_document(tomllib.loads(text + GOAL))
    with ThreadPoolExecutor(1) as threads:
        Study(design, {"length": [*LENGTHS, 1e-5]}, folder=folder).grid(executor=threads)
    return text


def open_atlas(tab, count=None):
    """Open the one study of the list of runs, and wait for so many pictures of its designs."""
    tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
    tab.find("mode-runs").click()
    tab.find("runs-table").locator("tbody tr").first.click()
    tab.find("mode-optimize").click()
    tab.page.get_by_role("tab", name="Atlas").click()
    tab.find("atlas").wait_for()
    tab.until(f"{SEEN} === {count or len(LENGTHS)}")
