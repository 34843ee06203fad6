"""Finished robots: designs to open, look at and change, and the first steps to one of your own.

Each is a TOML file beside this module, or a family of :mod:`voxsoft.design.families`, with its
picture at rest under its loads (``python studio/thumbnails.py`` draws them). All can be solved, and
open without a warning.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import resources
from typing import Final, Literal

from voxsoft.design import families
from voxsoft.errors import DesignError
from voxsoft.records import closest

#: Drive of a robot.
Drive = Literal["pressure", "tendon", "magnet", "heat"]
#: Form of a robot.
Form = Literal["finger", "bellows", "trunk", "cylinder"]
#: Task of a robot.
Task = Literal["bend", "extend", "grip", "lift"]


@dataclass(frozen=True)
class Robot:
    """A finished robot.

    Attributes
    ----------
    name
        Name of its file; also that of the example.
    title
        Title on the start screen.
    sentence
        Its build and its motion.
    """

    name: str
    title: str
    sentence: str


#: In the order in which they are shown.
ROBOTS: Final = (
    Robot("pneunet", "Bending finger", "A row of chambers on a layer that stretches less."),
    Robot("pumped_gripper", "Gripper", "Two fingers on one hose close on a can and lift it."),
    Robot("bellows", "Bellows", "Three folds that air unfolds: little pressure, a long way."),
    Robot("tendon_trunk", "Trunk", "A hanging trunk that four tendons steer."),
    Robot("starfish", "Starfish", "Five arms that one motor curls by five tendons."),
    Robot("crawler", "Crawler", "Two bellows on the floor that creep by friction."),
    Robot("magnetic_gripper", "Magnetic gripper", "Four arms with magnet powder, in a field."),
    Robot("wound_tube", "Wound muscle", "A tube wound with thread that shortens under pressure."),
    Robot("wound_bender", "Wound finger", "A tube wound with thread, and a line along one side."),
    Robot("tendon_finger", "Tendon finger", "Two joints, a tendon to bend and one to open them."),
    Robot("shape_memory_finger", "Warm finger", "A layer of shape-memory fibers that curls it."),
)


@dataclass(frozen=True)
class Start:
    """A robot, with values of its parameters, for three answers.

    Attributes
    ----------
    drive, form, task
        The answers.
    robot
        Name of the robot to begin with.
    sentence
        Expected behavior.
    parameters
        Values that differ from those of the robot.
    """

    drive: Drive
    form: Form
    task: Task
    robot: str
    sentence: str
    parameters: Mapping[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The three answers in one word."""
        return f"{self.drive}-{self.form}-{self.task}"


#: All that three answers may lead to; each combination once.
STARTS: Final = (
    Start(
        "pressure",
        "finger",
        "bend",
        "pneunet",
        "Chambers push each other apart, the layer holds: it bends down.",
    ),
    Start(
        "pressure",
        "finger",
        "grip",
        "pumped_gripper",
        "Two fingers, a pump and two valves; they grip and lift a can.",
    ),
    Start(
        "pressure",
        "bellows",
        "extend",
        "bellows",
        "Three folds that unfold to about a third more of their height.",
    ),
    Start(
        "pressure",
        "bellows",
        "lift",
        "bellows",
        "Wider folds with a thicker wall: more area for the air to lift by.",
        {"width": "26 mm", "waist": "14 mm", "wall": "4 mm"},
    ),
    Start(
        "pressure",
        "cylinder",
        "extend",
        "wound_tube",
        "Thread wound steeply holds the width: the tube grows long.",
        {"wind": "75 deg"},
    ),
    Start(
        "pressure",
        "cylinder",
        "lift",
        "wound_tube",
        "Thread wound along the tube: it shortens as McKibben's muscle does.",
    ),
    Start(
        "pressure",
        "cylinder",
        "bend",
        "wound_bender",
        "A line on one side keeps its length: the tube bends to that side.",
    ),
    Start(
        "tendon",
        "finger",
        "bend",
        "tendon_finger",
        "A tendon below two joints bends them, one above opens them.",
    ),
    Start("tendon", "finger", "grip", "starfish", "Five arms curl around what lies below them."),
    Start(
        "tendon",
        "trunk",
        "bend",
        "tendon_trunk",
        "One of four tendons is pulled: the trunk bends to its side.",
    ),
    Start(
        "tendon",
        "trunk",
        "lift",
        "tendon_trunk",
        "All four tendons are pulled alike: the trunk draws up its tip.",
        {"left": "4 N", "right": "4 N", "front": "4 N", "back": "4 N"},
    ),
    Start(
        "magnet",
        "finger",
        "bend",
        "magnetic_gripper",
        "Arms magnetized outward, which a weak field raises.",
        {"reach": "26 mm", "field": "6 mT"},
    ),
    Start(
        "magnet",
        "finger",
        "grip",
        "magnetic_gripper",
        "Arms magnetized outward, which a field along z closes.",
        {"field": "16 mT"},
    ),
    Start(
        "heat",
        "finger",
        "bend",
        "shape_memory_finger",
        "Fibers that shorten as they are warmed curl the finger.",
    ),
)


def robot(name: str) -> Robot:
    """Return a finished robot by its name.

    Raises
    ------
    DesignError
        There is no such robot.

    Examples
    --------
    >>> robot("bellows").title
    'Bellows'
    """
    for each in ROBOTS:
        if each.name == name:
            return each
    known = tuple(each.name for each in ROBOTS)
    raise DesignError("robot", f'there is no robot "{name}"', closest(name, known))


def start(name: str) -> Start:
    """Return where three answers lead.

    Parameters
    ----------
    name
        The answers, such as ``"pressure-finger-bend"``.

    Raises
    ------
    DesignError
        No robot is made of these answers.

    Examples
    --------
    >>> start("tendon-trunk-bend").robot
    'tendon_trunk'
    """
    for each in STARTS:
        if each.name == name:
            return each
    known = tuple(each.name for each in STARTS)
    raise DesignError("start", f'there is no robot for "{name}"', closest(name, known))


def robot_text(name: str) -> str:
    """Return the design of a robot as the text of a design file, with comments.

    Parameters
    ----------
    name
        One of those of :data:`ROBOTS`.

    Raises
    ------
    DesignError
        There is no such robot.

    Examples
    --------
    >>> print(robot_text("bellows")[:37])
    # A bellows of three folds that rises
    """
    robot(name)
    if name in families.FAMILIES:
        return families.family_text(name)
    return _file(f"{name}.toml").read_text(encoding="utf-8")


def robot_picture(name: str, *, moving: bool = False) -> bytes:
    """Return the picture of a robot at rest under its loads: WebP, transparent around it.

    Parameters
    ----------
    name
        One of those of :data:`ROBOTS`.
    moving
        Its way there and back instead, as an animated picture; of the first robot alone.

    Raises
    ------
    DesignError
        There is no such robot, or no such picture of it.

    Examples
    --------
    >>> robot_picture("bellows")[8:12]
    b'WEBP'
    """
    file = _file(f"{robot(name).name}{'-moving' if moving else ''}.webp")
    if not file.is_file():
        raise DesignError(
            "robot", f'there is no moving picture of "{name}"', f"see {ROBOTS[0].name}"
        )
    return file.read_bytes()


def _file(name: str) -> resources.abc.Traversable:
    return resources.files("voxsoft.design.robots").joinpath(name)
