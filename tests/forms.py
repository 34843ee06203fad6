"""Every form in which every entry of every record can be typed, read off the records themselves.

A new field, kind of shape, load or material is tried without a line here; one whose values cannot
be guessed from its type fails the tests that use this, and is then given values in `SPECIAL`.
"""

import types
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import annotated_types
import numpy as np
import pint
from pydantic import StringConstraints, WithJsonSchema

from voxsoft.design import Design, Dielectric, ForceField, Parameter, Region, ShapeMemory
from voxsoft.design.activation import FiberStrain, Strain, Swelling, Thermal
from voxsoft.design.body import Body
from voxsoft.design.clamp import Clamp, Rotation
from voxsoft.design.contact import ContactPair
from voxsoft.design.history import History
from voxsoft.design.layer import Layer
from voxsoft.design.line import Pump, Valve
from voxsoft.design.molds import Molds
from voxsoft.design.object import Object
from voxsoft.design.part import Part
from voxsoft.design.printer import Printer
from voxsoft.design.profile import Profile
from voxsoft.design.refinement import Refinement
from voxsoft.design.region import Spot
from voxsoft.design.spring import Spring
from voxsoft.design.supply import Connection, FlowSupply, MassSupply, Supply
from voxsoft.design.target import Constraint, Objective
from voxsoft.design.tendon import Guide, Tendon
from voxsoft.errors import VoxSoftError
from voxsoft.materials import Card, Fiber, Mullins, StretchRange
from voxsoft.records import Record
from voxsoft.shapes import Blend, Expression, Grade, Gyroid, Sphere, TriangleMesh
from voxsoft.units import KINDS, UnitOf

UREG = pint.UnitRegistry()

#: Names that files, shells, formulas and other programs could stumble over.
NAMES = (
    *(
        "plain",
        "tip left",
        "tip.left",
        "höhe",
        "ho\u0308he",
        "名前",
        "שלום",
        "𝔘𝔙",
        "🦾",
        "a/b",
        "x,y",
    ),
    *(
        "a=b",
        "#1",
        'say "ah"',
        "it's",
        "[0]",
        "{}",
        "\\n",
        "true",
        "1",
        "-inf",
        "name",
        "a:b",
        "a<b>&c",
        " ",
        "%",
    ),
    "n" * 200,
)
TEXTS = (
    "",
    "= no formula",
    "two\nlines\r\n\tand a tab",
    'quotes "" and \\',
    "\x00\x1b\x7f\u2028",
    "ü" * 500,
)

#: A size that twelve digits do not hold, beside plain ones.
SIZES = (1.0, 0.0023, 1e-3 / 3)
FRACTIONS = (0.25, 1 / 3)

NUMBERS = (float, int)

#: Parameters for formulas: one of each kind, and how it is written in one.
PARAMETERS = {f"p_{kind.replace(' ', '_')}": Parameter(value=3.0, kind=kind) for kind in KINDS}

#: Fields whose values their type does not tell.
SPECIAL: dict[tuple[type, str], tuple[Any, ...]] = {
    (Expression, "text"): ("x", "sqrt(x^2 + y**2) - 0.02", "min(x, y, 1e-3)"),
    (Blend, "weight"): (0.25, "0.25", "0.5 + x", Expression(text="x + y")),
    (Grade, "of"): (Gyroid(period=0.01, thickness=0.001), "plain"),
    (Grade, "thickness"): ("0.001 + 0.05*z", Expression(text="x")),
    (Grade, "period"): ("0.01 + 0.05*z", Expression(text="x")),
    (TriangleMesh, "path"): ("part.stl", "/some where/höhe.obj"),
    (TriangleMesh, "unit"): ("mm", "inch"),
    (Clamp, "axes"): ("x", "zy", "xyz"),
    (Parameter, "kind"): tuple(sorted(KINDS)),
    (Constraint, "kind"): tuple(sorted(KINDS)),
    (StretchRange, "largest"): (4.0, 1 + 1 / 3, np.float32(2.5), "4"),
    (Mullins, "r"): (1.5, 4 / 3, np.float32(2.5), "1.25"),
    (Pump, "flow"): (("2 L/min", 0), [1e-5 / 3, "3 mL/s", "0 L/min"], ("= p_volume_flow", 0)),
    (Pump, "pressure"): ((0, "40 kPa"), [0, 1e4 / 3], (0, "= p_pressure")),
    **{
        (supply, name): ("20 degC", 300.1 / 3, "293.15 K", np.float64(310.0))
        for supply, name in ((Supply, "temperature"), (MassSupply, "fill_temperature"))
    },
    (Supply, "chambers"): (("plain", 0), [1, "all"]),
    (Supply, "leak"): ({"conductance": "0.1 L/s/bar"}, {"conductance": 1e-9 / 3}),
    (FlowSupply, "valve"): ({"conductance": "0.1 L/s/bar"}, {"conductance": 1e-9 / 3}),
    (Connection, "chambers"): (("plain", 0), [0, 1]),
    (Connection, "valve"): ({"conductance": "0.1 L/s/bar"}, {"conductance": 1e-9 / 3}),
    (Card, "calibration"): (
        {},
        {"voxel size": "5 mm", "errors": [0.1, {"of": True}], "seed": 3},
    ),
}

# The one name that every contact may have: that of the body.
SPECIAL[ContactPair, "of"] = (("body", "body"), ["body", "body"])

#: A design within a design, whose formulas are of its own parameters.
INNER = {
    "name": "inner",
    "voxel_size": "5 mm",
    "parameters": {"r": {"value": "20 mm", "max": "1 km"}, "many": 2},
    "parts": [{"shape": {"kind": "sphere", "radius": "= r"}, "material": "ecoflex-00-30"}],
    "clamps": [{"region": {"z": ["-inf", 0]}}],
    "probes": {"top": {"point": [0, 0, 0]}},
}
SPECIAL[ForceField, "acceleration"] = (
    (0, 0, "-9.81"),
    ["-2*vx", "sin(3*t)*x", 1 / 3],
    ("= p_acceleration", 0, "-1/3"),
)
SPECIAL[History, "expression"] = ("1 - exp(-t)", "sin(2*pi*t)^2")
ACTIVATIONS = (Dielectric, FiberStrain, ShapeMemory, Strain, Swelling, Thermal)
SPECIAL[Profile, "axis"] = ("x", "z")
SPECIAL[Profile, "at"] = (("0 mm", "5 mm"), [-1 / 3, 0.01])
SPECIAL[Profile, "factor"] = ((0, 1), [1 / 3, 2])
SPECIAL[Profile, "expression"] = ("z / 0.005", "x*y + 1")
SPECIAL |= {(model, "part"): ("plain",) for model in (*ACTIVATIONS, Refinement)}
# Of whole kelvins the forms make coefficients that leave nothing of a part.
SPECIAL[Thermal, "expansion"] = ("3e-4 1/K", 1e-4)
# Of one temperature, or of two in any order, there is no way up and down.
SPECIAL[Dielectric, "permittivity"] = (2.8, 5)
SPECIAL[ShapeMemory, "heating"] = (("340 K", "350 K"), [340.0, 350])
SPECIAL[ShapeMemory, "cooling"] = (("330 K", "320 K"), [340.0, 300])
SPECIAL[ShapeMemory, "transformed"] = (0.25, 1)
SPECIAL[Molds, "shrinkage"] = (0.002, "0.2 %", 0.1 / 3)
SPECIAL[Printer, "draft"] = ("1 deg", 0.1 / 3)
SPECIAL[Body, "design"] = (INNER, Design.from_document(INNER))
SPECIAL[Body, "set"] = ({"r": "12 mm"}, {"r": 0.1 / 3}, {"r": "= p_length"}, {"many": 3, "r": 0.02})
#: Names of bodies that there are: test_roundtrip_of_places_of_bodies has these. Names of regions of
#: a mesh's file: tests/unit/design/test_file_bodies.py saves and loads them.
ELSEWHERE = {(Region, "body"), (Part, "body"), (Guide, "body"), (Region, "name")}

#: Further entries of a record beside its required fields.
NEEDS: dict[type, dict[str, Any]] = {
    Region: {"x": (0, "10 mm")},
    Spot: {"point": (0, 0, 0)},
    Objective: {"maximize": "displacement"},
    Constraint: {"metric": "mass", "max": "30 g"},
    Layer: {"region": {"z": (0, 0)}},
    Rotation: {"axis": (0, 0, 1)},
    Fiber: {"direction": (0, 0, 1)},
    Parameter: {"value": "5 mm"},
    Valve: {"conductance": "0.1 L/s/bar"},
    History: {"time": ("0 s",), "factor": (1,)},
    Profile: {"axis": "z", "at": ("0 mm", "5 mm"), "factor": (0, 1)},
    Guide: {"point": (0, 0, 0)},
    Tendon: {"tension": "6 N"},
}

#: Entries of a list that come first, where one entry is not enough.
FIRST: dict[tuple[type, str], list[Any]] = {(Tendon, "through"): [(0, 0, "50 mm")]}

#: Entries that go with a field, or (None) cannot stand beside it.
BESIDE: dict[tuple[type, str], dict[str, Any]] = {
    (Region, "center"): {"radius": "5 mm"},
    (Region, "radius"): {"center": (0, 0, 0)},
    (Spot, "center"): {"radius": "5 mm", "point": None},
    (Spot, "radius"): {"center": (0, 0, 0), "point": None},
    **{(Spot, name): {"point": None} for name in ("x", "y", "z", "shape")},
    (Objective, "minimize"): {"maximize": None},
    (Parameter, "kind"): {"value": 0.5},
    (Constraint, "kind"): {"max": 0.5},
    (Constraint, "min"): {"max": None},
    (Spring, "to"): {"anchor": None},
    (Fiber, "angle"): {"direction": None, "axis": "z"},
    (Fiber, "axis"): {"direction": None, "angle": "30 deg"},
    (Fiber, "center"): {"direction": None, "axis": "z", "angle": "30 deg"},
    (History, "sine"): {"time": (), "factor": ()},
    (History, "expression"): {"time": (), "factor": (), "duration": "3 s"},
    (History, "duration"): {"time": (), "factor": (), "expression": "1 - exp(-t)"},
    (Profile, "expression"): {"axis": None, "at": (), "factor": ()},
    (Guide, "fixed"): {"point": None},
    **{(Tendon, name): {"tension": None} for name in ("length", "shortening")},
    (Tendon, "stiffness"): {"tension": None, "length": "50 mm"},
    (ContactPair, "kind"): {"of": ("body", "plain")},
    (ContactPair, "adhesion"): {"of": ("body", "plain")},
    (ContactPair, "strength"): {"of": ("body", "plain"), "kind": "bonded"},
    (Object, "density"): {"motion": "free"},
    (Body, "design"): {"parts": None},
    **{(Body, name): {"parts": None, "design": INNER} for name in ("set", "mirror", "motion")},
    (Object, "mass"): {"motion": "free"},
    (Supply, "chambers"): {"chamber": None},
    (Valve, "area"): {"conductance": None},
    (FlowSupply, "pump"): {"source": None, "valve": None},
}


def forms_of(model: type[Record], field: str) -> list[Any]:
    """Values to type for one field."""
    for base in model.__mro__:
        if (base, field) in SPECIAL:
            return list(SPECIAL[base, field])
    if model is History and field in ("time", "factor"):  # as many factors as instants
        return [("0 s",), (0.0,)] if field == "time" else [(1,), (1 / 3,)]
    if model is History and field == "repeat":  # of one instant there is no cycle
        return [1]
    info = model.model_fields[field]
    return forms(Annotated[(info.annotation, *info.metadata)] if info.metadata else info.annotation)


def forms(annotation: Any) -> list[Any]:
    """Values to type where a type is asked for; the first is the plainest."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _annotated(inner[0], inner[1:])
    if origin in (Union, types.UnionType):
        return _union(inner)
    if origin is Literal:
        return list(inner)
    if origin is tuple:
        return _tuple(inner)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return []
    if isinstance(annotation, type) and issubclass(annotation, Record):
        return [base(annotation)]
    plain = {
        bool: [True, False],
        int: [1, 3, np.int64(2), "= p_number"],
        float: [0.5, 1 / 3, np.float32(0.25), "0.5", "= 1/p_number"],
        str: list(TEXTS),
        types.NoneType: [None],
    }
    return plain.get(annotation, [])


def _annotated(inner: Any, marks: tuple[Any, ...]) -> list[Any]:
    units = [mark for mark in marks if isinstance(mark, UnitOf)]
    if units:
        return _quantities(units[0])
    if any(isinstance(mark, WithJsonSchema) for mark in marks) and inner is float:
        return [f"7 {unit}" for unit in ("mm", "rad", "kPa")] + [
            UREG.Quantity(2.0, "mm"),
            0.5,
            1 / 3,
        ]
    if inner is str and any(isinstance(mark, StringConstraints) for mark in marks):
        return list(NAMES)
    least = max((m.min_length for m in marks if isinstance(m, annotated_types.MinLen)), default=0)
    values = _tuple(get_args(inner), least) if get_origin(inner) is tuple else forms(inner)
    for mark in marks:
        if isinstance(mark, annotated_types.Ge) and inner is int:
            values = [*values, mark.ge]
        if isinstance(mark, annotated_types.Le):
            values = [*values, mark.le]
    return values


def _quantities(unit: UnitOf) -> list[Any]:
    kind = KINDS[unit.kind]
    name = f"p_{unit.kind.replace(' ', '_')}"
    if not kind.units:
        found: list[Any] = [
            0.25,
            1 / 3,
            np.float64(0.25),
            np.float32(0.125),
            UREG.Quantity(0.25, ""),
        ]
        return [*found, f"= {name}/10"]
    texts = [f"3 {each}" for each in kind.units] + [f"{0.1 + 0.2} {kind.units[0]}"]
    found = [texts[0], *SIZES, *texts[1:], np.float64(0.5), f"= {name}", f"= 2*{name} - {name}/3"]
    found.append(UREG.Quantity(3.0, kind.units[0].replace("^", "**")))
    if not unit.positive:
        found += [0, "0"]
        if not unit.non_negative:
            found += [-SIZES[2], f"-3 {kind.units[0]}"]
    if unit.infinite:
        found += ["inf", "-inf", float("inf"), float("-inf"), "+inf"]
    return found


def _union(members: tuple[Any, ...]) -> list[Any]:
    if any(isinstance(m, type) and issubclass(m, Record) for m in members) and len(members) > 9:
        return [Sphere(radius=0.01), {"kind": "box", "size": ["= p_length", "1 mm", 1e-3 / 3]}]
    return [form for member in members for form in forms(member)]


def _tuple(inner: tuple[Any, ...], least: int = 1) -> list[Any]:
    if len(inner) == 2 and inner[1] is Ellipsis:
        each = forms(inner[0])
        rest = [each[0]] * (max(least, 1) - 1)
        whole = [[form, *rest] for form in each] + [(each[0],) * 3]
    else:
        columns = [forms(member) for member in inner]
        first = [column[0] for column in columns]
        whole = [tuple(first), first]
        # Formulas and infinities in each place by itself, the others plain.
        for place, column in enumerate(columns):
            for form in column[1:]:
                whole.append(tuple(form if i == place else v for i, v in enumerate(first)))
    if inner[0] in NUMBERS or get_args(inner[0])[:1] == (float,):
        whole.append(np.linspace(0.25, 0.75, len(whole[0])))
    return whole


def needs(model: type[Record]) -> dict[str, Any]:
    for each in model.__mro__:
        if each in NEEDS:
            return dict(NEEDS[each])
    extra = model.model_config.get("json_schema_extra")
    return dict(extra["examples"][0]) if isinstance(extra, dict) else {}


def base(model: type[Record], _depth: int = 0) -> dict[str, Any]:
    """The least that a record can be typed as, as a table."""
    table = {
        info.alias or name: forms_of(model, name)[0]
        for name, info in model.model_fields.items()
        if info.is_required() and name not in needs(model)
    }
    kind = {
        name: info.default
        for name, info in model.model_fields.items()
        if name in ("kind", "model") and get_origin(info.annotation) is Literal
    }
    extra = {"thickness": "1 mm"} if "form" in model.model_fields else {}
    return {**kind, **table, **needs(model), **extra}


def records(model: type[Record]) -> tuple[list[dict[str, Any]], list[str]]:
    """All forms of one record, one field varied at a time; and fields of which none was taken."""
    found, barren = [base(model)], []
    for name, info in model.model_fields.items():
        key = info.alias or name
        if any((each, name) in ELSEWHERE for each in model.__mro__):
            continue
        if get_origin(info.annotation) is Literal and len(get_args(info.annotation)) == 1:
            continue
        taken = [
            table
            for form in forms_of(model, name)
            for key_of in {key, name}
            if is_taken(model, table := _with(model, name, key_of, form))
        ]
        found += taken
        if not any(table.get(key, table.get(name)) is not None for table in taken):
            barren.append(name)
    return found, barren


def _with(model: type[Record], name: str, key: str, form: Any) -> dict[str, Any]:
    beside = next((BESIDE[b, name] for b in model.__mro__ if (b, name) in BESIDE), {})
    table = {**base(model), **beside}
    for known in {name, model.model_fields[name].alias}:
        table.pop(known, None)
    return {k: v for k, v in {**table, key: form}.items() if v is not None}


def is_taken(model: type[Record], table: dict[str, Any]) -> bool:
    """Check if a table is valid, formulas aside; an invalid one raises an error of ours."""
    try:
        model(**_values(table))
    except VoxSoftError:
        return False
    return True


def _values(value: Any) -> Any:
    """Put values in place of formulas."""
    if isinstance(value, dict):
        return {key: _values(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_values(entry) for entry in value]
    if has_formula(value):
        return 1 if value == "= p_number" else 0.3
    return value


def has_formula(value: Any) -> bool:
    if isinstance(value, dict):
        return any(map(has_formula, value.values()))
    if isinstance(value, (list, tuple)):
        return any(map(has_formula, value))
    return isinstance(value, str) and value.startswith("= ") and value != "= no formula"


def models_in(annotation: Any) -> list[type[Record]]:
    """Record types that may stand in a field, without those inside them."""
    if isinstance(annotation, type) and issubclass(annotation, Record):
        return [annotation]
    return [model for inner in get_args(annotation) for model in models_in(inner)]


def all_models() -> list[type[Record]]:
    """Every record that a design can hold, itself included."""
    found: dict[type[Record], None] = {}
    waiting: list[type[Record]] = [Design, Card]
    while waiting:
        model = waiting.pop()
        if model not in found:
            found[model] = None
            waiting += [m for f in model.model_fields.values() for m in models_in(f.annotation)]
    return list(found)
