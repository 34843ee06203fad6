"""Contact: who touches whom, and with how much friction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, Literal, Self

from pydantic import Field, model_validator

from voxsoft.design.object import Object
from voxsoft.design.operands import Name
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.records import Record, closest
from voxsoft.units import PositiveLength, PositivePressure

#: Name of the design's body in a pair.
BODY: Final = "body"
#: Name of the floor in a pair.
FLOOR: Final = "floor"


class Adhesion(Record):
    """Traction between two surfaces that are close to each other, which draws them together.

    Parameters
    ----------
    strength
        Largest traction, at a third of the range.
    range
        Gap beyond which there is none.

    Notes
    -----
    The work of separation is 9/16 of strength times range, for each area. It comes back when the
    surfaces close again.

    Examples
    --------
    >>> Adhesion(strength="2 kPa", range="0.5 mm").strength
    2000.0
    """

    strength: PositivePressure
    range: PositiveLength


class ContactPair(Record):
    """Two surfaces whose contact differs from that of all others.

    Parameters
    ----------
    of
        Names of objects, ``"body"`` or ``"floor"``; the body twice for contact with itself. In a
        design of several bodies these have their own names.
    friction
        Coulomb's coefficient; default: that of :class:`Contact`.
    kind
        ``"touching"`` (default), ``"none"`` where they pass through each other, or ``"bonded"``
        where they are within half a voxel of each other in the unloaded design: there they pull
        and push, and the gap between them at rest stays.
    strength
        The traction at which a bond lets go, from its pull and the traction along it,
        the root of the sum of their squares; then they touch. Default: it never does.
    adhesion
        Adhesion of the two, of two different things that touch; default: that of :class:`Contact`.

    Examples
    --------
    >>> ContactPair(of=("body", "plate"), friction=0.9).kind
    'touching'
    >>> ContactPair(of=("body", "pad"), kind="bonded", strength="20 kPa").strength
    20000.0
    >>> ContactPair(of=("body", "pad"), strength="20 kPa")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: strength: is that of a bond, and the kind is "touching". Try: \
write kind = "bonded", or leave strength out
    """

    of: tuple[Name, Name]
    friction: float | None = Field(None, ge=0.0)
    kind: Literal["touching", "none", "bonded"] = "touching"
    strength: PositivePressure | None = None
    adhesion: Adhesion | None = None

    @model_validator(mode="after")
    def _uses_all(self) -> Self:
        if self.strength is not None and self.kind != "bonded":
            what = f'is that of a bond, and the kind is "{self.kind}"'
            raise DesignError("strength", what, 'write kind = "bonded", or leave strength out')
        if self.adhesion is not None and self.kind != "touching":
            what = f'is that of a pair that touches, and the kind is "{self.kind}"'
            raise DesignError("adhesion", what, 'write kind = "touching", or leave adhesion out')
        if self.adhesion is not None and self.of[0] == self.of[1]:
            what = f'acts between two things, and the pair is "{self.of[0]}" with itself'
            raise DesignError("adhesion", what, "name two things, or leave adhesion out")
        slides = self.kind == "touching" or self.strength is not None
        if self.friction is not None and not slides:
            what = f'is not used by what does not slide, and the kind is "{self.kind}"'
            hint = "leave friction out"
            if self.kind == "bonded":
                hint = "add a strength, beyond which it slides, or leave friction out"
            raise DesignError("friction", what, hint)
        return self


class Contact(Record):
    """Contact: by default of bodies with themselves, each other and all objects, and of those too.

    Parameters
    ----------
    friction
        Coulomb's coefficient of all pairs; default 0.
    adhesion
        Adhesion of all pairs of two different things that touch; default: none.
    pairs
        Pairs that differ; of two entries for one pair the later one counts.
    separate
        If true, objects that are in something in the unloaded design are moved out of it, along the
        shortest way, with a warning; default False, which refuses them.
    surface
        Contact surface of the body: ``"smooth"`` (default) is the surface of its shapes, carried by
        the voxels, ``"voxels"`` their faces.

    Notes
    -----
    Voxels that are cut into smaller ones (``refine``) touch with their faces.

    A design has contact where it has this table, objects or several bodies. It is found in
    equilibrium, with ``method = "statics"`` and ``control = "load"``, and over time, with
    ``method = "dynamics"``. Its floor is one of the objects then, with the friction of all.

    Examples
    --------
    >>> rough = Contact(friction=0.6, pairs=[{"of": ["body", "oil"], "friction": 0.0}])
    >>> rough.pairs[0].of
    ('body', 'oil')
    """

    friction: float = Field(0.0, ge=0.0)
    adhesion: Adhesion | None = None
    pairs: tuple[ContactPair, ...] = ()
    separate: bool = False
    surface: Literal["smooth", "voxels"] = "smooth"

    def table(
        self, objects: Sequence[Object], floor: bool = False, bodies: Sequence[str] = (BODY,)
    ) -> list[list[float]]:
        """The friction of the bodies, the objects and a floor with each other.

        NaN stands where they do not touch: two things that are held or moved do not, nor do those
        that are bonded for good.

        Examples
        --------
        >>> plate = Object(name="plate", shape="plate")
        >>> Contact(friction=0.5).table([plate])
        [[0.5, 0.5], [0.5, nan]]
        """
        names = names_of(objects, floor, bodies)
        moves = [
            *(True for _ in bodies),
            *(each.is_free for each in objects),
            *([False] if floor else []),
        ]
        none = float("nan")
        table = [
            [
                self.friction if (moves[a] or moves[b]) and (a != b or a < len(bodies)) else none
                for b in range(len(names))
            ]
            for a in range(len(names))
        ]
        for pair in self.pairs:
            a, b = (names.index(name) for name in pair.of)
            friction = self.friction if pair.friction is None else pair.friction
            touches = pair.kind == "touching" or pair.strength is not None
            table[a][b] = table[b][a] = friction if touches else none
        return table


def names_of(objects: Sequence[Object], floor: bool, bodies: Sequence[str] = (BODY,)) -> list[str]:
    """List the names that contact knows: the bodies, the objects, and a floor if there is one."""
    return [*bodies, *(each.name for each in objects), *([FLOOR] if floor else [])]


def contact_problems(
    objects: Sequence[Object],
    contact: Contact | None,
    floor: bool,
    bodies: Sequence[str] = (BODY,),
) -> Iterator[ErrorDetail]:
    """Find names that are there twice or not at all, and pairs that cannot be."""
    names = [each.name for each in objects]
    for index, name in enumerate(names):
        if name in (BODY, FLOOR, *bodies) or name in names[:index]:
            what = f'the name "{name}" is taken'
            yield ErrorDetail(f"objects[{index}].name", what, "give it another name")
    known = names_of(objects, floor, bodies)
    some = bodies[0]
    free = {*bodies, *(each.name for each in objects if each.is_free)}
    for index, pair in enumerate(contact.pairs if contact else ()):
        where = f"contact.pairs[{index}].of"
        for name in pair.of:
            if name not in known:
                hint = closest(name, known) or f'write "{some}" or the name of an object'
                yield ErrorDetail(where, f'there is no object "{name}"', hint)
        if pair.kind != "none" and free.isdisjoint(pair.of):
            what = "are held or moved, both of them, and do not touch each other"
            yield ErrorDetail(where, what, f'name "{some}" or an object that is free')
        elif pair.kind == "bonded" and pair.of[0] == pair.of[1]:
            what = "is one thing, and is not bonded to itself"
            yield ErrorDetail(where, what, "name two things")
        elif pair.kind == "touching" and pair.of[0] == pair.of[1] and pair.of[0] not in bodies:
            what = "is rigid, and does not touch itself"
            yield ErrorDetail(where, what, f'name "{some}" twice, or two things')
