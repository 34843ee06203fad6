"""Rigid objects in the studio: shown at rest, found by Solve and live."""

import base64
import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from own_loop import run

import voxsoft as vs
from voxsoft.design import Contact, Object, families
from voxsoft.errors import SimulationError
from voxsoft.files.designs import load
from voxsoft.simulation import simulate
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.simulation.results.posed import posed_surface
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.fields import CONTACT_FIELDS, FIELDS, contact_values
from voxsoft.studio.bodies.objects import moments_of, poses_in, surroundings_of
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.motion.rest import RestSearch
from voxsoft.studio.outputs.exports import export_shown
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.codec import decode
from voxsoft.units import mm

PINCH = Path(__file__).parents[3] / "examples" / "pinch.toml"

PRESSED = """
schema = "voxsoft/1"
name = "pressed"
voxel_size = "4 mm"

[shapes]
block = { kind = "box", size = ["12 mm", "12 mm", "12 mm"] }
plate = { kind = "box", size = ["20 mm", "20 mm", "4 mm"], corner = ["-4 mm", "-4 mm", "12.5 mm"] }

[materials]
rubber = { model = "neo-hookean", young = "100 kPa", poisson = 0.45 }

[[parts]]
shape = "block"
material = "rubber"

[[clamps]]
region = { z = [0, 0] }

[[objects]]
name = "plate"
shape = "plate"
motion = { displacement = [0, 0, "-1.5 mm"] }

[contact]
friction = 0.4
"""


@pytest.fixture
def pressed(tmp_path):
    file = tmp_path / "pressed.toml"
    file.write_text(PRESSED)
    return file


def playing(design):
    playback = Playback()
    playback.begin(StudioBody.of(design, 1, 1))
    return playback


def numbers(text, kind):
    return np.frombuffer(base64.b64decode(text), kind).reshape(-1, 3)


def test_bonds_come_with_points_of_the_body_that_they_hold(pressed):
    bonded = """pairs = [{ of = ["plate", "body"], kind = "bonded", strength = "20 kPa" }]"""
    pressed.write_text(f"{PRESSED.replace('12.5 mm', '13 mm')}{bonded}\n")
    [bond] = StudioBody.of(load(pressed), 1, 1).event().bonds
    assert (bond.of, bond.strength) == (("body", "plate"), 20e3)
    points = np.array(bond.points)
    # The plate is 1 mm above the block, within half a voxel; its sides are not.
    assert np.allclose(points[:, 2], 0.012)
    assert len(points) > 10
    assert points[:, :2].min() < 0.002
    assert points[:, :2].max() > 0.010


def test_unbonded_or_distant_surfaces_have_no_points(pressed):
    assert StudioBody.of(load(pressed), 1, 1).event().bonds == []
    bonded = """pairs = [{ of = ["body", "plate"], kind = "bonded" }]"""
    pressed.write_text(f"{PRESSED.replace('12.5 mm', '18 mm')}{bonded}\n")
    body = StudioBody.of(load(pressed), 1, 1)
    assert body.refusal is not None
    assert body.event().bonds == []


def test_an_object_comes_as_it_is_drawn_in_figures(pressed):
    design = load(pressed)
    [sent] = StudioBody.of(design, 1, 1).event().objects
    surface = posed_surface(design, "plate", None)
    assert (sent.name, sent.motion) == ("plate", "moved")
    # Single precision: 1e-7 of some centimeters.
    assert numbers(sent.vertices, "<f4") == pytest.approx(surface.vertices, abs=1e-8)
    assert (numbers(sent.triangles, "<u4") == surface.triangles).all()
    assert sent.middle == pytest.approx((6 * mm, 6 * mm, 14.5 * mm), abs=1e-9)


def test_an_object_within_the_body_is_drawn_and_keeps_it_from_being_solved():
    bead = Object(name="bead", shape=vs.Sphere(radius="2 mm", center=("6 mm", "6 mm", "6 mm")))
    block = vs.Part(shape=vs.Box(size=("12 mm", "12 mm", "12 mm")), material="ecoflex-00-30")
    held = vs.Clamp(region=vs.Region(z=(0, 0)))
    design = vs.Design(name="b", voxel_size=4 * mm, parts=[block], clamps=[held], objects=[bead])
    body = StudioBody.of(design, 1, 1)
    assert [each.name for each in body.event().objects] == ["bead"]
    assert "deep in the body" in str(body.refusal)


def of_lattice(design):
    """Replace the material by the lattice, whose contact is not found live."""
    material = vs.Lattice(edge="25 kPa", bulk="100 kPa")
    parts = [part.model_copy(update={"material": material}) for part in design.parts]
    return design.replace(parts=parts)


def test_time_does_not_run_where_contact_is_not_found_live(pressed):
    playback = playing(of_lattice(load(pressed)))
    grab = commands.Grab(seq=1, id=1, vertex=0, target=(0.0, 0.0, 0.0))
    for command in (commands.Play(seq=1), commands.Step(seq=1), grab):
        with pytest.raises(SimulationError, match="press Solve"):
            playback.do(command)
    assert not playback.moving
    assert playback.body.event().not_live


def test_pulled_or_played_bodies_stop_when_an_object_comes(pressed):
    design = of_lattice(load(pressed))
    playback = playing(design.replace(objects=(), contact=None))
    playback.do(commands.Grab(seq=1, id=1, vertex=0, target=(0.0, 0.0, 0.1)))
    playback.do(commands.Play(seq=1))
    assert not playback.begin(StudioBody.of(design, 2, 2))
    assert playback.stat().grabs == []


def test_a_plate_presses_live_as_hard_as_statics_says(pressed):
    # Live the plate comes in one step: friction, which depends on the way, would be another.
    design = load(pressed).replace(contact=Contact())
    playback = playing(design)
    assert playback.body.event().not_live == ""
    playback.do(commands.Play(seq=1))
    moments = []
    for _ in range(200):
        reported = playback.advance(1 / 60, 10.0)
        moments += [event.moment for event in reported if isinstance(event, events.MomentNews)]
        if not playback.moving:
            break
    assert playback.state == "at-rest"
    [touch] = moments[-1].contacts
    assert touch.of == ("body", "plate")
    solved = simulate(design).contacts[0]
    # Rest is where the residual is 1e-4 of the forces; both clearances are 1e-4 voxels of 1 mm.
    assert touch.force[2] == pytest.approx(solved.force[2], rel=5e-3)
    assert moments[-1].depth is None
    assert moments[-1].poses[0].position[2] == pytest.approx(13.0 * mm, abs=1e-6)
    assert [moment.frame for moment in moments] == list(range(1, playback.frame + 1))
    assert playback.player.positions().shape == playback.body.mesh.vertices.shape


def test_a_free_object_is_pulled_and_one_that_is_held_is_not(pressed):
    plate = load(pressed).objects[0].model_copy(update={"motion": "free", "mass": 0.02})
    design = load(pressed).replace(objects=(plate,), solver=vs.Solver(method="dynamics"))
    playback = playing(design)
    hold = commands.Grab(seq=1, id=3, vertex=0, object=0, target=(6 * mm, 6 * mm, 30 * mm))
    playback.do(hold)
    playback.do(commands.Play(seq=1))
    for _ in range(60):
        playback.advance(1 / 60, 10.0)
    [grab] = playback.stat().grabs
    assert (grab.id, grab.object) == (3, 0)
    assert playback.player.moment().moment.poses[0].position[2] > 25 * mm
    playback.do(commands.Release(seq=1, id=3))
    assert playback.stat().grabs == []
    held = playing(load(pressed))
    with pytest.raises(SimulationError, match="does not move freely"):
        held.do(hold)
    with pytest.raises(SimulationError, match="no object 7"):
        held.do(commands.Grab(seq=1, id=1, vertex=0, object=7, target=(0.0, 0.0, 0.0)))


def test_solve_finds_contact_and_reports_where_the_plate_went(make_studio, pressed):
    studio = make_studio(pressed)

    async def scenario():
        async with studio.page() as page:
            await page.shown(lambda stat: stat.state == "paused")
            await page.send("rest")
            moments = await page.until("moments", lambda event: event.moments, seconds=60.0)
            async with studio.page() as other:
                again = await other.until("moments")
            await page.send("reset")
            cleared = await page.until("moments")
        [moment] = moments.moments
        [touch] = moment["contacts"]
        assert touch["of"] == ["body", "plate"]
        # A block of 100 kPa that is pressed by a twelfth: 1.2 N where its ends spread freely; with
        # the foot held and rubber of 0.45 no more than 2 N.
        assert 1.2 < -touch["force"][2] < 2.0
        assert moment["poses"][0]["position"][2] == pytest.approx(13.0 * mm, abs=1e-6)
        assert again.moments == moments.moments
        assert cleared.moments == []

    run(scenario())


class Heard:
    """Who listens to a search."""

    def __init__(self):
        self.sentences, self.result, self.failure = [], None, None

    def searching(self, search, sentence, progress):
        self.sentences.append((sentence, progress))

    def found(self, search, result):
        self.result = result

    def not_found(self, search, sentence):
        self.failure = sentence


@pytest.mark.slow
def test_a_free_object_is_solved_over_time_as_a_film_of_poses():
    design = load(PINCH)
    design = design.replace(solver=design.solver.replace(end_time=0.1))
    playback, heard = playing(design), Heard()
    search = RestSearch(playback.body, playback.factors, "auto", heard)
    search.run()
    assert heard.failure is None
    result = heard.result
    assert result.solver["way"] == "dynamics"
    assert any(sentence.endswith("of 0.1 s") for sentence, _ in heard.sentences)
    playback.go_to_rest(result)
    frames = [moment.frame for moment in playback.moments]
    assert frames == list(range(1, playback.frame + 1))
    assert len(frames) == len(result.recording.times)
    # Gravity comes on after the pads have closed: the plate goes down.
    heights = [moment.poses[0].position[2] for moment in playback.moments]
    assert heights[-1] < heights[0]
    assert playback.stat().time == pytest.approx(0.1)
    playback.do(commands.Seek(seq=1, frame=2))
    recorded = result.recording.frames[1]
    # The core keeps frames in single precision.
    assert playback.player.positions() == pytest.approx(recorded, abs=1e-8)
    assert playback.stat().time == pytest.approx(result.recording.times[1])


def test_moments_of_a_design_without_contact_are_none():
    assert moments_of(simulate(families.beam()), 1) == []


def values_of(message):
    """The field's number and its values at the drawn vertices, as the page reads them."""
    (number,) = struct.unpack_from("<H", message, 6)
    low, high = struct.unpack_from("<2f", message, 56)
    packed = np.frombuffer(message, "<u2", offset=64).reshape(-1, 4)[:, 3]
    return number, low + (high - low) * packed / 65535.0


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    file = tmp_path_factory.mktemp("solved") / "pressed.toml"
    file.write_text(PRESSED)
    playback = playing(load(file))
    playback.go_to_rest(simulate(playback.body.setup))
    return playback


@pytest.mark.parametrize("mode", ["surface", "solid", "tets"])
@pytest.mark.parametrize("field", CONTACT_FIELDS, ids=lambda field: field.name)
def test_fields_of_contact_are_packed_as_the_result_has_them(solved, field, mode):
    found = solved.contact_fields[solved.frame]
    message = solved.canvas.frame(solved.player, field.id, mode, 0, found)
    number, values = values_of(message)
    assert number == field.id
    expected = {
        "contact_pressure": found.pressure,
        "contact_friction": np.linalg.norm(found.friction, axis=1),
        "contact_gap": np.where(np.isfinite(found.gap), found.gap, 0.0),
    }[field.name]
    # Half a step of sixteen bits over the range.
    step = np.ptp(expected) / 65535
    assert values.max() == pytest.approx(expected.max(), abs=step + 1e-6 * expected.max())
    if mode != "tets" and field.name != "contact_gap":
        drawn = solved.body.surface.vertices
        shown = values[: len(drawn)]
        assert shown == pytest.approx(expected[drawn], abs=step + 1e-6 * expected.max())
    assert (len(values) > len(solved.body.surface.vertices)) == (mode != "surface")


def test_a_distant_surface_has_the_largest_gap():
    nothing = np.zeros(3)
    found = ContactField(nothing, np.zeros((3, 3)), np.array([0.1, np.inf, 0.3]), nothing)
    gap = next(field.id for field in CONTACT_FIELDS if field.name == "contact_gap")
    assert contact_values(gap, found).tolist() == [0.1, 0.3, 0.3]


def test_fields_of_contact_are_zero_where_none_is_known(solved):
    for field in CONTACT_FIELDS:
        number, values = values_of(solved.canvas.frame(solved.player, field.id, "surface"))
        assert (number, values.max()) == (field.id, 0.0)


def test_every_field_can_be_asked_for():
    numbers = [field.id for field in (*FIELDS, *CONTACT_FIELDS)]
    assert numbers == list(range(len(numbers)))
    for number in numbers:
        sent = json.dumps({"t": "view", "seq": 1, "field": number})
        assert decode(sent).field == number


def test_only_the_end_of_a_solution_knows_its_fields(solved):
    assert [moment.fields for moment in solved.moments] == [True]
    solved.reset()
    assert (solved.moments, solved.contact_fields) == ([], {})


def gray_in(png):
    """Number of pixels of a picture in the gray of objects."""
    picture = (255 * imread(png)[..., :3]).astype(int)
    gray = (np.ptp(picture, axis=2) <= 2) & (picture[..., 0] > 120) & (picture[..., 0] < 240)
    return int(gray.sum())


@pytest.mark.slow
@pytest.mark.parametrize("as_solved", [False, True])
def test_an_exported_picture_of_a_moment_has_its_objects(tmp_path, pressed, as_solved):
    playback, design = Playback(), load(pressed)
    playback.begin(StudioBody.of(design, 1, 1))
    result = simulate(design)
    if as_solved:
        playback.go_to_rest(result)
        playback.result = None  # as it stands, which no solver is asked about
    shown = playback.shown_as("pressed", "")
    drawn = gray_in(export_shown(shown, "png", {}, tmp_path).file)
    bare = replace(shown, moment=None, time=1.0)  # where objects were then is not known
    assert drawn > gray_in(export_shown(bare, "png", {}, tmp_path).file) + 3_000
    if as_solved:
        assert poses_in(shown.moment, design) == result.objects


def test_an_object_without_a_surface_leaves_the_body_in_its_pictures():
    speck = Object(name="speck", shape=vs.Sphere(radius="0.01 mm"), voxel_size="4 mm")
    floor = vs.design.Floor(z=-1 * mm)
    found = surroundings_of(families.beam().replace(floor=floor, objects=[speck]), {})
    assert (found.objects, found.floor) == (None, floor.z)
