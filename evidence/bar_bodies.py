"""Two sets of 72 bodies by which error bars are judged, fixed before one of them was solved.

Twelve kinds of six bodies, drawn by set, kind and number: half of them round with thin walls,
away from the grid or turned, a quarter in contact. Lengths are in voxels of 2 mm; a body away from
the grid has voxels larger by up to a tenth, as the grid follows the ends of a body.
`evidence/bars_judged.py` solves them. Twelve recipes make the file long.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

import voxsoft as vs

#: Bodies of each kind.
EACH: Final = 6
#: First numbers of the generators. The second set came after the rules that the first one judged,
#: and after cut voxels had become the default of rubber.
SETS: Final = {"first": 1972, "second": 2026}
#: Unit of length in mm.
UNIT: Final = 2.0

Draw = np.random.Generator
Table = dict[str, Any]
Point = tuple[float, float, float]


class Case(NamedTuple):
    """A design whose objective is the number that is looked at."""

    design: vs.Design
    #: Same body as the part of it that symmetry leaves, for the truth of one that has none.
    quick: vs.Design | None = None


# --- Parts of designs -----------------------------------------------------------------------------


def mm(length: float) -> str:
    """A length in units as text."""
    return f"{length * UNIT!r} mm"


def point(at: Point) -> list[str]:
    """A point in units."""
    return [mm(float(each)) for each in at]


def rubber(draw: Draw) -> tuple[Table, float]:
    """Rubber and its Young's modulus in kPa."""
    young = float(draw.uniform(50, 200))
    poisson = float(draw.choice([0.45, 0.49, 0.499]))
    if draw.random() < 0.7:
        return {"model": "neo-hookean", "young": f"{young!r} kPa", "poisson": poisson}, young
    mu = [f"{young / 3.2!r} kPa", f"{young / 40!r} kPa"]
    return {"model": "ogden", "mu": mu, "alpha": [2.4, -2.0], "poisson": poisson}, young


def box(low: Point, high: Point) -> Table:
    """A box between two corners."""
    size = tuple(b - a for a, b in zip(low, high, strict=True))
    return {"kind": "box", "size": point(size), "corner": point(low)}


def upright(radius: float, height: float, at: Point = (0, 0, 0)) -> Table:
    """A cylinder along z."""
    return {"kind": "cylinder", "radius": mm(radius), "height": mm(height), "base": point(at)}


def level(radius: float, length: float, at: Point) -> Table:
    """A cylinder along y from its middle."""
    base = point((at[0], at[1] - length / 2, at[2]))
    return {
        "kind": "cylinder",
        "radius": mm(radius),
        "height": mm(length),
        "base": base,
        "axis": "y",
    }


def ball(radius: float, center: Point = (0, 0, 0)) -> Table:
    """A sphere."""
    return {"kind": "sphere", "radius": mm(radius), "center": point(center)}


def design(
    solid: Table,
    rooms: list[Table],
    material: Table,
    *,
    goal: Table,
    size: float = 1.0,
    turn: float = 0.0,
    planes: str = "",
    shapes: Table | None = None,
    foot: float = 0.0,
    **entries: Any,
) -> vs.Design:
    """A body less its rooms, turned about z by degrees and clamped at and below `foot`."""
    named = {"solid": solid, **{f"room{index}": room for index, room in enumerate(rooms)}}
    of = list(named)
    named["whole"] = {"kind": "difference", "of": of} if rooms else solid
    named["body"] = {"kind": "rotate", "of": "whole", "axis": "z", "angle": f"{turn!r} deg"}
    held = {"region": {"z": ["-inf", mm(foot)]}}
    return vs.Design.model_validate(
        {
            "schema": "voxsoft/1",
            "name": "body",
            "voxel_size": mm(size),
            "shapes": named | (shapes or {}),
            "parts": [{"shape": "body" if turn else "whole", "material": material}],
            "clamps": [held],
            "objectives": {"number": goal},
            "symmetry": [{"plane": plane} for plane in planes],
            **entries,
        }
    )


GROWTH: Final[Table] = {"maximize": "cavity_volume_change"}


def tip(axis: str) -> Table:
    """Motion of the tip along an axis."""
    return {"maximize": "displacement", "probe": "tip", "axis": axis}


def force(name: str, axis: str) -> Table:
    """Force of an object on the body."""
    return {"maximize": "contact_force", "object": name, "axis": axis}


def pressure(value: float, **more: Any) -> list[Table]:
    """A pressure in kPa."""
    return [{"kind": "pressure", "value": f"{value!r} kPa", **more}]


def sunk(displacement: Point) -> Table:
    """A motion along a line."""
    return {"displacement": point(displacement)}


# --- Round, thin, away from the grid or turned ----------------------------------------------------


def tube(draw: Draw, number: int) -> Case:
    """A capped tube under pressure; odd ones are eccentric, the last is whole on fine voxels."""
    material, young = rubber(draw)
    inner, wall = float(draw.uniform(3.0, 4.2)), float(draw.uniform(1.0, 2.2))
    height, size = float(draw.uniform(7, 10)), float(draw.uniform(1.0, 1.1))
    aside = 0.35 * wall * float(draw.uniform(0, 1)) if number % 2 else 0.0
    load = pressure(float(draw.uniform(0.05, 0.2)) * young * wall / inner)
    solid = upright(inner + wall, height)
    rooms = [upright(inner, height - 2 * wall, (aside, 0, wall))]

    def made(size: float, planes: str) -> vs.Design:
        return design(
            solid,
            rooms,
            material,
            goal=GROWTH,
            size=size,
            planes=planes,
            loads=load,
            fill="fraction",
        )

    planes = "y" if aside else "xy"
    if number == EACH - 1:
        return Case(made(0.5 * size, ""), made(0.5 * size, planes))
    return Case(made(size, planes))


def shell(draw: Draw, number: int) -> Case:
    """A ball or an egg under pressure; the last is whole on fine voxels."""
    material, young = rubber(draw)
    inner, wall = float(draw.uniform(3.2, 4.8)), float(draw.uniform(1.0, 2.2))
    size = float(draw.uniform(1.0, 1.1))
    load = pressure(float(draw.uniform(0.05, 0.15)) * 2 * young * wall / inner)
    outer, room, foot = ball(inner + wall), ball(inner), -0.75 * (inner + wall)
    if number % 2:
        long = float(draw.uniform(1.2, 1.6))
        outer, room = (
            {"kind": "ellipsoid", "radii": point((r, r, long * inner + r - inner))}
            for r in (inner + wall, inner)
        )
        foot = -0.75 * (long * inner + wall)

    def made(size: float, planes: str) -> vs.Design:
        return design(
            outer,
            [room],
            material,
            goal=GROWTH,
            size=size,
            planes=planes,
            foot=foot,
            loads=load,
            fill="fraction",
        )

    if number == EACH - 1:
        return Case(made(0.5 * size, ""), made(0.5 * size, "xy"))
    return Case(made(size, "xy"))


def turned_bender(draw: Draw, number: int) -> Case:
    """A box with a room aside in it, turned on the grid, under pressure."""
    material, young = rubber(draw)
    wide, height = float(draw.uniform(5, 6.5)), float(draw.uniform(8, 11))
    thin, thick = float(draw.uniform(1.0, 1.6)), float(draw.uniform(1.6, 2.2))
    room = box(
        (-wide / 2 + thick, -wide / 2 + thin, thick),
        (wide / 2 - thin, wide / 2 - thin, height - thick),
    )
    load = pressure(float(draw.uniform(0.1, 0.3)) * young * (thin / (wide - 2 * thin)) ** 2)
    turn = float(draw.uniform(5, 45))
    goal = {"maximize": "displacement", "probe": "tip"} if number % 2 else GROWTH
    return Case(
        design(
            box((-wide / 2, -wide / 2, 0), (wide / 2, wide / 2, height)),
            [room],
            material,
            goal=goal,
            turn=turn,
            loads=load,
            fill="fraction",
            probes={"tip": {"point": point((0, 0, height))}},
        )
    )


def segment(draw: Draw, number: int) -> Case:
    """A round segment of three chambers, one of them under pressure."""
    material, young = rubber(draw)
    radius, height = float(draw.uniform(4.6, 5.4)), float(draw.uniform(7, 9))
    size = float(draw.uniform(1.0, 1.1))
    bore, out = 0.26 * radius, 0.53 * radius
    rooms = [
        upright(bore, height - 3, (out * np.cos(angle), out * np.sin(angle), 1.5))
        for angle in np.radians((0, 120, 240))
    ]
    load = pressure(float(draw.uniform(0.08, 0.2)) * young, cavity="driven")
    return Case(
        design(
            upright(radius, height),
            rooms,
            material,
            goal=tip("x") if number % 2 else {**GROWTH, "cavity": "driven"},
            size=size,
            planes="y",
            loads=load,
            fill="fraction",
            chambers={"driven": {"point": point((out, 0, height / 2))}},
            probes={"tip": {"point": point((0, 0, height))}},
        )
    )


def post(draw: Draw, number: int) -> Case:
    """A round or a turned square post, solid or a tube of thin wall, under its weight sideways."""
    material, young = rubber(draw)
    side, height = float(draw.uniform(1.5, 2.6)), float(draw.uniform(9, 14))
    size = float(draw.uniform(1.0, 1.1))
    rooms, wall = [], 2 * side
    if number % 2 == 0:
        solid, turn = upright(side, height), 0.0
        if number == 2 or number == 4:
            side = float(draw.uniform(2.6, 3.4))
            solid, wall = upright(side, height), float(draw.uniform(1.0, 1.8))
            rooms = [upright(side - wall, 3 * height, (0, 0, -height))]
    else:
        solid = box((-side, -side, 0), (side, side, height))
        turn = float(draw.uniform(8, 45))
    # A tip of an eighth of the height or so: ρ g L⁴/(8 E I/A) with I/A = side²/4 (or a third).
    bent = float(draw.uniform(0.08, 0.2)) * height * UNIT * 1e-3
    long, deep = height * UNIT * 1e-3, side * UNIT * 1e-3
    pull = bent * 8 * young * 1e3 * deep**2 / 4 / (1070 * long**4)
    return Case(
        design(
            solid,
            rooms,
            material | {"density": "1070 kg/m^3"},
            goal=tip("x"),
            size=size,
            turn=turn,
            planes="" if turn else "y",
            loads=[{"kind": "gravity", "value": f"{pull!r} m/s^2", "direction": [1, 0, 0]}],
            fill="fraction",
            probes={"tip": {"point": point((side - wall / 2, 0, height))}},
        )
    )


def round_finger(draw: Draw, number: int) -> Case:
    """A round finger, solid or with a bore, bent by a tendon in its wall."""
    material, young = rubber(draw)
    radius, height = float(draw.uniform(2.6, 3.4)), float(draw.uniform(8, 12))
    size = float(draw.uniform(1.0, 1.1))
    wall = float(draw.uniform(1.2, 1.8))
    bore = upright(radius - wall, 3 * height, (0, 0, -height))
    rooms = [bore] if number % 2 else []
    aside = radius - 0.5 * wall
    # The moment of a bend of 0.4 to 1 over the height: E I/L.
    stiff = np.pi / 4 * (radius**4 - (len(rooms) * (radius - wall)) ** 4) * (UNIT * 1e-3) ** 4
    bend = float(draw.uniform(0.4, 1.0))
    pull = bend * young * 1e3 * stiff / (height * aside * (UNIT * 1e-3) ** 2)
    ends = [point((aside, 0, z)) for z in (0, height - 0.5)]
    return Case(
        design(
            upright(radius, height),
            rooms,
            material,
            goal=tip("x"),
            size=size,
            fill="fraction",
            tendons=[{"name": "pull", "through": ends, "tension": f"{float(pull)!r} N"}],
            probes={"tip": {"point": point((aside, 0, height))}},
        )
    )


# --- In contact -----------------------------------------------------------------------------------


def pressed_down(draw: Draw, number: int) -> Case:
    """A ball, or an upright cylinder with rounded foot, pressed on the floor."""
    material, _ = rubber(draw)
    radius = float(draw.uniform(2.5, 3.8))
    size = float(draw.uniform(1.0, 1.1))
    solid, top = ball(radius, (0, 0, radius)), 1.7 * radius
    if number % 2:
        high = float(draw.uniform(0.5, 1.0)) * radius
        ends = {"start": point((0, 0, radius)), "end": point((0, 0, radius + high))}
        solid, top = {"kind": "capsule", "radius": mm(radius), **ends}, 1.7 * radius + high
    deep = float(draw.uniform(0.1, 0.25)) * radius
    clamp = {"region": {"z": [mm(top), "inf"]}, "motion": sunk((0, 0, -deep))}
    return Case(
        design(
            solid,
            [],
            material,
            goal=force("floor", "z"),
            size=size,
            planes="xy",
            fill="fraction",
            clamps=[clamp],
            floor={"z": "0 mm"},
            contact={"friction": float(draw.choice([0.0, 0.5]))},
        )
    )


def at_a_wall(draw: Draw, number: int) -> Case:
    """A ring squeezed by a wall that moves, or a chamber that swells against one that stands."""
    material, young = rubber(draw)
    if number % 2 == 0:
        inner, wall = float(draw.uniform(2.4, 3.2)), float(draw.uniform(1.2, 2.0))
        long, size = float(draw.uniform(2.5, 4)), float(draw.uniform(1.0, 1.1))
        outer = inner + wall
        solid, room = level(outer, long, (0, 0, outer)), level(inner, 3 * long, (0, 0, outer))
        plate = box((-2 * outer, -2 * long, 2 * outer), (2 * outer, 2 * long, 2 * outer + 2))
        down = -float(draw.uniform(0.15, 0.35)) * inner
        return Case(
            design(
                solid,
                [room],
                material,
                goal=force("wall", "z"),
                size=size,
                planes="xy",
                fill="fraction",
                foot=0.5 * wall,
                shapes={"plate": plate},
                objects=[{"name": "wall", "shape": "plate", "motion": sunk((0, 0, down))}],
            )
        )
    side, thin = int(draw.integers(4, 7)), 1 + (number > 3)
    room = box((-side / 2, -side / 2, 2), (side / 2, side / 2, 5))
    out = side / 2 + 2
    gap = float(draw.uniform(0.1, 0.4))
    plate = box((-2 * out, -2 * out, 5 + thin + gap), (2 * out, 2 * out, 7 + thin + gap))
    return Case(
        design(
            box((-out, -out, 0), (out, out, 5 + thin)),
            [room],
            material,
            goal=GROWTH,
            planes="xy",
            loads=pressure(float(draw.uniform(0.8, 1.6)) * young * (thin / side) ** 2),
            shapes={"plate": plate},
            objects=[{"name": "wall", "shape": "plate"}],
        )
    )


def by_an_object(draw: Draw, number: int) -> Case:
    """A ball pressed into a block, or a rod that pushes a fin of one or two voxels aside."""
    material, _ = rubber(draw)
    if number % 2 == 0:
        radius, half, high = float(draw.uniform(2.5, 4.5)), int(draw.integers(3, 5)), 4
        deep = float(draw.uniform(0.4, 1.0))
        return Case(
            design(
                box((-half, -half, 0), (half, half, high)),
                [],
                material,
                goal=force("tool", "z"),
                planes="xy",
                shapes={"ball": ball(radius, (0, 0, high + radius))},
                objects=[{"name": "tool", "shape": "ball", "motion": sunk((0, 0, -deep))}],
            )
        )
    thick, high, wide = 1 + (number > 3), int(draw.integers(6, 10)), int(draw.integers(3, 6))
    radius = float(draw.uniform(1.5, 3))
    rod = level(radius, 4 * wide, (-radius, 0, 0.8 * high))
    aside = float(draw.uniform(0.1, 0.25)) * high
    return Case(
        design(
            box((0, -wide / 2, 0), (thick, wide / 2, high)),
            [],
            material,
            goal=force("tool", "x"),
            planes="y",
            shapes={"rod": rod},
            objects=[{"name": "tool", "shape": "rod", "motion": sunk((aside, 0, 0))}],
        )
    )


# --- On the grid ----------------------------------------------------------------------------------


def flat_chamber(draw: Draw, number: int) -> Case:
    """A box with walls of one or two voxels, under pressure or filled; the last is whole, fine."""
    material, young = rubber(draw)
    wide, deep, high = (int(n) for n in draw.integers(2, 5, size=3))
    wall = 1 + number % 2
    room = box((-wide, -deep, wall), (wide, deep, wall + high))
    solid = box((-wide - wall, -deep - wall, 0), (wide + wall, deep + wall, 2 * wall + high))
    load = pressure(float(draw.uniform(0.1, 0.4)) * young * (wall / (2 * max(wide, deep))) ** 2)
    entries: Table = {"loads": load, "symmetry": [{"plane": plane} for plane in "xy"]}
    goal = GROWTH
    if number in (2, 3):
        volume = float(draw.uniform(0.05, 0.15)) * 4 * wide * deep * high * UNIT**3
        supply = {"kind": "volume", "chamber": 0, "value": f"{volume!r} mm^3", "fluid": "water"}
        entries, goal = {"supplies": [supply]}, {"maximize": "chamber_pressure"}

    made = design(solid, [room], material, goal=goal, **entries)
    if number == EACH - 1:
        fine = made.replace(voxel_size=0.5 * UNIT * 1e-3)
        return Case(fine.replace(symmetry=()), fine)
    return Case(made)


def strip(draw: Draw, number: int) -> Case:
    """A strip of one or two voxels, under its weight, or a plate under a traction."""
    material, young = rubber(draw)
    thick, wide, high = 1 + number % 2, int(draw.integers(3, 6)), int(draw.integers(7, 13))
    solid = box((0, -wide / 2, 0), (thick, wide / 2, high))
    long, deep = high * UNIT * 1e-3, thick * UNIT * 1e-3
    bent = float(draw.uniform(0.05, 0.25)) * long
    load: Table
    clamps = [{"region": {"z": ["-inf", 0]}}]
    if number < 3:
        # The tip of a cantilever under its weight: ρ g L⁴ 12/(8 E t²).
        pull = bent * 8 * young * 1e3 * deep**2 / (12 * 1070 * long**4)
        load = {"kind": "gravity", "value": f"{pull!r} m/s^2", "direction": [1, 0, 0]}
        at = high
    else:
        # The middle of a plate between two clamps: p L⁴ 12/(384 E t³).
        bent, at = 0.3 * bent, high / 2
        push = bent * 384 * young * 1e3 * deep**3 / (12 * long**4)
        region = {"x": [mm(thick), mm(thick)]}
        load = {"kind": "traction", "region": region, "value": f"{push!r} Pa"}
        clamps.append({"region": {"z": [mm(high), "inf"]}})
    return Case(
        design(
            solid,
            [],
            material | {"density": "1070 kg/m^3"},
            goal=tip("x"),
            planes="y",
            loads=[load],
            clamps=clamps,
            probes={"tip": {"point": point((0, 0, at))}},
        )
    )


def notched(draw: Draw, number: int) -> Case:
    """A notched finger with a tendon drawn in, its tension, or its slowest vibration."""
    material, _ = rubber(draw)
    count, wide, deep = int(draw.integers(2, 4)), int(draw.integers(2, 4)), int(draw.integers(3, 5))
    left = 1 + number % 2
    high = 4 * count + 1
    slots = [box((left, -wide, 4 * i + 1), (deep + 9, wide, 4 * i + 3)) for i in range(count)]
    entries: Table = {}
    goal: Table = {"maximize": "natural_frequency"}
    if number < 3:
        between = [4 * i + z for i in range(count) for z in (1, 3)]
        ends = [point((deep - 0.5, 0, z)) for z in (0, *between, high)]
        drawn = float(draw.uniform(0.3, 0.8)) * count
        entries["tendons"] = [
            {"name": "pull", "through": ends, "shortening": mm(drawn), "guide": "eyelets"}
        ]
        goal = {"minimize": "tendon_tension", "tendon": "pull"}
    return Case(
        design(
            box((0, -wide / 2, 0), (deep, wide / 2, high)),
            slots,
            material | {"density": "1070 kg/m^3"},
            goal=goal,
            **entries,
        )
    )


KINDS: Final[dict[str, Callable[[Draw, int], Case]]] = {
    "tube": tube,
    "shell": shell,
    "turned bender": turned_bender,
    "segment": segment,
    "post": post,
    "round finger": round_finger,
    "pressed down": pressed_down,
    "at a wall": at_a_wall,
    "by an object": by_an_object,
    "flat chamber": flat_chamber,
    "strip": strip,
    "notched": notched,
}
#: Kinds of round, thin, shifted or turned bodies, and of those in contact.
ROUND: Final = tuple(KINDS)[:6]
TOUCHING: Final = tuple(KINDS)[6:9]


def case(kind: str, number: int, drawn: str = "first") -> Case:
    """A body of a set, always as it was first drawn."""
    draw = np.random.default_rng([SETS[drawn], list(KINDS).index(kind), number])
    return KINDS[kind](draw, number)
