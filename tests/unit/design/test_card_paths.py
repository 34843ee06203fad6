"""A material may be the path of a card's file, wherever the design lies."""

import shutil
from pathlib import Path

import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import DesignError, FileError, MaterialError
from voxsoft.files.cards import save_card
from voxsoft.files.run_folder import write_run

MINE = vs.materials.Card(name="mine", material=vs.NeoHookean(young="55 kPa", density="1100 kg/m^3"))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A design in one folder, its card in another, and a working directory that is neither."""
    for name in ("designs", "cards", "elsewhere"):
        (tmp_path / name).mkdir()
    save_card(MINE, tmp_path / "cards" / "mine.toml")
    families.beam(length="40 mm").save(tmp_path / "designs" / "beam.toml")
    monkeypatch.chdir(tmp_path / "elsewhere")
    return tmp_path


CHANGE = 'parts[0].material="../cards/mine.toml"'


def test_a_card_is_loaded_by_its_path(folder):
    assert vs.load_card(folder / "cards" / "mine.toml") == MINE
    assert vs.load_card("../cards/mine.toml") == MINE
    with pytest.raises(FileError, match="there is no such file"):
        vs.load_card("mine.toml")
    with pytest.raises(MaterialError, match=r"\.toml"):
        vs.load_card("../cards/mine")


def test_a_path_is_meant_from_the_folder_of_the_design(folder):
    design = vs.load(folder / "designs" / "beam.toml", assignments=[CHANGE])
    assert design.material_of(design.parts[0]) == MINE.material
    file = folder / "designs" / "by-path.toml"
    text = (folder / "designs" / "beam.toml").read_text()
    file.write_text(text.replace('"ecoflex-00-30"', '"../cards/mine.toml"'))
    assert vs.load(file).hash == design.hash
    inline = design.replace(parts=[design.parts[0].replace(material=MINE.material)])
    assert inline.hash == design.hash


def test_a_saved_design_goes_on_working(folder, monkeypatch):
    design = vs.load(folder / "designs" / "beam.toml", assignments=[CHANGE])
    design.save(folder / "elsewhere" / "copy.toml")
    result = vs.simulate(design)
    run = write_run(result, folder / "runs" / "beam")
    monkeypatch.chdir(folder / "cards")
    assert vs.load(folder / "elsewhere" / "copy.toml") == design
    assert design.with_parameters(length="50 mm").material_of(design.parts[0]) == MINE.material
    shutil.rmtree(folder / "designs")
    (folder / "cards" / "mine.toml").unlink()
    # A run holds the material itself: it can be repeated when the card is gone.
    assert vs.load(run / "design.toml").parts[0].material == MINE.material


def test_in_python_a_path_is_meant_from_the_working_directory(folder, monkeypatch):
    part = vs.Part(shape="body", material=Path("../cards/mine.toml"))
    design = families.beam(length="40 mm").replace(parts=[part])
    table = families.beam(length="40 mm").replace(
        parts=[{"shape": "body", "material": "../cards/mine.toml"}]
    )
    monkeypatch.chdir("/")
    for each in (design, table, table.with_parameters(length="50 mm")):
        assert each.material_of(each.parts[0]) == MINE.material


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, r"parts\[0\]\.material: .*card\.toml: there is no such file"),
        ("name = 3", r"parts\[0\]\.material: .*card\.toml: name: 3 came; expected text"),
        ("name = ", r"parts\[0\]\.material: card\.toml, line 1.*is not TOML"),
    ],
)
def test_a_card_that_is_none_is_reported_with_the_place(folder, text, words):
    file = folder / "designs" / "card.toml"
    if text is not None:
        file.write_text(text)
    with pytest.raises(DesignError, match=words):
        vs.load(folder / "designs" / "beam.toml", assignments=['parts[0].material="card.toml"'])


def test_no_material_of_a_design_can_be_taken_for_a_card():
    with pytest.raises(DesignError, match="would be taken for the path of a card"):
        families.beam().replace(materials={"soft.toml": vs.NeoHookean(young="60 kPa")})
