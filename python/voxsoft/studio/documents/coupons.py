"""Tests of a material that are dropped on the page, and the models fitted to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from voxsoft.errors import MaterialError, MeasurementError
from voxsoft.files.cards import card_name
from voxsoft.materials import nominal_stress
from voxsoft.materials.coupon import (
    DEFAULT_MAX_STRAIN,
    CouponFit,
    Curve,
    Cycles,
    ModelFit,
    curve_quantities,
    fit_coupons,
    read_curve,
    read_cycles,
)
from voxsoft.studio.documents.materials import written
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.message import Entry
from voxsoft.units import UnitOf


class CouponTable(Entry):
    """A table, and the test that it is of: in tension of some mode, or with load and unload."""

    name: str
    text: str
    mode: Literal["uniaxial", "planar", "equibiaxial", "cyclic"] = "uniaxial"


class CouponRequest(Entry):
    """Tests of one material; an area and a length are asked of tables of forces and travels."""

    tables: Annotated[list[CouponTable], msgspec.Meta(min_length=1, max_length=20)]
    area: str = ""
    length: str = ""
    max_strain: str = ""


def fitted_coupons(asked: Mapping[str, Any]) -> events.CouponFit:
    """Fit all models to the tests of a request, a :class:`CouponRequest` as plain data.

    Raises
    ------
    VoxSoftError
        A table that cannot be used, a size that is none, or no model that can be fitted.
    msgspec.ValidationError
        The request has another form.
    """
    request = msgspec.convert(dict(asked), CouponRequest)
    area, length = _size(request.area, "area"), _size(request.length, "length")
    curves: list[Curve] = []
    cycles: list[Cycles] = []
    for table in request.tables:
        name, text = table.name, table.text
        _check_sizes(table, area, length)
        if table.mode == "cyclic":
            cycles.append(read_cycles(text, name=name, area=area, length=length))
        else:
            curve = read_curve(text, name=name, mode=table.mode, area=area, length=length)
            curves.append(curve)
    farthest = _size(request.max_strain, "number")
    fit = fit_coupons(curves, cycles=cycles, max_strain=farthest or DEFAULT_MAX_STRAIN)
    return _event(card_name(Path(request.tables[0].name).stem), fit)


def _check_sizes(table: CouponTable, area: float | None, length: float | None) -> None:
    """Ask for the sizes of the specimen by the words of the page."""
    named = curve_quantities(table.text, name=table.name) or ()
    if "force" in named and area is None:
        hint = "give the cross section of the specimen, such as 18 mm^2"
        raise MeasurementError(table.name, "holds forces, not stresses", hint)
    if "displacement" in named and length is None:
        hint = "give the gauge length of the specimen, such as 33 mm"
        raise MeasurementError(table.name, "holds displacements, not strains", hint)


def _size(text: str, kind: str) -> float | None:
    return UnitOf(kind, positive=True).read(text) if text.strip() else None


def _event(name: str, fit: CouponFit) -> events.CouponFit:
    return events.CouponFit(
        name=name,
        curves=[
            events.CouponCurve(
                name=curve.name,
                mode=curve.mode,
                strain=curve.strain.tolist(),
                stress=curve.stress.tolist(),
            )
            for curve in fit.curves
        ],
        models=[_model(fit, each) for each in fit.models],
        recommended=fit.recommended.name,
        rejected=[f"{model}: {why}" for model, why in fit.rejected.items()],
    )


def _model(fit: CouponFit, one: ModelFit) -> events.CouponModel:
    table, refused = {}, ""
    try:
        table = written(fit.card(one.name, one.name).material)
    except MaterialError as error:
        refused = f"{error.where} {error.what}"
    return events.CouponModel(
        name=one.name,
        size=one.size,
        error=one.rmse,
        largest=one.max_error,
        young=one.young.value,
        low=one.young.low,
        high=one.young.high,
        stresses=[_stresses(one, curve) for curve in fit.curves],
        table=table,
        refused=refused,
        warnings=_warnings(fit, one),
    )


def _stresses(one: ModelFit, curve: Curve) -> list[float]:
    found: list[float] = nominal_stress(one.material, curve.stretch, curve.mode).tolist()
    return found


def _warnings(fit: CouponFit, one: ModelFit) -> list[str]:
    soft = fit.softening(one.name)
    found: Sequence[str] = fit.summary(one.name)["warnings"]
    return [*found, *(() if soft is None else soft.warnings)]
