"""The panes of design, studies, runs, calibrations and exports, each on its main path."""

import re

import pytest

pytestmark = pytest.mark.browser

# Longer than any of these short jobs takes on two busy cores, in milliseconds.
JOB = 120_000

LENGTH = "[data-testid=parameter-length] input[aria-label=length]"

MEASURED = "s (mm),sag (mm)\n10,-0.3\n25,-1.7\n40,-4.0\n"


def document_text(tab):
    """The text of the design as the editor shows it; it draws only the lines in sight."""
    return "\n".join(tab.find("text-editor").locator(".cm-line").all_inner_texts())


def has_text(tab, piece):
    tab.until(f"document.querySelector('.cm-content')?.innerText.includes({piece!r})")


@pytest.fixture
def design(served, open_tab):
    """The mode Design on the small cantilever, as its file has it."""
    tab = open_tab(served.address, mode="design")
    tab.find("parameter-length").wait_for()
    tab.find("text-editor").locator(".cm-content").wait_for()
    yield tab
    # A page that goes hands over the text typed last, so that it can be undone too.
    tab.page.reload()
    tab.find("link").get_by_text("connected", exact=True).wait_for()
    tab.find("text-editor").locator(".cm-content").wait_for()
    while tab.page.get_by_role("button", name="Undo (Ctrl+Z)").is_enabled():
        rev = tab.page.evaluate("document.querySelector('.cm-content').innerText")
        tab.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
        tab.until(
            f"document.querySelector('.cm-content').innerText !== {rev!r}"
            " || document.querySelector('[title=\"Undo (Ctrl+Z)\"]').disabled"
        )


class TestDesign:
    def test_a_number_with_its_unit_changes_the_text_and_the_body(self, design):
        size = design.find("parameter-length").get_by_role("textbox", name="length")
        size.fill("5 cm")
        size.press("Enter")
        has_text(design, 'value = "50 mm"')
        design.find("pane-body").get_by_text("50 mm × 10 mm × 10 mm").wait_for()
        assert size.input_value() == "50 mm"
        design.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
        has_text(design, 'value = "40 mm"')
        assert design.errors == []

    def test_a_slider_follows_the_keyboard(self, design):
        slider = design.page.get_by_role("slider", name="length slider")
        slider.focus()
        slider.press("ArrowRight")
        has_text(design, 'value = "45 mm"')

    def test_a_wrong_unit_is_refused_at_the_field(self, design):
        before = document_text(design)
        size = design.find("parameter-length").get_by_role("textbox", name="length")
        size.fill("5 kPa")
        size.press("Enter")
        assert "expected a length" in design.find("parameter-length").inner_text()
        size.press("Escape")
        assert document_text(design) == before

    def test_arithmetic_is_worked_out_and_a_formula_is_kept(self, design):
        row = design.find("parameter-length")
        size = row.get_by_role("textbox", name="length", exact=True)
        size.fill("2*15 mm + 1.5 cm")
        size.press("Enter")
        has_text(design, 'value = "45 mm"')
        design.find("shapes-body").get_by_role("button", name="body", exact=False).first.click()
        height = design.find("shapes-body").get_by_label("Size z", exact=True)
        height.fill("length/5 + 1 mm")
        height.press("Enter")
        has_text(design, '"= length/5 + 1 mm"')
        design.find("pane-body").get_by_text("45 mm × 10 mm × 10 mm").wait_for()
        height.fill("length*length")
        height.press("Enter")
        note = design.find("shapes-body").locator(".field-note")
        assert note.inner_text() == "the formula gives an area; expected a length"
        height.press("Escape")
        note.wait_for(state="detached")
        size.fill("= 2*20 mm")
        size.press("Enter")
        has_text(design, 'value = "= 2*20 mm"')
        row.get_by_text("40 mm").wait_for()
        size.fill("45")
        size.press("Enter")
        row.get_by_role("slider").wait_for()
        assert design.errors == []

    def test_a_changed_value_shows_the_former_one_and_gives_it_back(self, design):
        row = design.find("parameter-length")
        size = row.get_by_role("textbox", name="length", exact=True)
        assert row.get_by_role("button", name="length: back to").count() == 0
        size.fill("55 mm")
        size.press("Enter")
        back = row.get_by_role("button", name="length: back to 40 mm")
        back.wait_for()
        row.locator("label").dblclick()
        has_text(design, 'value = "40 mm"')
        back.wait_for(state="detached")
        size.fill("50 mm")
        size.press("Enter")
        back.click()
        has_text(design, 'value = "40 mm"')

    def test_a_locked_parameter_is_not_changed(self, design):
        row = design.find("parameter-length")
        size = row.get_by_role("textbox", name="length", exact=True)
        row.hover()
        row.get_by_role("button", name="More about length").click()
        design.page.get_by_role("menuitem", name="Lock", exact=True).click()
        design.until(f"document.querySelector({LENGTH!r}).disabled")
        assert row.get_by_role("slider").is_disabled()
        row.get_by_role("button", name="which is locked").click()
        design.page.get_by_role("menuitem", name="Unlock").click()
        design.until(f"!document.querySelector({LENGTH!r}).disabled")
        assert size.is_enabled()

    def test_a_load_can_be_added_changed_and_removed(self, design):
        design.page.get_by_label("Add a load").select_option("force")
        has_text(design, 'kind = "force"')
        entry = design.find("loads-1")
        entry.get_by_role("button", name="force", exact=False).first.click()
        entry.get_by_label("Value z", exact=True).fill("-2 N")
        entry.get_by_label("Value z", exact=True).press("Enter")
        has_text(design, '"-2 N"')
        entry.hover()
        entry.get_by_role("button", name="Remove force").click()
        entry.wait_for(state="detached")
        assert 'kind = "force"' not in document_text(design)
        assert 'kind = "gravity"' in document_text(design)

    def test_a_value_that_was_just_typed_stays_when_its_entry_moves_up(self, design):
        design.page.get_by_label("Add a load").select_option("force")
        entry = design.find("loads-1")
        entry.get_by_role("button", name="force", exact=False).first.click()
        up = entry.get_by_role("button", name="Move force up")
        entry.hover()
        entry.get_by_label("Value z", exact=True).fill("-3 N")
        # The press leaves the field, which sends its value, and comes before the answer to that.
        up.click()
        has_text(design, '"-3 N"')
        text = document_text(design)
        design.until("document.querySelector('[data-testid=loads-0]').innerText.includes('-3 N')")
        assert text.index('"-3 N"') < text.index('kind = "gravity"')

    def test_a_shape_is_renamed_wherever_it_is_named(self, design):
        design.find("shapes-body").get_by_role("button", name="body", exact=False).first.click()
        name = design.find("shapes-body").get_by_label("Name", exact=True)
        name.fill("bar")
        name.press("Enter")
        design.find("shapes-bar").wait_for()
        has_text(design, 'shape = "bar"')
        assert design.find("faults").count() == 0

    def test_an_error_is_underlined_and_the_last_good_body_stays(self, design):
        design.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        drawn = design.page.evaluate("voxsoft.triangles")
        line = design.find("text-editor").locator(".cm-line", has_text="material =")
        line.click()
        design.page.keyboard.press("End")
        design.page.keyboard.press("Backspace")
        design.page.keyboard.type("x")
        design.page.keyboard.press("Escape")
        design.page.keyboard.press("End")
        design.page.keyboard.type('"')
        design.page.keyboard.press("Control+Enter")
        design.page.locator(".cm-lintRange-error").first.wait_for()
        assert "parts[0].material" in design.find("faults").inner_text()
        assert design.page.evaluate("voxsoft.triangles") == drawn
        design.page.keyboard.press("Control+z")
        design.find("faults").wait_for(state="detached")

    def test_completion_knows_the_keys_of_a_place(self, design):
        design.find("text-editor").locator(".cm-line", has_text="gravity").click()
        design.page.keyboard.press("End")
        design.page.keyboard.type("\ndir")
        offered = design.page.locator(".cm-tooltip-autocomplete")
        offered.get_by_text("direction", exact=True).wait_for()

    def test_a_template_and_a_file_can_be_opened(self, own_server, open_tab, tmp_path):
        tab = open_tab(own_server.address, mode="design")
        tab.find("templates").click()
        tab.find("template-sphere").click()
        tab.find("document-name").get_by_text("sphere").wait_for()
        file = tmp_path / "mine.toml"
        file.write_text(own_server.source.read_text().replace('"finger"', '"mine"'))
        tab.page.get_by_label("Open a design, a mesh").set_input_files(file)
        tab.find("document-name").get_by_text("mine").wait_for()
        tab.page.get_by_role("button", name="Undo (Ctrl+Z)").click()
        tab.find("toast").get_by_role("button", name="Back to sphere").click()
        has_text(tab, 'name = "sphere"')


@pytest.fixture(scope="module")
def study_done(served, chromium):
    """Check if the study of this file has been run; the tests after it look at its folder."""
    return {"done": False}


@pytest.fixture
def studied(served, open_tab, study_done):
    tab = open_tab(served.address, mode="optimize")
    tab.find("study-form").wait_for()
    if not study_done["done"]:
        add_objective(tab)
        tab.page.get_by_label("Sampler").select_option("grid")
        tab.find("vary-length").get_by_label("length from").fill("30 mm")
        tab.find("vary-length").get_by_label("length from").press("Enter")
        tab.find("vary-length").get_by_label("length step").fill("10 mm")
        tab.find("vary-length").get_by_label("length step").press("Enter")
        start = tab.find("study-start")
        start.get_by_text("Try 4 designs").wait_for()
        start.dblclick()  # as some do everywhere: it starts one study
        tab.page.locator("[data-testid=job-study][data-state=done]").wait_for(timeout=JOB)
        assert tab.page.get_by_role("combobox", name="Study", exact=True).count() == 0
        study_done["done"] = True
    tab.page.locator("[data-testid=history-chart] circle.chart-point").nth(3).wait_for()
    return tab


def add_objective(tab):
    tab.page.get_by_role("button", name="Add an objective").click()
    goal = tab.find("objectives-goal")
    goal.get_by_role("button", name="goal", exact=False).first.click()
    goal.get_by_label("Metric", exact=True).select_option("displacement")
    goal.get_by_label("Along", exact=True).select_option("z")


class TestStudy:
    def test_a_study_is_set_up_run_and_its_designs_opened(self, studied):
        table = studied.find("trials-table")
        assert table.locator("tbody tr").count() == 4
        assert "mm" in table.locator("tbody tr").first.inner_text()
        studied.page.locator("[data-testid=history-chart] circle[data-trial='1']").click()
        studied.find("document-name").get_by_text(re.compile("-1")).wait_for()
        studied.page.locator("[data-testid=history-chart] .chart-mark").first.wait_for()
        studied.shot("study")
        assert studied.errors == []

    def test_brushed_trials_of_an_axis_are_kept_in_all_plots(self, studied):
        grip = studied.page.locator("[data-testid=parallel-chart] rect[data-axis=length]")
        box = grip.bounding_box()
        x = box["x"] + box["width"] / 2
        studied.page.mouse.move(x, box["y"] + 2)
        studied.page.mouse.down()
        studied.page.mouse.move(x, box["y"] + box["height"] * 0.5, steps=5)
        studied.page.mouse.up()
        studied.find("trial-count").get_by_text("of 4 designs").wait_for()
        faded = studied.page.locator("[data-testid=history-chart] circle.faded").count()
        kept = studied.find("trials-table").locator("tbody tr").count()
        assert 0 < kept < 4
        assert kept + faded == 4
        studied.find("clear-brushes").click()
        studied.find("trial-count").get_by_text("4 designs", exact=True).wait_for()

    def test_the_table_sorts_and_filters(self, studied):
        table = studied.find("trials-table")
        head = table.get_by_role("button", name=re.compile("^length"))
        head.click()
        head.click()
        first = table.locator("tbody tr").first
        assert "60 mm" in first.inner_text()
        studied.page.get_by_label("Filter the designs").fill("length < 45 mm")
        studied.find("trial-count").get_by_text("2 of 4 designs").wait_for()

    def test_the_designs_and_how_they_came_about_are_copied(self, studied):
        studied.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        studied.find("copy-trials").click()
        studied.find("toast").get_by_text("Copied 4 designs").wait_for()
        copied = studied.page.evaluate("navigator.clipboard.readText()").splitlines()
        assert copied[0].startswith("design\tstatus\tlength (m)\tgoal (m)\t")
        assert len(copied) == 5
        studied.find("copy-command").click()
        studied.find("toast").get_by_text("Copied the command").wait_for()
        command = studied.page.evaluate("navigator.clipboard.readText()")
        # The folder holds the step that was chosen, so the command needs to name nothing else.
        assert re.fullmatch(r"voxsoft again \S+finger-study\S*", command)
        studied.find("copy-python").click()
        studied.find("toast").get_by_text("Copied the script").wait_for()
        compile(studied.page.evaluate("navigator.clipboard.readText()"), "again.py", "exec")

    def test_two_designs_are_compared_side_by_side(self, studied):
        studied.page.get_by_label("Compare design 0").check()
        studied.page.get_by_label("Compare design 2").check()
        studied.find("compare-pinned").click()
        compare = studied.find("compare")
        compare.wait_for()
        row = compare.locator("tr", has=studied.page.get_by_role("rowheader", name="length"))
        assert "30 mm" in row.inner_text()
        assert "50 mm" in row.inner_text()

    def test_the_design_space_shows_points(self, studied):
        studied.find("scatter-chart").wait_for()
        studied.until(
            """(() => {
              const canvas = document.querySelector('[data-testid=scatter-chart] canvas');
              const { width, height } = canvas;
              const data = canvas.getContext('2d').getImageData(0, 0, width, height).data;
              const colors = new Set();
              for (let i = 0; i < data.length; i += 4)
                if (data[i + 3] === 255) colors.add(data[i] << 16 | data[i + 1] << 8 | data[i + 2]);
              return colors.size > 5;
            })()"""
        )


@pytest.fixture
def finer(own_server):
    """The cantilever in smaller voxels: a design of it takes long enough to be held."""
    text = own_server.source.read_text().replace('voxel_size = "5 mm"', 'voxel_size = "2 mm"')
    own_server.stop()
    own_server.source.write_text(text)
    own_server.start()
    return own_server


class TestHoldingAStudy:
    @pytest.mark.slow
    def test_a_study_is_paused_goes_on_and_is_stopped_with_its_trials(self, finer, open_tab):
        tab = open_tab(finer.address, mode="optimize")
        tab.find("study-form").wait_for()
        add_objective(tab)
        tab.page.get_by_label("Sampler").select_option("random")
        # Without a step no two designs are the same, so that the study does not end by itself.
        step = tab.find("vary-length").get_by_label("length step")
        step.fill("")
        step.press("Enter")
        tab.page.get_by_role("textbox", name="Budget").fill("5000")
        tab.page.get_by_role("textbox", name="Budget").press("Enter")
        tab.find("study-start").click()
        job = tab.find("job-study")
        tab.page.locator("[data-testid=history-chart] circle.chart-point").first.wait_for()
        job.get_by_role("button", name="Pause").click()
        tab.page.locator("[data-testid=job-study][data-state=paused]").wait_for(timeout=JOB)
        job.get_by_role("button", name="Go on").click()
        tab.page.locator("[data-testid=job-study][data-state=running]").wait_for(timeout=JOB)
        # Another tab, or the same one loaded anew, shows the study with its designs.
        tab.page.reload()
        tab.page.locator("[data-testid=history-chart] circle.chart-point").first.wait_for()
        job.get_by_role("button", name="Stop").click()
        tab.page.locator("[data-testid=job-study][data-state=stopped]").wait_for(timeout=JOB)
        assert tab.find("trials-table").locator("tbody tr").count() > 0
        assert tab.errors == []


class TestRuns:
    def test_a_run_is_renamed_deleted_taken_back_and_opened(self, studied):
        studied.find("mode-runs").click()
        table = studied.find("runs-table")
        row = table.locator("tbody tr").first
        row.wait_for()
        row.click()
        studied.find("reproduce").get_by_text("voxsoft again").wait_for()
        assert "seed 0 · VoxSoft" in studied.find("reproduce").inner_text()
        studied.shot("runs-reproduce")
        assert re.search("goal .* mm", row.inner_text())
        name = row.locator("strong").inner_text()
        row.hover()
        row.get_by_role("button", name=f"Rename {name}").click()
        field = studied.page.get_by_label(f"New name of {name}")
        field.fill("renamed")
        field.press("Enter")
        table.get_by_text("renamed").wait_for()
        row.hover()
        row.get_by_role("button", name="Delete renamed").click()
        studied.find("toast").get_by_role("button", name="Undo").click()
        table.get_by_text("renamed").wait_for()
        row.hover()
        row.get_by_role("button", name="Work on with renamed").click()
        studied.until("location.hash.includes('mode=optimize')")
        # The last event of the job is there under its new name, and its designs with it.
        job = studied.page.locator("[data-testid=job-study][data-state=done]")
        job.get_by_text("4 of 4 designs").wait_for()
        assert job.locator("strong").inner_text() == "renamed"
        assert studied.find("trials-table").locator("tbody tr").count() == 4
        assert studied.errors == []


class TestCalibrate:
    @pytest.mark.slow
    def test_a_material_is_fitted_to_a_table_and_applied(self, own_server, open_tab, tmp_path):
        tab = open_tab(own_server.address, mode="calibrate")
        tab.find("calibrate-form").wait_for()
        assert "Drop a table" in tab.find("calibrate-form").inner_text()
        tab.page.get_by_role("button", name="Open the cantilever beam").click()
        tab.find("document-name").get_by_text("beam").wait_for()
        file = tmp_path / "beam.csv"
        file.write_text(MEASURED)
        tab.find("measurement-file").set_input_files(file)
        # The name says nothing of this column: the user does.
        measured = tab.find("measured")
        measured.get_by_label("Meaning of sag (mm)").select_option("dz")
        measured.get_by_text("3 stations").wait_for()
        for name, value in (("Generations", "2"), ("Population", "4")):
            tab.page.get_by_role("textbox", name=name).fill(value)
            tab.page.get_by_role("textbox", name=name).press("Enter")
        tab.page.get_by_label("refine").uncheck()
        tab.page.get_by_label("ask what the data determine").uncheck()
        tab.find("calibrate-start").click()
        tab.page.locator("[data-testid=job-calibrate][data-state=done]").wait_for(timeout=JOB)
        tab.find("calibrated").get_by_text("Mean error").wait_for()
        assert tab.find("errors-table").locator("tbody tr").count() == 3
        tab.find("toast").get_by_role("button", name="Show the fit").click()
        tab.find("overlay-plane").click()
        points = tab.page.locator("[data-testid=overlay-chart] .overlay-measured")
        points.nth(2).wait_for()
        assert points.count() == 3
        tab.find("card-apply").click()
        tab.find("calibrate-form").get_by_text(re.compile(r"beam-calibration \(")).wait_for()
        tab.find("card-save").click()
        tab.find("toast").get_by_text(re.compile("Saved .*beam-calibration.toml")).wait_for()
        assert tab.errors == []

        own_server.stop()
        own_server.start()
        for again in ("loaded anew", "opened from the list"):
            if again == "loaded anew":  # by the job in its address
                tab.page.reload()
            else:
                tab = open_tab(own_server.address, mode="runs")
                row = tab.find("runs-table").locator("tbody tr")
                row.hover()
                row.get_by_role("button", name="Work on with").click()
                tab.until("location.hash.includes('mode=calibrate')")
            tab.page.locator("[data-testid=job-calibrate][data-state=done]").wait_for()
            tab.find("calibrated").get_by_text("Mean error").wait_for()
            tab.find("errors-table").locator("tbody tr").nth(2).wait_for()
            tab.page.get_by_role("tab", name="Measured and simulated").click()
            tab.page.locator("[data-testid=overlay-space] .view-label").nth(2).wait_for()
        tab.shot("calibration-of-the-past")


class TestExport:
    @pytest.mark.parametrize(
        ("format", "ending"), [("toml", ".toml"), ("inp", ".inp"), ("molds", "-molds.zip")]
    )
    def test_a_file_is_written_and_fetched(self, design, format, ending):
        design.find("export").click()
        with design.page.expect_download() as waiting:
            design.find(f"export-{format}").get_by_role("button").click()
        assert waiting.value.suggested_filename.endswith(ending)
        assert waiting.value.path().stat().st_size > 100

    def test_a_surface_asks_for_its_unit_first(self, design):
        design.find("export").click()
        surface = design.find("export-stl")
        assert surface.get_by_role("button").is_disabled()
        surface.get_by_label("Unit of the surface").select_option("mm")
        with design.page.expect_download() as waiting:
            surface.get_by_role("button").click()
        # A binary STL: a head of 80 bytes, a count, 50 bytes for each triangle.
        content = waiting.value.path().read_bytes()
        assert len(content) == 84 + 50 * int.from_bytes(content[80:84], "little")


TWO_CHAMBERS = """
schema = "voxsoft/1"
name = "two"
voxel_size = "5 mm"

[shapes]
bar = { kind = "box", size = ["25 mm", "15 mm", "15 mm"] }
left = { kind = "box", size = ["5 mm", "5 mm", "5 mm"], corner = ["5 mm", "5 mm", "5 mm"] }
right = { kind = "box", size = ["5 mm", "5 mm", "5 mm"], corner = ["15 mm", "5 mm", "5 mm"] }
body = { kind = "difference", of = ["bar", "left", "right"] }

[[parts]]
shape = "body"
material = "ecoflex-00-30"

[[clamps]]
region = { z = [0, 0] }

[[loads]]
kind = "pressure"
value = "1 kPa"
cavity = "left"

[chambers]
left = { point = ["7.5 mm", "7.5 mm", "7.5 mm"] }
right = { point = ["17.5 mm", "7.5 mm", "7.5 mm"] }
"""


def test_chambers_are_named_chosen_and_renamed(tmp_path, serving, open_tab):
    server = serving(tmp_path, TWO_CHAMBERS, "two.toml")
    try:
        tab = open_tab(server.address, mode="design")
        tab.find("pane-body").get_by_text("right", exact=True).wait_for()
        load = tab.find("loads-0")
        load.get_by_role("button").first.click()
        chosen = load.get_by_label("Cavity", exact=True)
        assert chosen.input_value() == "left"
        assert chosen.locator("option").all_inner_texts() == ["all", "left", "right"]
        chosen.select_option("right")
        has_text(tab, 'cavity = "right"')
        chamber = tab.find("chambers-right")
        chamber.get_by_role("button").first.click()
        name = chamber.get_by_role("textbox", name="Name")
        name.fill("tip")
        name.press("Enter")
        has_text(tab, 'cavity = "tip"')
        tab.find("pane-body").get_by_text("tip", exact=True).wait_for()
        assert tab.errors == []
    finally:
        server.stop()
