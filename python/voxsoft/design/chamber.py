"""Chambers that have names, and which of a body's cavities a design means."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag

from voxsoft.design.region import Spot
from voxsoft.errors import DesignError, NoCavityError
from voxsoft.mesh import Mesh
from voxsoft.records import Name, closest

_ALL: Final = "all"


class Chamber(Spot):
    """A place that names a cavity: a point in it, or a region that holds most of its wall.

    Parameters
    ----------
    point
        A point in the enclosed air of the unloaded body.

    Examples
    --------
    >>> Chamber(point=(0, "5 mm", "20 mm")).point
    (0.0, 0.005, 0.02)
    """


def _check_name(name: str) -> str:
    if name == _ALL:
        what = 'a chamber cannot be called "all": loads mean every cavity by that'
        raise DesignError("", what, "call it by its place: left, upper, tip")
    return name


#: Name by which loads and metrics refer to a chamber.
ChamberName = Annotated[Name, AfterValidator(_check_name)]


def _kind_of(value: object) -> str:
    if not isinstance(value, str):
        return "index"
    return "all" if value == _ALL else "name"


#: All cavities, one by its name under ``[chambers]``, or one by its index; 0 is the largest.
CavityChoice = Annotated[
    Annotated[Literal["all"], Tag("all")]
    | Annotated[int, Field(ge=0), Tag("index")]
    | Annotated[Name, Tag("name")],
    Discriminator(_kind_of),
    # Forms offer the names under [chambers].
    Field(json_schema_extra={"x-names": "chambers"}),
]


def chosen_cavities(choice: str | int | None, mesh: Mesh, where: str) -> tuple[int, ...]:
    """Return the indices of the cavities that a load or a metric means.

    Parameters
    ----------
    choice
        ``"all"`` or None for all of them, the name of a chamber, or an index. Of a body of several
        ``"left.all"`` are all of its cavities, and ``"left.0"`` is its largest one.
    mesh
        A mesh whose cavities have the names of the design's chambers.
    where
        The place in the design, for messages.

    Raises
    ------
    NoCavityError
        There is no such cavity.
    """
    cavities = mesh.cavities
    if choice is None or choice == _ALL:
        return tuple(range(len(cavities)))
    if isinstance(choice, int):
        if choice >= len(cavities):
            raise NoCavityError(where, f"{choice} is past the last of {len(cavities)} cavities")
        return (choice,)
    names = [cavity.name for cavity in cavities]
    if choice not in names:
        body, _, which = choice.rpartition(".")
        own = [i for i, each in enumerate(cavities) if f"{each.body}.".startswith(f"{body}.")]
        if body and own and which == _ALL:
            return tuple(own)
        if body and which.isdecimal() and int(which) < len(own):
            return (own[int(which)],)
        hint = closest(choice, [name for name in names if name]) or "name it under [chambers]"
        raise NoCavityError(where, f'there is no chamber "{choice}"', hint)
    return (names.index(choice),)


def name_of_cavity(mesh: Mesh, index: int) -> str:
    """Return the name of a cavity, or its index where it has none.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> shell = [[[1] * 3] * 3, [[1, 1, 1], [1, 0, 1], [1, 1, 1]], [[1] * 3] * 3]
    >>> name_of_cavity(Voxels.from_array(shell, voxel_size=0.01).mesh(), 0)
    'cavity 0'
    """
    name = mesh.cavities[index].name
    return f"chamber {name}" if name else f"cavity {index}"
