"""Design files: good ones, broken ones, and that writing reads back."""

import math
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxsoft.errors import DesignError, FileError
from voxsoft.files.designs import load, save
from voxsoft.files.toml_text import line_of, write_toml
from voxsoft.units import mm

EXAMPLES = Path(__file__).parents[3] / "examples"
CYLINDER = EXAMPLES / "cylinder.toml"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda p: p.stem)
def test_examples_are_valid_and_read_back(path, tmp_path):
    design = load(path)
    copy = tmp_path / "copy.toml"
    design.save(copy)
    assert load(copy).hash == design.hash
    save(design, copy, resolved=True)
    assert load(copy).hash == design.hash
    assert design.description or "#" in path.read_text(), "an example says what it shows"


def test_parameters_and_assignments_are_set_while_loading():
    design = load(CYLINDER, assignments=["wall=10 mm", "voxel_size=2.5 mm"], radius=20 * mm)
    assert design.parameters["wall"].value == 0.01
    assert design.parameters["radius"].value == 0.02
    assert design.voxel_size == 0.0025


def test_problems_name_file_and_line():
    with pytest.raises(DesignError) as caught:
        load(CYLINDER, assignments=["parts.0.shape=bodi"])
    line = CYLINDER.read_text().splitlines().index('shape = "body"') + 1
    assert caught.value.problems[0].where == f"cylinder.toml, line {line}, parts[0].shape"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b'name = "a', ["line 1, column 10", "ends too early"]),
        (b'name = "a"\nvoxel_size = 5 mm\n', ["line 2", "column 16"]),
        (b'name = "a"\nname = "b"\n', ["line 2", "is not TOML"]),
        (b'name = "a"\n\xff\xfe\n', ["line 2", "is not text in UTF-8"]),
        (b"\x89PNG\r\n\x1a\n\x00\x00", ["is not text"]),
        (b"a = \x00", ["line 1", "is not TOML"]),
        (b"a = " + b"[" * 100_000, ["broken.toml"]),
        (b"a = " + b"9" * 100_000, ["broken.toml"]),
        (b"#" * 10_000_001, ["larger than 10 MB"]),
    ],
    ids=[
        "truncated",
        "unit-without-quotes",
        "twice",
        "bytes",
        "picture",
        "null",
        "deep",
        "digits",
        "large",
    ],
)
def test_broken_files_are_refused_in_plain_words(content, words, tmp_path):
    path = tmp_path / "broken.toml"
    path.write_bytes(content)
    with pytest.raises(FileError) as caught:
        load(path)
    for word in words:
        assert word in str(caught.value)


def test_an_empty_file_lists_missing_entries(tmp_path):
    path = tmp_path / "empty.toml"
    path.write_bytes(b"")
    with pytest.raises(DesignError) as caught:
        load(path)
    assert [p.where.split(", ")[-1] for p in caught.value.problems] == [
        "name",
        "voxel_size",
        "parts",
    ]


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        load(tmp_path / "none.toml")
    with pytest.raises(FileError, match="is a folder"):
        load(tmp_path)
    with pytest.raises(FileError, match="cannot be read"):
        load("a\0b.toml")


def test_a_byte_order_mark_is_no_problem(tmp_path):
    path = tmp_path / "bom.toml"
    path.write_bytes(b"\xef\xbb\xbf" + CYLINDER.read_bytes())
    assert load(path).hash == load(CYLINDER).hash


def test_a_file_that_cannot_be_written_leaves_nothing_behind(tmp_path):
    design = load(CYLINDER)
    with pytest.raises(FileError, match="cannot be written"):
        design.save(tmp_path / "no-such-folder" / "a.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(FileError, match="cannot be written"):
        design.save(tmp_path / "folder.toml")
    assert [path.name for path in tmp_path.iterdir()] == ["folder.toml"]


MESHED = """
name = "scan"
voxel_size = "5 mm"
[shapes]
body = { kind = "mesh", path = "scan.stl", unit = "mm" }
[[parts]]
shape = "body"
material = "ecoflex-00-30"
"""


def test_mesh_files_are_found_beside_the_design_and_count_by_content(tmp_path):
    hashes = []
    for folder, content in (("a", b"solid"), ("b", b"solid"), ("c", b"other")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "scan.stl").write_bytes(content)
        (tmp_path / folder / "design.toml").write_text(MESHED)
        design = load(tmp_path / folder / "design.toml")
        assert Path(design.shapes["body"].path) == tmp_path / folder / "scan.stl"
        hashes.append(design.hash)
    assert hashes[0] == hashes[1] != hashes[2]


VALUES = st.recursive(
    st.one_of(
        st.text(max_size=20),
        st.integers(-(2**63), 2**63 - 1),
        st.floats(allow_nan=False),
        st.booleans(),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=8), inner, max_size=4)
    ),
    max_leaves=12,
)


@given(st.dictionaries(st.text(max_size=8), VALUES, max_size=6))
def test_written_toml_reads_back_equal(document):
    assert tomllib.loads(write_toml(document)) == document


def test_values_that_toml_cannot_hold_are_refused():
    with pytest.raises(DesignError, match="no form in a TOML file"):
        write_toml({"a": None})
    assert math.isnan(tomllib.loads(write_toml({"a": math.nan}))["a"])


def test_lines_of_keys():
    text = '# head\nname = "a"\n\n[shapes]\nouter = { kind = "box" }\n[[parts]]\nshape = "x"\n'
    text += '[[parts]] # second\n"my key" = 1\n[probes.tip]\npoint = [\n 0, 0, 0]\n'
    assert line_of(text, ("name",)) == 2
    assert line_of(text, ("shapes", "outer", "kind")) == 5
    assert line_of(text, ("parts", 0, "shape")) == 7
    assert line_of(text, ("parts", 1)) == 8
    assert line_of(text, ("parts", 1, "my key")) == 9
    assert line_of(text, ("probes", "tip", "point", 2)) == 11
    assert line_of(text, ("loads",)) is None
