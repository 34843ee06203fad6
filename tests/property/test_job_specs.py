"""A job that is written to its folder is read back as it was, wherever the folder goes."""

import shutil
import tempfile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voxsoft.design import families
from voxsoft.errors import FileError
from voxsoft.jobs import CalibrateSpec, CompareSpec, DesignSource, MeasuredTable, RunSpec, StudySpec
from voxsoft.jobs.copies import with_copies
from voxsoft.jobs.folder import JOB, load, write_job
from voxsoft.jobs.spec import Stage

# Text that a file can hold: no half of a pair, and line ends as they were.
TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)
NAMES = st.text(st.characters(categories=["L", "N"], include_characters="_- ."), min_size=1)
FINITE = st.floats(allow_nan=False, allow_infinity=False)
COUNTS = st.integers(1, 10_000)
OPTIONAL_COUNTS = st.none() | COUNTS
DESIGNS = st.sampled_from([families.beam(), families.cylinder()]).map(DesignSource.of_design)
TABLES = st.builds(
    MeasuredTable, name=NAMES, text=TEXT.map(lambda text: f"#{text}"), select=st.none() | NAMES
)
RANGES = st.tuples(st.floats(1e-9, 1.0), st.floats(1.5, 1e9)).map(
    lambda ends: {"low": ends[0], "high": ends[1]}
)
CHOICES = st.lists(st.booleans() | st.integers(-(2**60), 2**60) | FINITE | TEXT, min_size=1)
TARGETS = st.sampled_from(
    [{"maximize": "displacement", "probe": "top", "axis": "z"}, {"minimize": "mass"}]
)
LIMITS = st.builds(lambda value: {"metric": "cavity_volume", "max": value}, st.floats(1e-9, 1e-3))
STAGES = st.builds(
    Stage, sampler=st.sampled_from(["tpe", "grid"]), budget=COUNTS, batch=OPTIONAL_COUNTS
)

SPECS = st.one_of(
    st.builds(
        RunSpec,
        design=DESIGNS,
        solver=st.dictionaries(NAMES, st.booleans() | st.integers(-9, 9) | FINITE | TEXT),
        figure=st.booleans(),
        frequencies=st.integers(0, 9),
        kept=st.booleans(),
    ),
    st.builds(
        StudySpec,
        design=DESIGNS,
        sampler=NAMES,
        budget=COUNTS,
        batch=OPTIONAL_COUNTS,
        seed=st.integers(-(2**60), 2**60),
        workers=OPTIONAL_COUNTS,
        space=st.none() | st.dictionaries(NAMES, RANGES | CHOICES, max_size=3),
        objectives=st.none() | st.dictionaries(NAMES, TARGETS, min_size=1, max_size=2),
        constraints=st.none() | st.dictionaries(NAMES, LIMITS, max_size=2),
        confirm=st.integers(0, 5),
        earlier=st.lists(STAGES, max_size=3),
    ),
    st.builds(
        CalibrateSpec,
        design=DESIGNS,
        data=st.lists(TABLES, min_size=1, max_size=3),
        bounds=st.none() | st.dictionaries(NAMES, st.tuples(FINITE, FINITE | TEXT), max_size=2),
        generations=COUNTS,
        population=st.integers(4, 99),
        free_scale=st.booleans(),
        refine=st.booleans(),
        identify=st.booleans(),
        card=st.none() | NAMES,
    ),
    st.builds(
        CompareSpec,
        design=DESIGNS,
        data=st.lists(TABLES, max_size=2),
        solvers=st.lists(NAMES, max_size=3),
        outside=st.sampled_from(["auto", "none"]),
        voxel_sizes=st.none() | st.lists(FINITE, max_size=3),
        splits=st.lists(COUNTS, max_size=3),
        time_limit=FINITE,
    ),
)


@settings(max_examples=60)
@given(SPECS)
def test_a_spec_is_read_back_as_it_was_written_and_after_a_move(spec):
    with tempfile.TemporaryDirectory() as home:
        here, there = Path(home, "here"), Path(home, "there")
        write_job(with_copies(spec, here), here)
        shutil.move(here, there)
        read = load(there)
        assert read.spec.replace(design=spec.design) == spec
        assert read.spec.design.text == spec.design.text
        assert read.spec.design.read().hash == spec.design.read().hash
        # Equal numbers of another type, and zeros of another sign, would print otherwise.
        assert repr(read.spec.replace(design=spec.design)) == repr(spec)


def test_the_ends_of_lines_stay(tmp_path):
    table = MeasuredTable(name="tip.csv", text="probe,dz_mm\r\ntip,-1\rtip,-2\n")
    source = DesignSource.of_design(families.beam())
    design = source.replace(text=source.text.replace("\n", "\r\n"))
    write_job(with_copies(CalibrateSpec(design=design, data=[table]), tmp_path), tmp_path)
    read = load(tmp_path).spec
    assert read.data == (table,)
    assert read.design.text == design.text


@settings(max_examples=60)
@given(st.text(max_size=200) | st.binary(max_size=200).map(lambda raw: raw.decode("latin-1")))
def test_a_damaged_job_is_reported_as_one(text):
    with tempfile.TemporaryDirectory() as home:
        head = 'schema = "voxsoft-job/1"\n'
        for content in (text, head + text, f"{head}[job]\n{text}"):
            Path(home, JOB).write_text(content, encoding="utf-8", errors="replace")
            with pytest.raises(FileError, match=r"job\.toml"):
                load(home)


@pytest.mark.parametrize("name", ["../design.toml", "/etc/passwd", "inputs/../../x"])
def test_a_job_reads_nothing_outside_its_folder(tmp_path, name):
    spec = with_copies(RunSpec(design=families.beam()), tmp_path)
    write_job(spec, tmp_path)
    file = tmp_path / JOB
    file.write_text(file.read_text().replace("inputs/design.toml", name))
    for check in (True, False):
        with pytest.raises(FileError, match="not in the folder"):
            load(tmp_path, check=check)
