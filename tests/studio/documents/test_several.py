"""Bodies of a design in the studio: copied, mirrored, arranged, added, taken out, shown."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from voxsoft.design import families
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.design.isometry import Isometry
from voxsoft.files.designs import load
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.documents.several import several_of
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.server.session import Session

EXAMPLES = Path(__file__).parents[3] / "examples"

FINGER = """
# A finger that is no mirror image of itself.
schema = "voxsoft/1"
name = "finger"
voxel_size = "5 mm"

[parameters]
long = { value = "30 mm", min = "20 mm", max = "40 mm" }

[shapes]
bar = { kind = "box", size = ["= long", "10 mm", "10 mm"] }
nail = { kind = "box", size = ["5 mm", "5 mm", "10 mm"], corner = ["= long - 5 mm", "10 mm", 0] }
whole = { kind = "union", of = ["bar", "nail"] }
ball = { kind = "sphere", radius = "8 mm", center = ["= long + 20 mm", "5 mm", "5 mm"] }

[materials]
soft = { model = "neo-hookean", young = "100 kPa", poisson = 0.45 }

[[parts]]
shape = "whole"
material = "soft"

[[clamps]]
region = { x = [0, 0] }

[[loads]]
kind = "gravity"

[[loads]]
kind = "force"
region = { x = ["= long", "= long"] }
value = [0, 0, "1 mN"]

[probes]
tip = { x = ["= long", "= long"] }

[[objects]]
name = "ball"
shape = "ball"

[contact]
friction = 0.5
pairs = [{ of = ["body", "ball"], friction = 0.2 }]

[objectives]
sag = { minimize = "displacement", probe = "tip", axis = "z" }
"""

HAND = """
# Two fingers; this line must stay.
schema = "voxsoft/1"
name = "hand"
voxel_size = "5 mm"

[parameters]
apart = "30 mm" # so must this

[shapes]
cube = { kind = "box", size = ["10 mm", "10 mm", "10 mm"], center = [0, 0, "50 mm"] }

[[bodies]]
name = "left" # and this
design = "finger.toml"
set = { long = "= apart" }
position = ["= apart", 0, 0]

[[bodies]]
name = "right"
design = "finger.toml"
position = ["-30 mm", 0, "1 mm"]
rotation = { axis = [0, 1, 0], angle = "90 deg" }
motion = { displacement = ["3 mm", 0, 0] }

[[clamps]]
region = { body = "left", z = [0, 0] }

[[loads]]
kind = "force"
region = { body = "left" }
value = [0, "1 mN", 0]

[probes]
end = { body = "left", point = ["10 mm", "5 mm", "5 mm"] }

[[objects]]
name = "cube"
shape = "cube"
motion = { displacement = ["1 mm", 0, "= apart"] }

[contact]
pairs = [{ of = ["left", "cube"], friction = 0.7 }, { of = ["left", "left"], friction = 0.1 }]
"""


class Tabs:
    """Events of a session, kept."""

    def __init__(self):
        self.sent = []

    def publish(self, event):
        self.sent.append(event)

    def send_to(self, tab, event):
        self.sent.append(event)

    def of(self, kind):
        return [event for event in self.sent if isinstance(event, kind)]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "finger.toml").write_text(FINGER)
    (tmp_path / "hand.toml").write_text(HAND)
    return tmp_path


@pytest.fixture
def opened(folder):
    """A session on one of the files, without its threads."""

    def open_(name="hand.toml"):
        session = Session(folder / "runs", folder / name)
        session.tabs = Tabs()
        session.engine.forget = lambda: None
        return session

    return open_


def do(session, command):
    before = len(session.tabs.of(events.Error))
    session.handle(object(), command)
    errors = session.tabs.of(events.Error)[before:]
    assert not errors, errors
    assert session.document.valid, session.document.diagnostics
    return session.document.design


def refused(session, command):
    text = session.document.text
    session.handle(object(), command)
    assert session.document.text == text
    [error] = session.tabs.of(events.Error)
    return f"{error.where}: {error.what} ({error.hint})"


def vertices(design, name):
    mesh = mesh_of(design)
    [body] = [body for body in mesh.bodies if body.name == name]
    return mesh.vertices[body.vertices]


def same_points(first, second):
    """Check if two sets of points are the same to the digits of lengths in text, 1e-12 m."""
    key = [np.rint(each / 1e-8).astype(int) + 0 for each in (first, second)]
    return {*map(tuple, key[0])} == {*map(tuple, key[1])}


WAYS = {
    "beside": (commands.Beside(by=(0.05, 0, 0.01)), [Isometry.move((0.05, 0, 0.01))]),
    "mirror": (commands.InMirror(axis="x", at=0.002), [Isometry.mirror("x", 0.002)]),
    "mirror across z": (commands.InMirror(axis="z"), [Isometry.mirror("z")]),
    "around": (
        commands.Around(count=3, center=(0.001, 0.002, 0)),
        [Isometry.turn((0, 0, 1), i * 2 * np.pi / 3, (0.001, 0.002, 0)) for i in (1, 2)],
    ),
    "around y": (
        commands.Around(count=4, axis=(0, 2, 0)),
        [Isometry.turn((0, 1, 0), i * np.pi / 2) for i in (1, 2, 3)],
    ),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", ["left", "right"])
def test_a_body_is_copied_to_where_it_was_asked_for_and_back_by_one_undo(opened, name, way):
    session = opened()
    before = session.document.text
    command, isometries = WAYS[way]
    design = do(session, commands.Copy(seq=1, name=name, way=command))
    copies = [f"{name}-{number}" for number in range(2, 2 + len(isometries))]
    assert [body.name for body in design.bodies] == ["left", "right", *copies]
    own = vertices(design, name)
    for copy, isometry in zip(copies, isometries, strict=True):
        image = own @ isometry.matrix.T + isometry.shift
        assert same_points(vertices(design, copy), image)
        if name == "right":
            [moved] = [body.motion for body in design.bodies if body.name == copy]
            assert moved.displacement == pytest.approx(isometry.vector((3e-3, 0, 0)), abs=1e-12)
    # Comments and the rest of the text stay, and the command line reads the written file.
    lines = iter(session.document.text.splitlines())
    assert all(line in lines for line in before.splitlines() if not line.startswith("pairs"))
    session.document.save()
    assert load(session.document.path) == design
    do(session, commands.Undo(seq=2))
    assert session.document.text == before


def test_copies_of_a_body_follow_the_parameters_that_it_follows(opened):
    session = opened()
    for number, (command, _) in enumerate(WAYS.values()):
        do(session, commands.Copy(seq=number, name="left", way=command))
    design = session.document.design.with_parameters(apart="35 mm")
    own = vertices(design, "left")
    copies = iter(body.name for body in design.bodies[2:])
    for _, isometries in WAYS.values():
        for isometry in isometries:
            image = own @ isometry.matrix.T + isometry.shift
            assert same_points(vertices(design, next(copies)), image)


def test_a_copy_of_a_copy_around_an_axis_keeps_its_formula(opened):
    session = opened()
    three = commands.Around(count=3)
    do(session, commands.Copy(seq=1, name="left", way=three))
    design = do(session, commands.Copy(seq=2, name="left-2", way=commands.Around(count=2)))
    written = session.document.source["bodies"][-1]
    assert written["rotation"] == {
        "axis": [0, 0, 1],
        "angle": "300 deg",
        "center": ["= -apart", 0, 0],
    }
    assert written["position"] == ["= apart", 0, 0]
    turn = Isometry.turn((0, 0, 1), np.pi)
    image = vertices(design, "left-2") @ turn.matrix.T
    assert same_points(vertices(design, "left-2-2"), image)


def test_a_copy_has_the_contacts_of_the_original_where_possible(opened):
    session = opened()
    design = do(session, commands.Copy(seq=1, name="left", way=WAYS["beside"][0]))
    pairs = [(pair.of, pair.friction) for pair in design.contact.pairs]
    assert pairs[2:] == [(("left-2", "cube"), 0.7), (("left-2", "left-2"), 0.1)]
    assert [clamp.region.body for clamp in design.clamps] == ["left", "left-2"]
    assert design.loads[1].value == (0, 0.001, 0)
    assert design.probes["end left-2"].body == "left-2"
    assert not session.tabs.of(events.Log)
    # A force would have to be turned: it stays with the original, and that is said.
    design = do(session, commands.Copy(seq=1, name="left", way=commands.Around(count=2)))
    assert len(design.loads) == 2
    assert len(design.clamps) == 3
    [warning] = session.tabs.of(events.Log)
    assert warning.level == "warning"
    assert warning.text == "loads[0]: of left alone, as a copy needs others"


@pytest.mark.parametrize("way", WAYS)
def test_an_object_is_copied_with_the_way_that_it_goes(opened, way):
    session = opened()
    command, isometries = WAYS[way]
    design = do(session, commands.Copy(seq=1, name="cube", way=command))
    scope = design.assembled.shapes
    cube, *copies = design.objects
    assert len(copies) == len(isometries)
    low, high = (np.array(each) for each in scope["cube"].bounds())
    corners = np.array([[a, b, c] for a in (0, 1) for b in (0, 1) for c in (0, 1)])
    for copy, isometry in zip(copies, isometries, strict=True):
        image = (low + corners * (high - low)) @ isometry.matrix.T + isometry.shift
        found = np.array(copy.shape.bounds(names=scope))
        # Bounds of turned shapes are those of their turned boxes, which may be wider.
        assert (found[0] <= image.min(axis=0) + 1e-9).all()
        assert (found[1] >= image.max(axis=0) - 1e-9).all()
        assert found.mean(axis=0) == pytest.approx(image.mean(axis=0), abs=1e-9)
        way_ = isometry.vector(cube.motion.displacement)
        assert copy.motion.displacement == pytest.approx(way_, abs=1e-12)
    [pair] = [pair for pair in design.contact.pairs if "cube-2" in pair.of]
    assert pair.of == ("left", "cube-2")


def test_bodies_and_objects_are_moved_and_formulas_stay(opened):
    session = opened()
    before = session.document.text
    by = (0.005, 0, -0.002)
    own = vertices(session.document.design, "left")
    design = do(session, commands.Move(seq=1, name="left", by=by))
    assert same_points(vertices(design, "left"), own + np.array(by))
    assert session.document.source["bodies"][0]["position"] == ["= apart + 5 mm", 0, "-2 mm"]
    do(session, commands.Move(seq=2, name="cube", by=by))
    shape = session.document.source["objects"][0]["shape"]
    assert shape == {"kind": "translate", "of": "cube", "by": ["5 mm", 0, "-2 mm"]}
    # Moves of one thing that follow each other, as by keys, are undone together.
    do(session, commands.Move(seq=3, name="cube", by=by))
    shape = session.document.source["objects"][0]["shape"]
    assert shape["by"] == ["10 mm", 0, "-4 mm"]
    do(session, commands.Undo(seq=4))
    do(session, commands.Undo(seq=5))
    assert session.document.text == before


def test_the_center_of_a_turning_motion_is_moved_along(opened):
    session = opened()
    turning = 'rotation = { axis = [0, 0, 1], angle = "9 deg", center = ["1 mm", 0, 0] }, '
    still = "motion = { displacement"
    text = session.document.text.replace(still, f"motion = {{ {turning}displacement", 1)
    session.document.replace(text)
    before = session.document.design.bodies[1]
    design = do(session, commands.Move(seq=1, name="right", by=(0, 0.01, 0)))
    moved = design.bodies[1]
    assert moved.motion.rotation.center == pytest.approx((0.001, 0.01, 0))
    assert moved.motion.displacement == before.motion.displacement


def test_an_object_that_is_copied_again_and_again_is_moved_once(opened):
    session = opened()
    beside = commands.Beside(by=(0.02, 0, 0))
    do(session, commands.Copy(seq=1, name="cube", way=beside))
    do(session, commands.Copy(seq=2, name="cube-2", way=beside))
    shape = session.document.source["objects"][2]["shape"]
    assert shape == {"kind": "translate", "of": "cube", "by": ["40 mm", 0, 0]}


def test_a_removed_object_takes_its_pairs_along(opened):
    session = opened()
    before = session.document.text
    design = do(session, commands.Remove(seq=1, name="cube"))
    assert design.objects == ()
    assert [pair.of for pair in design.contact.pairs] == [("left", "left")]
    do(session, commands.Undo(seq=2))
    assert session.document.text == before


def test_a_new_name_keeps_a_change_that_the_page_had_not_seen(opened):
    """The page names the thing; the text that is changed is the newest one."""
    session = opened()
    path = ["bodies", 0, "rotation"]
    turned = {"axis": [0, 0, 1], "angle": "90 deg"}
    do(session, commands.Edit(seq=1, rev=session.document.rev, path=path, value=turned))
    do(session, commands.Rename(seq=2, section="bodies", name="left", to="thumb"))
    [body, *_] = session.document.source["bodies"]
    assert body["name"] == "thumb"
    assert body["rotation"] == turned
    do(session, commands.Undo(seq=3))
    assert session.document.source["bodies"][0]["name"] == "left"
    assert "nothing called" in refused(
        session, commands.Rename(seq=4, section="bodies", name="thumb", to="index")
    )


def test_bodies_are_added_from_the_folder_from_templates_and_from_uploads(opened, folder):
    session = opened()
    session.handle(object(), commands.Designs(seq=1))
    [listed] = session.tabs.of(events.DesignFiles)
    assert [(each.file, each.title) for each in listed.files] == [("finger.toml", "finger")]
    assert listed.files[0].parameters == {"long": "30 mm"}
    add = commands.AddBody(seq=2, what="file", name="finger.toml", beyond=0.061)
    design = do(session, add)
    # Clear of existing bodies, and on voxels of its own.
    assert design.bodies[2].name == "finger"
    assert vertices(design, "finger")[:, 0].min() == pytest.approx(0.065)
    do(session, commands.AddBody(seq=3, what="template", name="cylinder", beyond=0.2))
    assert (folder / "cylinder.toml").read_text() == families.family_text("cylinder")
    session.store_upload("my pad.toml", FINGER.replace("finger", "pad").encode())
    design = do(session, commands.AddBody(seq=4, what="upload", name="my pad.toml", beyond=0.3))
    assert [body.name for body in design.bodies[2:]] == ["finger", "cylinder", "my-pad"]
    # One file added again is one file; another of that name gets another.
    do(session, commands.AddBody(seq=5, what="template", name="cylinder", beyond=0.4))
    (folder / "cylinder.toml").write_text(FINGER)
    design = do(session, commands.AddBody(seq=6, what="template", name="cylinder", beyond=0.5))
    designs = [body["design"] for body in session.document.source["bodies"]]
    assert designs[3:] == ["cylinder.toml", "my-pad.toml", "cylinder.toml", "cylinder-2.toml"]
    saved = [Path(event.path).name for event in session.tabs.of(events.Saved)]
    assert saved == ["cylinder.toml", "my-pad.toml", "cylinder.toml", "cylinder-2.toml"]


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (commands.Copy(seq=1, name="thumb", way=WAYS["around"][0]), "thumb: is no body or object"),
        (
            commands.Copy(seq=1, name="left", way=commands.Around(count=3, axis=(0, 0, 0))),
            "axis: has no direction",
        ),
        (commands.AddBody(seq=1, what="file", name="../x.toml"), "outside of the folder"),
        (commands.AddBody(seq=1, what="file", name="hand.toml"), "would include itself"),
        (commands.AddBody(seq=1, what="file", name="none.toml"), "there is no file"),
        (commands.AddBody(seq=1, what="upload", name="none.toml"), "was not uploaded"),
    ],
)
def test_impossible_requests_are_refused_and_change_nothing(opened, command, expected):
    assert expected in refused(opened(), command)


def test_a_body_of_parts_of_its_own_is_copied_and_not_mirrored(opened):
    session = opened()
    text = session.document.text
    pad = '[[bodies]]\nname = "pad"\nposition = [0, "60 mm", 0]\n'
    part = '[[parts]]\nshape = "cube"\nmaterial = "dragon-skin-10"\nbody = "pad"\n'
    session.document.replace(text + pad + part)
    beside = commands.Beside(by=(0, 0.06, 0))
    design = do(session, commands.Copy(seq=1, name="pad", way=beside))
    assert [part.body for part in design.parts] == ["pad", "pad-2"]
    assert same_points(vertices(design, "pad-2"), vertices(design, "pad") + np.array([0, 0.06, 0]))
    answer = refused(session, commands.Copy(seq=2, name="pad", way=WAYS["mirror"][0]))
    assert "pad: has parts of its own, and only a design can be mirrored" in answer


def test_copying_the_body_of_a_design_makes_a_new_design_of_several(opened, folder):
    session = opened("finger.toml")
    mirror = commands.InMirror(axis="x", at=-0.01)
    design = do(session, commands.Copy(seq=1, name="body", way=mirror))
    assert [body.name for body in design.bodies] == ["finger", "finger-2"]
    assert session.document.path is None
    assert session.document.name == "finger-several.toml"
    own = vertices(design, "finger")
    assert same_points(vertices(design, "finger-2"), own * [-1, 1, 1] - [0.02, 0, 0])
    # Entries that concern all bodies have moved along; the load of a place has not.
    assert [load.kind for load in design.loads] == ["gravity"]
    pairs = [pair.of for pair in design.contact.pairs]
    assert pairs == [("finger", "ball"), ("finger-2", "ball")]
    assert design.objectives["sag"].probe == "finger.tip"
    assert design.objects[0].name == "ball"
    longer = design.with_parameters(long="35 mm")
    assert np.ptp(vertices(longer, "finger-2")[:, 0]) == pytest.approx(0.035)
    assert (folder / "finger.toml").read_text() == FINGER
    # One undo leads back, and redo there again.
    session.handle(object(), commands.Undo(seq=2))
    assert session.document.text == FINGER
    session.handle(object(), commands.Redo(seq=3))
    assert session.document.design == design


def test_a_design_that_is_not_saved_is_asked_to_be(opened):
    session = opened("finger.toml")
    session.document.replace(FINGER.replace("30 mm", "35 mm"))
    answer = refused(session, commands.Copy(seq=1, name="body", way=WAYS["beside"][0]))
    assert "is not saved, and its bodies name its file (save it first" in answer


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_of_one_body_becomes_one_of_several(path, tmp_path):
    shutil.copytree(EXAMPLES, tmp_path / "examples", ignore=shutil.ignore_patterns("*.json"))
    document = DesignDocument.of_file(tmp_path / "examples" / path.name)
    if document.design.bodies:
        return
    several, name = several_of(document)
    assert several.design.body_names == (name,)
    assert several.valid


def test_the_page_knows_which_part_of_the_picture_is_which_body(folder):
    body = StudioBody.of(load(folder / "hand.toml"), 1, 1)
    sent = body.event()
    assert [part.body for part in sent.parts] == ["left", "right"]
    drawn = body.mesh.vertices[body.surface.vertices]
    for of_several in sent.bodies:
        first, last = of_several.vertices
        own = drawn[first : last + 1]
        bounds = np.array([own.min(axis=0), own.max(axis=0)])
        assert np.array(of_several.bounds) == pytest.approx(bounds)
    assert sent.bodies[0].vertices[1] + 1 == sent.bodies[1].vertices[0]
    assert sent.bodies[1].vertices[1] == len(drawn) - 1
    assert StudioBody.of(load(folder / "finger.toml"), 1, 1).event().bodies == []
