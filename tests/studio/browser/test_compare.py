"""Two bodies side by side under one camera, and the specimen of a calibration with its stations."""

import io
import json
import re
import shutil

import numpy as np
import pytest

from voxsoft import files, load
from voxsoft.simulation import Setup, simulate
from voxsoft.studio.outputs.stills import design_in
from voxsoft.study import Study

pytestmark = pytest.mark.browser


def pixels(tab, part=(0.0, 1.0)):
    """Colors of a part of the picture between two shares of its width, (h, w, 3)."""
    from matplotlib.image import imread

    box = tab.page.locator("[data-testid=still] canvas").bounding_box()
    clip = {
        # The words at the top are no part of the picture.
        "x": box["x"] + part[0] * box["width"] + 2,
        "y": box["y"] + 50,
        "width": (part[1] - part[0]) * box["width"] - 4,
        "height": box["height"] - 52,
    }
    return imread(io.BytesIO(tab.page.screenshot(clip=clip)))[:, :, :3]


LEFT, RIGHT = (0.0, 0.5), (0.5, 1.0)


def colors(picture):
    return len(np.unique((255 * picture).astype(np.uint8).reshape(-1, 3), axis=0))


def alike(one, other):
    """Check if two pictures are the same but for the rims of cells."""
    height, width = (min(pair) for pair in zip(one.shape[:2], other.shape[:2], strict=True))
    apart = np.abs(one[:height, :width] - other[:height, :width]).max(axis=2) > 0.05
    return apart.mean() < 0.004


def bright(picture):
    """Number of points with the color of the largest value."""
    red, green, blue = np.moveaxis(picture, 2, 0)
    return int(((red > 0.6) & (green > 0.6) & (blue < 0.35)).sum())


def settled(tab, part=(0.0, 1.0)):
    """The picture once it stays the same."""
    before = pixels(tab, part)
    while True:
        now = pixels(tab, part)
        if np.array_equal(before, now):
            return now
        before = now


@pytest.fixture(scope="module")
def compared_runs(served):
    """Two runs and a study of the server's design, as the command line leaves them."""
    for name, length in (("short", 0.04), ("long", 0.06)):
        design = load(served.source, length=length)
        files.write_run(simulate(design), served.runs / name)
    sag = {"sag": {"minimize": "max_displacement"}}
    folder = served.runs / "bars"
    Study(load(served.source), {"length": [0.03, 0.05]}, sag, folder=folder).grid(workers=1)
    return served


def compare(tab, *names):
    for name in names:
        tab.page.get_by_label(f"Compare {name}", exact=True).check()
    tab.find("compare-runs").click()
    tab.find("compared-bodies").wait_for()


@pytest.fixture
def side_by_side(compared_runs, open_tab):
    tab = open_tab(compared_runs.address, mode="runs")
    tab.find("runs-table").get_by_text("short").wait_for()
    compare(tab, "short", "long")
    tab.find("largest-long").wait_for()
    tab.find("largest-short").wait_for()
    return tab


def largest_of(tab, name):
    return re.search(r"largest ([\d.]+) mm", tab.find(f"largest-{name}").inner_text())[1]


class TestCompare:
    def test_two_runs_stand_side_by_side_with_their_summaries(self, side_by_side, compared_runs):
        tab = side_by_side
        due = {}
        for name in ("short", "long"):
            reported = json.loads((compared_runs.runs / name / "summary.json").read_text())
            due[name] = 1e3 * reported["metrics"]["max_displacement"]
            assert float(largest_of(tab, name)) == pytest.approx(due[name], rel=1e-3)
        change = re.search(r"\(([+−][\d.]+) %\)", tab.find("largest-long").inner_text())[1]
        assert float(change) == pytest.approx(100 * (due["long"] / due["short"] - 1), rel=1e-2)
        # Both are colored over one range, that of the larger.
        assert f"{due['long']:.3g} mm" in tab.find("color-bar").inner_text()
        for part in (LEFT, RIGHT):
            assert colors(settled(tab, part)) > 200
        assert bright(settled(tab, LEFT)) == 0 < bright(settled(tab, RIGHT))
        tab.shot("compare")
        assert tab.errors == []

    @pytest.mark.slow
    def test_turning_one_turns_the_other(self, compared_runs, open_tab):
        if not (compared_runs.runs / "twin").exists():
            shutil.copytree(compared_runs.runs / "short", compared_runs.runs / "twin")
        tab = open_tab(compared_runs.address, mode="runs")
        compare(tab, "short", "twin")
        tab.find("largest-short").wait_for()
        tab.find("largest-twin").wait_for()
        box = tab.page.locator("[data-testid=still] canvas").bounding_box()
        before = settled(tab, LEFT)
        assert alike(before, settled(tab, RIGHT))
        x, y = box["x"] + box["width"] / 4, box["y"] + box["height"] / 2
        tab.page.mouse.move(x, y)
        tab.page.mouse.down()
        tab.page.mouse.move(x + 70, y + 20, steps=4)
        tab.page.mouse.up()
        turned = settled(tab, LEFT)
        assert not alike(turned, before)
        assert alike(turned, settled(tab, RIGHT))
        # The wheel and the keys on the other side steer both as well.
        tab.page.mouse.move(box["x"] + 0.75 * box["width"], y)
        tab.page.mouse.wheel(0, 300)
        far = settled(tab, LEFT)
        assert not alike(far, turned)
        tab.page.keyboard.press("ArrowLeft")
        last = settled(tab, LEFT)
        assert not alike(last, far)
        assert alike(last, settled(tab, RIGHT))

    def test_another_field_colors_both_and_one_lies_over_the_other(self, side_by_side):
        tab = side_by_side
        tab.page.get_by_label("Color both by").select_option(label="Von Mises stress")
        tab.find("largest-short").get_by_text("kPa").wait_for()
        assert "kPa" in tab.find("color-bar").inner_text()
        tab.find("compare-over").click()
        one = settled(tab)
        assert colors(one) > 200
        tab.shot("compare-over")
        assert tab.errors == []

    def test_designs_of_a_study_are_solved_for_the_picture(self, compared_runs, open_tab):
        tab = open_tab(compared_runs.address, mode="runs")
        compare(tab, "bars", "short")
        tab.find("largest-bars").wait_for()
        tab.find("largest-short").wait_for()
        assert float(largest_of(tab, "bars")) < float(largest_of(tab, "short"))

    @pytest.mark.slow
    def test_a_run_that_was_deleted_meanwhile_is_reported_beside_the_other(
        self, compared_runs, open_tab
    ):
        shutil.copytree(compared_runs.runs / "short", compared_runs.runs / "doomed")
        (compared_runs.runs / "doomed" / "result.vtu").unlink()
        tab = open_tab(compared_runs.address, mode="runs")
        tab.find("runs-table").get_by_text("doomed").wait_for()
        compare(tab, "short", "doomed")
        tab.find("largest-short").wait_for()
        reported = tab.find("still").get_by_role("alert")
        reported.get_by_text("holds no result").wait_for()
        shutil.rmtree(compared_runs.runs / "doomed")
        reported.get_by_role("button", name="Try again").click()
        reported.get_by_text("is not in the list of runs any more").wait_for()
        assert colors(settled(tab, LEFT)) > 200
        # Once it is there again, comparing again shows it.
        shutil.copytree(compared_runs.runs / "short", compared_runs.runs / "doomed")
        tab.find("compare-runs").click()
        tab.find("largest-doomed").wait_for()
        reported.wait_for(state="detached")

    def test_nobody_waits_for_a_body_whose_pane_is_closed(self, compared_runs, open_tab):
        tab = open_tab(compared_runs.address, mode="runs")
        given_up = []
        tab.page.on("requestfailed", lambda request: given_up.append(request.url))
        tab.page.route("**/still?of=bars", lambda route: None)  # a solver that takes its time
        compare(tab, "bars", "short")
        tab.find("largest-short").wait_for()
        assert tab.find("still").get_by_role("status").inner_text() == "Solving…"
        with tab.page.expect_event("requestfailed"):
            tab.find("mode-simulate").click()
        assert [url for url in given_up if url.endswith("of=bars")] == given_up != []

    def test_a_server_that_does_not_answer_is_reported(self, compared_runs, open_tab):
        tab = open_tab(compared_runs.address, mode="runs")
        tab.page.route("**/still?of=long", lambda route: route.abort("connectionrefused"))
        compare(tab, "short", "long")
        reported = tab.find("still").get_by_role("alert")
        reported.get_by_text("VoxSoft does not answer.").wait_for()
        tab.page.unroute("**/still?of=long")
        reported.get_by_role("button", name="Try again").click()
        tab.find("largest-long").wait_for()
        reported.wait_for(state="detached")


MEASURED = "s (mm),dz (mm)\n30,-10\n60,-30\n90,-52\n"


class TestCalibrate:
    @pytest.mark.slow
    def test_the_specimen_bends_beside_its_measurement(self, own_server, open_tab, tmp_path):
        tab = open_tab(own_server.address, mode="calibrate")
        tab.page.get_by_role("button", name="Open the cantilever beam").click()
        tab.find("document-name").get_by_text("beam").wait_for()
        file = tmp_path / "beam.csv"
        file.write_text(MEASURED)
        tab.find("measurement-file").set_input_files(file)
        tab.find("measured").get_by_text("3 stations").wait_for()
        for name, value in (("Generations", "500"), ("Population", "12")):
            tab.page.get_by_role("textbox", name=name).fill(value)
            tab.page.get_by_role("textbox", name=name).press("Enter")
        tab.page.get_by_role("tab", name="Measured and simulated").click()
        tab.find("calibrate-start").click()
        words = tab.find("overlay-space").locator(".view-label")
        words.nth(2).wait_for()
        tab.find("color-bar").wait_for()  # the body is there
        job = tab.find("job-calibrate")
        assert job.get_attribute("data-state") == "running"
        job.get_by_role("button", name="Pause").click()
        tab.page.locator("[data-testid=job-calibrate][data-state=paused]").wait_for(timeout=60_000)
        assert colors(settled(tab)) > 200
        reported = error_events(tab)
        assert reported == words.all_inner_texts()
        # The body lies where the best candidate lies: its largest displacement is that of the tip.
        folder = own_server.runs / "beam-calibration"
        with np.load(folder / "specimen.npz") as specimen:
            rest = Setup.of(design_in(folder)).mesh.vertices
            largest = 1e3 * np.linalg.norm(specimen["positions"] - rest, axis=1).max()
        bar = "document.querySelector('[data-testid=color-bar]').innerText"
        tab.until(f"{bar}.includes('{float(f'{largest:.3g}'):g} mm')")
        job.get_by_role("button", name="Stop").click()
        tab.page.locator("[data-testid=job-calibrate][data-state=stopped]").wait_for(timeout=60_000)
        tab.shot("calibrate-space")
        assert words.count() == 3
        tab.find("overlay-plane").click()
        tab.page.locator("[data-testid=overlay-chart] .overlay-measured").nth(2).wait_for()
        assert tab.errors == []


def error_events(tab):
    """The errors as the table beside tells them."""
    rows = tab.find("errors-table").locator("tbody tr").all()
    cells = [row.locator("td").all_inner_texts()[-2:] for row in rows]
    return [f"{error}, {percent}" for error, percent in cells]
