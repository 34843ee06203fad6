"""The histories of a design as the page draws them."""

from __future__ import annotations

from pathlib import Path

import pytest

from voxsoft.design import families
from voxsoft.files.toml_edits import with_value
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.protocol import events

TEXT = (
    families.family_text("pneunet")
    + """
[histories]
breath = { sine = { period = "2 s" }, repeat = 3 }
ramp = { time = ["0 s", "200 ms"], factor = [0, 1] }
charge = { expression = "1 - exp(-t / 0.3)", duration = "2 s" }
gait = { table = "gait.csv", column = "left" }

[[loads]]
kind = "gravity"
history = "ramp"

[[loads]]
kind = "gravity"
history = { time = ["0 s", "1 s"], factor = [0, 2] }

[[tendons]]
name = "flexor"
through = [[0, 0, "5 mm"], ["20 mm", 0, "5 mm"]]
tension = "6 N"
history = "ramp"

[[activations]]
kind = "strain"
part = "layer"
value = "2 %"

[[clamps]]
region = { x = [0, 0] }
motion = { displacement = [0, 0, "1 mm"], history = "breath" }
"""
)


@pytest.fixture
def document(tmp_path: Path) -> DesignDocument:
    (tmp_path / "gait.csv").write_text("time_s,left\n0,0\n1,1\n2,0\n")
    return DesignDocument(TEXT, "robot.toml", folder=tmp_path)


def lines(document: DesignDocument) -> dict[str, events.HistoryLine]:
    assert document.design is not None, document.diagnostics
    return {line.title: line for line in document.event().histories}


def test_named_histories_list_their_users(document: DesignDocument) -> None:
    found = lines(document)
    ramp = found["ramp"]
    assert ramp.path == ["histories", "ramp"]
    assert [(use.title, use.amount) for use in ramp.used_by] == [
        ("Gravity", "9.81 m/s^2"),
        ("Tendon flexor", "6 N"),
    ]
    assert [(use.title, use.amount) for use in found["breath"].used_by] == [
        ("Motion of clamp 2", "(0, 0, 1 mm)")
    ]
    assert found["gait"].used_by == []


def test_each_way_has_its_line_and_its_words(document: DesignDocument) -> None:
    found = lines(document)
    ways = {title: (line.way, line.words) for title, line in found.items() if line.times}
    assert ways == {
        "breath": ("sine", "sine of 0 to 1, period 2 s"),
        "ramp": ("points", ""),
        "charge": ("expression", "1 - exp(-t / 0.3), for 2 s"),
        "gait": ("table", "table gait.csv, column left"),
        "Gravity": ("points", ""),
    }
    breath = found["breath"]
    assert (breath.repeat, breath.times[-1], len(breath.times)) == (3, 2.0, 65)
    assert found["gait"].factors == [0.0, 1.0, 0.0]
    assert found["ramp"].times == [0.0, 0.2]


def test_places_without_a_history_come_last(document: DesignDocument) -> None:
    none = [line for line in document.event().histories if line.way == "none"]
    assert document.event().histories[-len(none) :] == none
    assert ["activations", 0, "history"] in [line.path for line in none]
    assert [each.title for each in none if each.path[0] == "activations"] == ["Strain of layer"]


def test_a_tendon_is_never_pushed(document: DesignDocument) -> None:
    ramp = lines(document)["ramp"]
    assert (ramp.low, ramp.high) == (0.0, None)


def test_points_are_written_where_the_path_leads(document: DesignDocument) -> None:
    path = lines(document)["Gravity"].path
    text = with_value(document.text, [*path, "time"], ["0 s", "0.5 s", "1 s"])
    text = with_value(text, [*path, "factor"], [0, 1, 2])
    document.replace(text)
    assert lines(document)["Gravity"].factors == [0.0, 1.0, 2.0]


def test_a_long_curve_is_thinned_with_its_ends(document: DesignDocument) -> None:
    text = with_value(
        document.text, ["histories", "breath"], {"sine": {"period": "1 s", "cycles": 900}}
    )
    document.replace(text)
    breath = lines(document)["breath"]
    assert len(breath.times) == 2000
    assert (breath.times[0], breath.times[-1]) == (0.0, 900.0)


def test_a_text_with_errors_keeps_the_last_good_lines(document: DesignDocument) -> None:
    before = lines(document)
    document.replace(document.text.replace('"200 ms"', '"-1 s"'))
    assert not document.valid
    assert {line.title: line for line in document.event().histories} == before


PAIR = """
schema = "voxsoft/1"
name = "pair"
voxel_size = "5 mm"

[[bodies]]
name = "left"
design = "finger.toml"

[[bodies]]
name = "right"
design = "finger.toml"
position = ["80 mm", 0, 0]
"""


def test_histories_in_the_file_of_bodies_come_once_with_the_file(tmp_path: Path) -> None:
    (tmp_path / "gait.csv").write_text("time_s,left\n0,0\n1,1\n2,0\n")
    (tmp_path / "finger.toml").write_text(TEXT)
    found = lines(DesignDocument(PAIR, "pair.toml", folder=tmp_path))
    assert {line.lives for line in found.values()} == {"finger.toml"}
    ramp = found["ramp"]
    assert ramp.path == ["bodies", 0, "design", "histories", "ramp"]
    # Gravity is that of the outer design.
    users = [use.title for use in ramp.used_by]
    assert users == ["Tendon flexor of left", "Tendon flexor of right"]
    assert "Gravity" not in found
    assert ramp.factors == [0.0, 1.0]
    # A constant entry of a file gets its history there.
    assert all(line.way != "none" for line in found.values())


def test_a_body_that_sets_a_value_of_its_history_has_a_line_of_its_own(tmp_path: Path) -> None:
    file = families.family_text("pneunet").replace(
        "[parameters]", '[parameters]\nlate = { value = "1 s" }', 1
    )
    ramp = '\n[[loads]]\nkind = "force"\nregion = { z = [0, 0] }\nvalue = ["1 mN", 0, 0]\n'
    ramp += 'history = { time = ["0 s", "= late"], factor = [0, 1] }\n'
    (tmp_path / "finger.toml").write_text(file + ramp)
    later = PAIR.replace("position =", 'set = { late = "2 s" }\nposition =')
    document = DesignDocument(later, "pair.toml", folder=tmp_path)
    assert document.design is not None, document.diagnostics
    found = [line for line in document.event().histories if line.lives]
    assert [(line.times[-1], line.used_by[0].title) for line in found] == [
        (1.0, "Force of left"),
        (2.0, "Force of right"),
    ]


def test_histories_of_a_design_in_the_document_are_changed_there(tmp_path: Path) -> None:
    text = """
schema = "voxsoft/1"
name = "one"
voxel_size = "5 mm"

[[bodies]]
name = "only"

[bodies.design]
name = "inner"
voxel_size = "5 mm"
shapes = { block = { kind = "box", size = ["20 mm", "10 mm", "10 mm"] } }
parts = [{ shape = "block", material = "ecoflex-00-30" }]
clamps = [{ region = { z = [0, 0] } }]

[[bodies.design.loads]]
kind = "force"
region = { z = ["10 mm", "10 mm"] }
value = ["1 mN", 0, 0]
history = { time = ["0 s", "1 s"], factor = [0, 1] }
"""
    document = DesignDocument(text, "one.toml", folder=tmp_path)
    assert document.design is not None, document.diagnostics
    [line] = [line for line in document.event().histories if line.way == "points"]
    assert line.lives == ""
    assert line.path == ["bodies", 0, "design", "loads", 0, "history"]
    moved = with_value(text, [*line.path, "factor"], [0, 0.5])
    again = DesignDocument(moved, "one.toml", folder=tmp_path)
    [line] = [line for line in again.event().histories if line.way == "points"]
    assert line.factors == [0.0, 0.5]
