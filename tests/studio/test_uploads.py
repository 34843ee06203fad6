"""Names and archives that come from the page."""

import zipfile

import pytest

from voxsoft.errors import FileError
from voxsoft.studio.uploads import safe_name, unpack_folder


@pytest.mark.parametrize(
    ("given", "stored"),
    [
        ("arm.toml", "arm.toml"),
        ("../../arm.toml", "arm.toml"),
        ("C:\\Users\\me\\arm v2.STL", "arm-v2.stl"),
        (".hidden.csv", "hidden.csv"),
        ("\u202egpj.obj", "gpj.obj"),
        ("a" * 300 + ".npy", "a" * 120 + ".npy"),
        ("con.csv", "_con.csv"),
    ],
)
def test_a_name_stays_in_its_folder(given, stored):
    assert safe_name(given) == stored


@pytest.mark.parametrize("inside", ["../outside.txt", "/tmp/outside.txt", "a/../../outside.txt"])
def test_an_archive_that_leads_outside_is_refused_whole(tmp_path, inside):
    archive = tmp_path / "run.zip"
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("design.toml", "a = 1")
        packed.writestr(inside, "no")
    (tmp_path / "runs").mkdir()
    with pytest.raises(FileError, match="outside itself"):
        unpack_folder(archive, tmp_path / "runs")
    assert list((tmp_path / "runs").iterdir()) == []
    assert not (tmp_path / "outside.txt").exists()


def test_an_archive_that_is_none_is_reported(tmp_path):
    archive = tmp_path / "run.zip"
    archive.write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(FileError, match="is no archive"):
        unpack_folder(archive, tmp_path)


def test_a_bomb_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("voxsoft.studio.uploads.LARGEST_ARCHIVE", 1_000_000)
    archive = tmp_path / "run.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("zeros", bytes(2_000_000))
    with pytest.raises(FileError, match="too large when unpacked"):
        unpack_folder(archive, tmp_path)
