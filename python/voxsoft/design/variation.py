"""Single numbers of a design by name, and the same design with one of them changed a little.

A derivative needs designs whose numbers differ by millionths, to the last bit; neither a file's 12
digits nor the bounds of a parameter may touch them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from voxsoft.design.model import Design
from voxsoft.design.parameter import Parameter
from voxsoft.design.part import Part
from voxsoft.errors import DesignError, VoxSoftError
from voxsoft.records import Record, closest, steps_of

#: Entries closed to changes: those outside the mechanics, and parameters, which have names.
_OTHERS = frozenset(
    {"schema", "name", "description", "parameters", "objectives", "constraints", "solver"}
)


def number_of(design: Design, name: str) -> float:
    """Return one number of a design, in SI units.

    Parameters
    ----------
    design
        The design.
    name
        A parameter, or the path of a number as ``--set`` writes it: ``loads.0.value``,
        ``parts[0].material.young``, ``materials.soft.mu.1``.

    Raises
    ------
    DesignError
        There is no such number, or it is a whole number or no number at all.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> cylinder = families.cylinder()
    >>> number_of(cylinder, "radius"), number_of(cylinder, "loads.0.value")
    (0.03, 6000.0)
    >>> number_of(cylinder, "loads.0.valve")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: loads.0.valve: there is no "valve". Try: did you mean "value"?
    """
    if name in design.parameters:
        return design.parameters[name].value
    node: Any = design
    for step in _path(design, name):
        node = _child(design, node, step, name)
    if isinstance(node, bool) or not isinstance(node, float):
        what = "is a whole number" if isinstance(node, int) else "is not a number"
        raise DesignError(name, f"{what}, which has no derivative", "name a quantity")
    return node


def with_number(design: Design, name: str, value: float) -> Design:
    """Return the design with another value of one number, bounds of parameters aside.

    Parameters
    ----------
    design
        The design; it is not changed.
    name
        See :func:`number_of`.
    value
        In SI units, exact to the last bit.

    Raises
    ------
    DesignError
        There is no such number, or the design is not valid with that value.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> stiffer = with_number(families.cylinder(), "loads.0.value", 5e3)
    >>> stiffer.loads[0].value
    5000.0
    >>> wider = with_number(families.cylinder(), "radius", 0.0403)
    >>> wider.shapes["outer"].radius, families.cylinder().parameters["radius"].max
    (0.0403, 0.04)
    """
    if name in design.parameters:
        return _with_parameter(design, name, value)
    changed: Design = _with(design, design, _path(design, name), value, name)
    return changed


def _with_parameter(design: Design, name: str, value: float) -> Design:
    free = Parameter(value=value, kind=design.parameters[name].kind)
    return design.replace(parameters={**design.parameters, name: free})


def _path(design: Design, name: str) -> list[str]:
    path = [str(step) for step in steps_of(name)]
    if path[0] in _OTHERS or path[0] not in _fields(design) or len(path) < 2:
        known = [*design.parameters]
        hint = closest(name, known) if known else ""
        raise DesignError(
            name,
            "is neither a parameter of this design nor the path of a number",
            hint if "did" in hint else 'name a parameter, or write a path such as "loads.0.value"',
        )
    return path


def _child(design: Design, node: Any, step: str, name: str) -> Any:  # noqa: ANN401
    if isinstance(node, Part) and step == "material":
        return design.material_of(node)
    if isinstance(node, Record):
        fields = _fields(node)
        if step in fields:
            return getattr(node, fields[step])
        raise DesignError(name, f'there is no "{step}"', closest(step, fields))
    if isinstance(node, Mapping):
        if step in node:
            return node[step]
        raise DesignError(name, f'there is no "{step}"', closest(step, map(str, node)))
    if isinstance(node, tuple) and step.isdigit() and int(step) < len(node):
        return node[int(step)]
    raise DesignError(name, f'there is no "{step}"', "entries of a list count from 0")


def _with(design: Design, node: Any, path: list[str], value: float, name: str) -> Any:  # noqa: ANN401
    """Rebuild everything from a node down to the number, each record checked anew."""
    if not path:
        return value
    step = path[0]
    child = _with(design, _child(design, node, step, name), path[1:], value, name)
    if isinstance(node, Design):
        return node.replace(**{step: child})
    if isinstance(node, Record):
        held = {key: getattr(node, field) for key, field in _fields(node).items()}
        try:
            return type(node)(**{**held, step: child})
        except VoxSoftError as error:
            raise DesignError(name, f"cannot be {value!r}: {error}") from None
    if isinstance(node, Mapping):
        return {**node, step: child}
    return tuple(child if index == int(step) else old for index, old in enumerate(node))


def _fields(record: Record) -> dict[str, str]:
    """Map the names that a user writes to those of the attributes."""
    return {info.alias or field: field for field, info in type(record).model_fields.items()}
