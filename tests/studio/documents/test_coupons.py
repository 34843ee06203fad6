"""Tests of a material that are dropped on the page."""

from pathlib import Path

import msgspec
import pytest

from voxsoft.design import Design, families
from voxsoft.errors import MeasurementError
from voxsoft.studio.documents.coupons import fitted_coupons
from voxsoft.studio.documents.tables import table_uses

DATA = Path(__file__).parents[3] / "examples" / "data"


def table(name, **changes):
    text = (DATA / "tensile" / f"{name}.csv").read_text()
    return {"name": f"{name}.csv", "text": text, **changes}


@pytest.mark.parametrize(
    ("file", "uses"),
    [
        ("tensile/dragon-skin-10.csv", ["coupon"]),
        ("tensile/rtv615.csv", ["coupon"]),
        ("paper_beams/ecoflex-00-30.csv", ["stations"]),
        ("epfl_bender/angle.csv", ["curve", "stations"]),
        ("pneunet/calculix.csv", ["curve", "stations"]),
    ],
)
def test_tables_are_distinguished_by_their_columns(file, uses):
    assert table_uses(file, (DATA / file).read_text()).uses == uses


def test_a_fit_has_a_curve_through_the_points_and_a_table_for_designs():
    fit = fitted_coupons({"tables": [table("ecoflex-00-30")]})
    assert fit.name == "ecoflex-00-30"
    [curve] = fit.curves
    best = next(each for each in fit.models if each.name == fit.recommended)
    assert len(best.stresses[0]) == len(curve.strain)
    assert best.error < 0.1 * max(curve.stress)
    assert best.low < best.young < best.high
    document = families.beam().document
    document["materials"] = {"mine": best.table}
    document["parts"][0]["material"] = "mine"
    material = Design.from_document(document).materials["mine"]
    assert material.young() == pytest.approx(best.young, rel=1e-4)


def test_forces_need_the_specimen():
    rows = "".join(f"\n{3 * i},{0.3 * i}" for i in range(12))
    asked = {"tables": [{"name": "m.csv", "text": "displacement_mm,force_N" + rows}]}
    with pytest.raises(MeasurementError, match="cross section"):
        fitted_coupons(asked)
    with pytest.raises(MeasurementError, match="gauge length"):
        fitted_coupons(asked | {"area": "18 mm^2"})
    sized = asked | {"area": "18 mm^2", "length": "33 mm"}
    assert fitted_coupons(sized).curves[0].strain[-1] == pytest.approx(1.0, abs=0.05)


def test_a_request_of_another_form_is_refused():
    with pytest.raises(msgspec.ValidationError):
        fitted_coupons({"tables": []})
