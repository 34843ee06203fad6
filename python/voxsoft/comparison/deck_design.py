"""Design as a file for CalculiX holds it, and its entries that such a file has no word for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

from voxsoft.comparison.full_voxels import with_full_voxels
from voxsoft.design import Contact, Design, Object
from voxsoft.design.attachment import attachments_of
from voxsoft.errors import ErrorDetail
from voxsoft.simulation.compatibility import REASONS, USES, refused_features
from voxsoft.simulation.features import FEATURES, has_feature
from voxsoft.simulation.solving.choice import given_settings

#: Settings of a solver that a file holds, or that change no equilibrium.
_HELD: Final = frozenset({"method", "refine", "end_time", "time_step"})

#: Sentence on a feature that is lost, and the function that leaves it out of a design.
_Loss = tuple[str, Callable[[Design], Design]]


def _without(**changes: object) -> Callable[[Design], Design]:
    return lambda design: design.replace(**changes)


def _without_loads(kind: str) -> Callable[[Design], Design]:
    return lambda design: design.replace(loads=[load for load in design.loads if load.kind != kind])


def _without_attachments(design: Design) -> Design:
    names = {where.partition("[")[0] for where, _ in attachments_of(design)}
    return design.replace(**dict.fromkeys(names, ()))


def _without_seals(design: Design) -> Design:
    return design.replace(layers=[layer.replace(seal=False) for layer in design.layers])


def _without_fibers(design: Design) -> Design:
    return design.replace(parts=[part.replace(fibers=()) for part in design.parts])


def _without_free_objects(design: Design) -> Design:
    gone = {each.name for each in design.objects if each.is_free}
    contact = design.contact
    if contact is not None:
        kept = [pair for pair in contact.pairs if gone.isdisjoint(pair.of)]
        contact = contact.replace(pairs=kept)
    return design.replace(
        objects=[each for each in design.objects if not each.is_free], contact=contact
    )


def _without_turns(design: Design) -> Design:
    def still(each: Object) -> Object:
        return each if each.way is None else each.replace(motion=each.way.replace(rotation=None))

    return design.replace(objects=[still(each) for each in design.objects])


def _without_bonds(design: Design) -> Design:
    contact = design.contact or Contact()
    kept = [pair for pair in contact.pairs if pair.kind != "bonded"]
    return design.replace(contact=contact.replace(pairs=kept))


def _without_adhesion(design: Design) -> Design:
    contact = design.contact or Contact()
    pairs = [pair.replace(adhesion=None) for pair in contact.pairs]
    return design.replace(contact=contact.replace(adhesion=None, pairs=pairs))


#: Features that are left out, in this order; another one that outside codes refuse is an error.
_LOSSES: Final[Mapping[str, _Loss]] = MappingProxyType(
    {
        "immersion": (
            "is not held: no pressure there grows with depth",
            _without_loads("immersion"),
        ),
        "drag": ("is not held: no fluid acts on the body there", _without_loads("drag")),
        "force field": (
            "is not held: no acceleration is a formula there",
            _without_loads("force_field"),
        ),
        "layers that seal": (
            "is written without the openings that it spans, and chambers behind them are open",
            _without_seals,
        ),
        "springs and the like": ("is not held: the body is without it", _without_attachments),
        "tendons": ("is not held: nothing pulls there", _without(tendons=())),
        "supplies": (
            "are not held: write the pressures that a run finds as pressure loads",
            _without(supplies=(), connections=()),
        ),
        "fibers": ("is not held: the material is the same in all directions", _without_fibers),
        "activations": ("is not held: parts keep their size", _without(activations=())),
        "free objects": ("is free: the object is left out", _without_free_objects),
        "objects that turn": ("is written without its turn", _without_turns),
        "bonds": ("is a bond: the two touch, and come apart", _without_bonds),
        "adhesion": ("is not held: surfaces do not stick", _without_adhesion),
    }
)
#: Kinds of loads that are left out.
_LOADS: Final = frozenset({"immersion", "drag", "force_field"})


@dataclass(frozen=True)
class DeckDesign:
    """A design that outside codes know.

    Attributes
    ----------
    design
        The design without the entries that are lost.
    loads
        Number of each of its loads in the design that was given.
    lost
        Entries that the file does not hold, or holds in another form.
    """

    design: Design
    loads: tuple[int, ...]
    lost: tuple[ErrorDetail, ...] = field(repr=False)

    @classmethod
    def of(cls, design: Design) -> DeckDesign:
        """Leave out of a design all that outside codes are not given.

        Parameters
        ----------
        design
            The design; its goals are left out too, without a word.

        Raises
        ------
        SimulationError
            A design of several bodies, or of a loose one at rest.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> wet = families.beam().replace(loads=[{"kind": "immersion", "level": "1 m"}])
        >>> found = DeckDesign.of(wet)
        >>> found.design.loads, [each.where for each in found.lost]
        ((), ['loads[0]'])
        """
        own = design.assembled.replace(objectives={}, constraints={})
        refused = dict.fromkeys(refused_features(own, "outside codes"))
        wrong = [
            ErrorDetail(where, *REASONS[name, "outside codes"])
            for name in refused
            if name not in _LOSSES and name != "cut voxels"
            for where in FEATURES[name](own)
        ]
        if not own.clamps and not own.solver.is_timed:
            hint = "clamp a part of it, or give the solver an end_time for its motion"
            what = "hold nothing, and there is no equilibrium of a loose body in CalculiX"
            wrong.append(ErrorDetail("clamps", what, hint))
        if wrong:
            raise USES["outside codes"].error.listing(wrong)
        kept = [number for number, load in enumerate(own.loads) if load.kind not in _LOADS]
        lost = [
            ErrorDetail(where, _LOSSES[name][0])
            for name in _LOSSES
            if name in refused
            for where in FEATURES[name](own)
        ]
        for name in _LOSSES:
            if name in refused:
                own = _LOSSES[name][1](own)
        lost += _of_settings(own)
        own, unlike = with_full_voxels(own)
        hint = 'compare with fill = "binary"'
        lost += [
            ErrorDetail(each.where, "is binary here: the bricks are full voxels", hint)
            for each in unlike
        ]
        return cls(own, tuple(kept), tuple(dict.fromkeys(lost)))


#: Sentence on a layer in an outside code.
BEARS_COMPRESSION: Final = "bears compression in outside codes, where it wrinkles in ours"


def _of_settings(design: Design) -> Iterator[ErrorDetail]:
    """Find settings and properties that change an answer, and that a file does not hold."""
    for index in range(len(design.layers)):
        yield ErrorDetail(f"layers[{index}]", BEARS_COMPRESSION)
    solver = design.solver
    held = _HELD | ({"damping"} if solver.is_timed and isinstance(solver.damping, float) else set())
    for name in given_settings(solver):
        if name not in held:
            rest = (
                "over time, at this rate alone" if solver.is_timed else "at rest, under its loads"
            )
            yield ErrorDetail(f"solver.{name}", f"is not held: the step is one {rest}")
    if solver.is_timed and has_feature(design, "viscosity"):
        for where in FEATURES["viscosity"](design):
            yield ErrorDetail(where, "has branches that relax, which are not held: it is elastic")
    if not solver.is_timed:
        return
    contact = design.contact
    rubs = contact is not None and any(
        friction for friction in (contact.friction, *(pair.friction for pair in contact.pairs))
    )
    if rubs and has_feature(design, "contact"):
        yield ErrorDetail(
            "contact.friction",
            "may end a motion in CalculiX 2.20, where an impact with friction did not converge",
            "leave friction out, or export it at rest",
        )
    for index, part in enumerate(design.parts):
        if design.material_of(part).model == "ogden":
            yield ErrorDetail(
                f"parts[{index}].material",
                "does not begin to move in CalculiX 2.20: no first increment from rest converges",
                'take a "yeoh" or "neo-hookean" one of the same stress, or export it at rest',
            )
    for index, clamp in enumerate(design.clamps):
        motion = clamp.motion
        if motion is not None and motion.rotation is not None and motion.history is not None:
            yield ErrorDetail(
                f"clamps[{index}].motion",
                "turns over time, and its nodes go straight to where it ends",
                "export it at rest, without end_time",
            )
