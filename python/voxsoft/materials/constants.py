"""Single constants of a material by name, and changed copies of the material."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from voxsoft.errors import MaterialError
from voxsoft.materials.hyperelastic import Hyperelastic
from voxsoft.materials.model import Material
from voxsoft.records import closest

#: Constants with the unit of stress, by the name of their field; ``young`` scales them all.
_MODULI: Final = ("edge", "bulk", "young", "c10", "c01", "c", "mu", "shear")
_NUMBERS: Final = ("poisson", "alpha", "jm")


def constants_of(material: Material) -> dict[str, str]:
    """Return the names of the constants of a material, each with its kind of quantity.

    Entries of lists have their index after a dot, ``mu.0``. Every hyperelastic model has ``young``,
    which scales all its moduli at once and leaves the shape of its curve.

    Parameters
    ----------
    material
        Any model.

    Examples
    --------
    >>> from voxsoft.materials import Ogden
    >>> constants_of(Ogden(mu=["20 kPa"], alpha=[2.0]))
    {'young': 'modulus', 'mu.0': 'modulus', 'poisson': 'number', 'alpha.0': 'number'}
    """
    found = {"young": "modulus"} if isinstance(material, Hyperelastic) else {}
    fields = _fields(material)
    for name in (*_MODULI, *_NUMBERS):
        if name not in fields:
            continue
        kind = "modulus" if name in _MODULI else "number"
        value = fields[name]
        if isinstance(value, tuple):
            found |= {f"{name}.{index}": kind for index in range(len(value))}
        else:
            found[name] = kind
    return found


def constant_of(material: Material, name: str) -> float:
    """Return one constant of a material in SI units, by a name of :func:`constants_of`.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> constant_of(NeoHookean(young="60 kPa"), "young")
    60000.0
    """
    if name == "young" and isinstance(material, Hyperelastic):
        return material.young()
    stem, _, index = name.partition(".")
    value = _fields(material)[stem]
    return float(value[int(index)] if index else value)


def with_constants(material: Material, constants: Mapping[str, float]) -> Material:
    """Return the material with other values of some of its constants.

    Parameters
    ----------
    material
        Material with the other constants.
    constants
        New values in SI units, by a name of :func:`constants_of`. ``young`` is applied last.

    Raises
    ------
    MaterialError
        An unknown name, impossible values, or ``young`` beside another modulus of a model that has
        several.

    Examples
    --------
    >>> from voxsoft.materials import Ogden
    >>> soft = Ogden(mu=["20 kPa", "5 kPa"], alpha=[1.7, -3.4])
    >>> stiffer = with_constants(soft, {"young": 2 * soft.young()})
    >>> stiffer.mu, stiffer.alpha
    ((40000.0, 10000.0), (1.7, -3.4))
    """
    known = constants_of(material)
    fields = _fields(material)
    for name, value in constants.items():
        if name not in known:
            what = f'is not a constant of "{material.model}"'
            raise MaterialError(name, what, closest(name, known))
        stem, _, index = name.partition(".")
        if index:
            entries = list(fields[stem])
            entries[int(index)] = value
            fields[stem] = tuple(entries)
        elif name in fields:
            fields[name] = value
    changed = type(material)(**fields)
    if "young" not in constants or "young" in fields:
        return changed
    others = [name for name in constants if known[name] == "modulus" and name != "young"]
    if others:
        raise MaterialError(
            "young", f"scales all moduli, {others[0]} among them", "name one or the other"
        )
    assert isinstance(changed, Hyperelastic)  # the others have no such name
    factor = constants["young"] / changed.young()
    scaled = {
        name: _times(value, factor) if name in _MODULI else value for name, value in fields.items()
    }
    return type(material)(**scaled)


def _fields(material: Material) -> dict[str, Any]:
    """Return field values by the names that a user writes."""
    return {
        info.alias or field: getattr(material, field)
        for field, info in type(material).model_fields.items()
    }


def _times(value: Any, factor: float) -> Any:  # noqa: ANN401 - a modulus or a tuple of them
    if isinstance(value, tuple):
        return tuple(factor * each for each in value)
    return factor * value
