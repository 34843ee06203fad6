"""Tables of testing machines: accepted forms, refused ones, and messages."""

from pathlib import Path

import numpy as np
import pytest

from voxsoft.errors import MeasurementError
from voxsoft.instruments import Column, Measured
from voxsoft.materials.coupon import Curve, fit_coupons, read_curve, read_timed_test

DATA = Path(__file__).parents[3] / "examples" / "data" / "tensile"
STRAINS = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
STRESSES = [0.0, 5e3, 9e3, 12e3, 15e3, 18e3]


def table(heads, columns, separator=","):
    rows = zip(*columns, strict=True)
    lines = (separator.join(str(v) for v in row) for row in rows)
    return "\n".join([separator.join(heads), *lines]) + "\n"


def scaled(values, factor):
    return [value * factor for value in values]


@pytest.mark.parametrize(
    ("heads", "strains", "stresses"),
    [
        (["strain", "stress_Pa"], STRAINS, STRESSES),
        (["eng_strain", "eng_stress_Pa"], STRAINS, STRESSES),
        (["Strain (%)", "Stress [MPa]"], scaled(STRAINS, 100), scaled(STRESSES, 1e-6)),
        (["strain_percent", "stress_kpa"], scaled(STRAINS, 100), scaled(STRESSES, 1e-3)),
        (["stretch", "Engineering Stress (Mpa)"], [1 + e for e in STRAINS], scaled(STRESSES, 1e-6)),
        (["Extension (mm)", "Load (N)"], scaled(STRAINS, 33), scaled(STRESSES, 18e-6)),
        (["displacement_m", "force_mN"], scaled(STRAINS, 0.033), scaled(STRESSES, 18e-3)),
        (["strain [mm/mm]", "stress (N/mm^2)"], STRAINS, scaled(STRESSES, 1e-6)),
        (["Dehnung [%]", "Spannung [MPa]"], scaled(STRAINS, 100), scaled(STRESSES, 1e-6)),
        (["Weg (mm)", "Kraft (N)"], scaled(STRAINS, 33), scaled(STRESSES, 18e-6)),
        (["Standardweg_mm", "Standardkraft_N"], scaled(STRAINS, 33), scaled(STRESSES, 18e-6)),
        (
            ["Standard travel (mm)", "Standard force (N)"],
            scaled(STRAINS, 33),
            scaled(STRESSES, 18e-6),
        ),
        (["Verlängerung (mm)", "Stress (Pa)"], scaled(STRAINS, 33), STRESSES),
    ],
)
def test_names_and_units_are_understood(heads, strains, stresses):
    curve = read_curve(table(heads, [strains, stresses]), area=18e-6, length=33e-3)
    # Rounding error of float division.
    np.testing.assert_allclose(curve.strain, STRAINS, atol=1e-12)
    np.testing.assert_allclose(curve.stress, STRESSES, rtol=1e-12)


def test_decimal_commas_unit_rows_and_other_columns():
    text = "Probe 7\n\nTime;Strain;Stress\n(s);(%);(kPa)\n" + "".join(
        f"0,{i};{i},5;{2 * i},25\n" for i in range(6)
    )
    curve = read_curve(text)
    np.testing.assert_allclose(curve.strain, [(i + 0.5) / 100 for i in range(6)])
    np.testing.assert_allclose(curve.stress, [2e3 * i + 250 for i in range(6)])


def test_the_line_above_the_numbers_is_named_where_no_header_is_known():
    text = "Sample;Ecoflex batch 7\nTemperatur;23\n\nAllongement;Contrainte\n(%);(kPa)\n0;0\n1;2\n"
    with pytest.raises(MeasurementError, match='no column of stress among "Allongement", "Contr'):
        read_curve(text)


def test_a_preamble_without_separators_hides_no_commas():
    text = "Batch 7\n\nstrain,stress_Pa\n" + "".join(f"0.{i},{i}\n" for i in range(6))
    np.testing.assert_array_equal(read_curve(text).stress, range(6))


def test_a_preamble_above_german_columns_is_passed_over():
    text = "Sample;Ecoflex batch 7\n\nZeit;Weg;Kraft\ns;mm;N\n" + "".join(
        f"{i};{3.3 * i:.1f};{1.8 * i:.1f}\n".replace(".", ",") for i in range(6)
    )
    curve = read_curve(text, area=18e-6, length=33e-3)
    np.testing.assert_allclose(curve.strain, [0.1 * i for i in range(6)], atol=1e-12)
    np.testing.assert_allclose(curve.stress, [1e5 * i for i in range(6)])


def test_the_database_s_own_form():
    text = (DATA / "rtv615.csv").read_text(encoding="utf-8")
    curve = read_curve(text)
    assert len(curve.strain) == 43
    assert curve.strain[0] == pytest.approx(0.0445966666666667)
    assert curve.stress[-1] == pytest.approx(0.800973333333333e6)


def test_points_after_the_break_are_left_out():
    curve = read_curve(table(["strain", "stress_Pa"], [[*STRAINS, 0.51], [*STRESSES, 100.0]]))
    assert len(curve.strain) == len(STRAINS)
    assert curve.elongation_at_break == 0.5


@pytest.mark.parametrize(
    ("heads", "words"),
    [
        (
            ["time", "voltage"],
            'no column of strain and no column of stress among "time", "voltage"',
        ),
        (["strain", "voltage"], 'no column of stress among "strain", "voltage"'),
        (["strain", "stress"], "has no unit"),
        (["strain", "stress_mm"], "expected a pressure"),
        (["strain", "stress_blah"], 'no unit "blah"'),
        (["strain_mm", "stress_kPa"], "no unit of strain"),
        (["strain", "force_N"], "--area"),
        (["displacement_mm", "stress_kPa"], "--length"),
        (["displacement", "stress_kPa"], "--length|has no unit"),
        (["true_strain", "true_stress_kPa"], "expected engineering quantities"),
    ],
)
def test_wrong_columns_are_reported_in_words(heads, words):
    with pytest.raises(MeasurementError, match=words):
        read_curve(table(heads, [STRAINS, STRESSES]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("\n\n", "is empty"),
        ("a\0b", "is not a text file"),
        ("strain,stress_kPa\n", "has 0 points"),
        ("strain,stress_kPa\n0,0\n1,x\n", "line 3.*not a number"),
        ("strain,stress_kPa\n0,0\n1\n", "line 3.*not a number"),
        (table(["strain", "strain", "stress_kPa"], [STRAINS, STRAINS, STRESSES]), "both a strain"),
        (table(["strain", "stress_kPa"], [[0, 50, 100, 150, 200], [0, 1, 2, 3, 4]]), "percent"),
        (table(["strain", "stress_kPa"], [[0, 1, 2, 1, 0, 1], [0, 1, 2, 1, 0, 1]]), "a cycle"),
        (table(["strain", "stress_kPa"], [[0, 1, 2, 3, 4], [0, 1, "nan", 1, 2]]), "not finite"),
        (table(["strain", "stress_kPa"], [[0, -1, -2, -3, -4], [0, 1, 2, 1, 2]]), "zero or less"),
    ],
)
def test_bad_tables_are_reported_in_words(text, words):
    with pytest.raises(MeasurementError, match=words):
        read_curve(text)


def test_a_toe_is_found_and_taken_off():
    """Slack of 2 % before a neo-Hookean coupon of E = 60 kPa, seen from 5 % on."""
    strain = np.linspace(0.05, 1.0, 60)
    taut = 1.0 + strain - 0.02
    curve = Curve(strain, 20e3 * (taut - taut**-2))
    toe = curve.toe()
    # The line is drawn in the measure of the shifted stretch, which bends it: 5 % of the toe.
    assert toe.strain == pytest.approx(0.02, rel=0.06)
    assert toe.offset == pytest.approx(-toe.young * toe.strain)
    corrected = curve.corrected("strain")
    assert abs(corrected.toe().strain) < 0.1 * toe.strain
    np.testing.assert_array_equal(curve.corrected("off").strain, curve.strain)
    np.testing.assert_allclose(curve.corrected("stress").stress, curve.stress - toe.offset)


def test_an_offset_of_the_load_cell_is_found():
    strain = np.linspace(0.0, 1.0, 60)
    stretch = 1.0 + strain
    for mode, stress in (
        ("uniaxial", stretch - stretch**-2),
        ("equibiaxial", stretch - stretch**-5),
        ("planar", stretch - stretch**-3),
    ):
        toe = Curve(strain, 20e3 * stress + 3e3, mode).toe()
        # Exact: this is the line that is fitted.
        assert toe.offset == pytest.approx(3e3)
        assert toe.young == pytest.approx(60e3)


def test_the_uncertainty_of_a_toe_is_its_scatter_over_specimens():
    strain = np.linspace(0.01, 1.0, 60)
    stretch = 1.0 + strain
    toes = [
        Curve(strain, 20e3 * (stretch - stretch**-2) + 200.0 * noise).toe()
        for noise in np.random.default_rng(5).standard_normal((200, 60))
    ]
    # 200 specimens know their standard deviation to 5 %; three times that.
    scatter = np.std([toe.strain for toe in toes])
    assert np.mean([toe.uncertainty for toe in toes]) == pytest.approx(scatter, rel=0.15)


def test_few_points_at_the_start_tell_no_toe():
    assert Curve(np.linspace(0.2, 3.0, 20), np.linspace(5e3, 60e3, 20)).toe() is None


@pytest.mark.parametrize(
    ("strain", "sign", "words"),
    [
        ((0.0, 1.0), -1.0, "stress is negative while strain grows to 1"),
        ((-0.3, 0.0), -1.0, "stress is positive while strain falls to -0.3"),
        ((-0.3, 1.0), -1.0, "while strain grows to 1"),
    ],
)
def test_a_stress_of_the_wrong_sign_is_refused(strain, sign, words):
    """A card of it would be a rubber that pushes where it should pull."""
    stretch = 1.0 + np.linspace(*strain, 30)
    stress = 20e3 * (stretch - stretch**-2)
    with pytest.raises(MeasurementError, match=words + r".*turn the sign"):
        Curve(stretch - 1.0, sign * stress)
    # A load cell whose zero is off by more than all of the curve says nothing of its sign.
    Curve(stretch - 1.0, stress - 1e6)


def neo_hookean(strains):
    """Engineering stress of shear modulus 20 kPa in Pa."""
    stretch = 1.0 + np.asarray(strains)
    return 20e3 * (stretch - stretch**-2)


@pytest.mark.parametrize("backward", [False, True])
def test_compression_with_negative_numbers_is_a_curve(backward):
    strain = np.linspace(0.0, -0.4, 9)[:: -1 if backward else 1]
    text = table(["strain", "stress_Pa"], [strain, neo_hookean(strain)])
    curve = read_curve(text)
    np.testing.assert_array_equal(curve.strain, strain)
    assert fit_coupons([curve], toe="off").of("neo-hookean").constants["c10"].value == (
        pytest.approx(10e3)
    )
    with pytest.raises(MeasurementError, match="the strain rises: a cycle"):
        read_curve(table(["strain", "stress_Pa"], [[0, -0.1, -0.2, -0.1, 0.0, -0.3], STRESSES]))


@pytest.mark.parametrize("sign", [1, -1])
def test_columns_of_compression_are_negative_whichever_way_the_machine_counts(sign):
    strain = np.linspace(0.0, -0.4, 9)
    rows = [10 * sign * np.abs(strain), 1e-4 * sign * np.abs(neo_hookean(strain))]
    text = table(["Compressive extension (mm)", "Compressive load (N)"], rows)
    curve = read_curve(text, area="100 mm^2", length="10 mm")
    np.testing.assert_allclose(curve.strain, strain, atol=1e-15)
    np.testing.assert_allclose(curve.stress, neo_hookean(strain), rtol=1e-12)


def test_an_export_of_zwickroell_is_read():
    """Quoted cells, semicolons, commas, a row of units, and the crosshead beside the travel."""
    rows = "".join(
        f'"{i / 10:.1f}";"{1.8 * i:.2f}";"{3.3 * i:.1f}";"{9.9 * i:.1f}"\n'.replace(".", ",")
        for i in range(6)
    )
    heads = '"Prüfzeit";"Standardkraft";"Standardweg";"Traversenweg"\n"s";"N";"mm";"mm"\n'
    curve = read_curve(
        '"Prüfprotokoll";"Zug"\n"Datum";"12.5.2026"\n\n' + heads + rows, area=18e-6, length=33e-3
    )
    np.testing.assert_allclose(curve.strain, [0.1 * i for i in range(6)], atol=1e-12)
    np.testing.assert_allclose(curve.stress, [1e5 * i for i in range(6)])


def test_an_export_of_shimadzu_is_read_with_commas_of_thousands():
    rows = "".join(f'"{i / 10}","{300.5 * i:,.1f}","{i}.0"\n' for i in range(6))
    assert '"1,202.0"' in rows
    head = '"Key word","","Product Name"\n"1 _ 1"\n"Time","Force","Stroke"\n"sec","N","mm"\n'
    curve = read_curve(head + rows, area="1 m^2", length="10 mm")
    np.testing.assert_allclose(curve.stress, [300.5 * i for i in range(6)], rtol=1e-12)


@pytest.mark.parametrize(("unit", "factor"), [("mm/m", 1e-3), ("µε", 1e-6), ("‰", 1e-3)])
def test_small_strains_have_their_units(unit, factor):
    text = table([f"Strain ({unit})", "Stress (kPa)"], [range(6), range(6)])
    np.testing.assert_allclose(read_curve(text).strain, factor * np.arange(6), rtol=1e-12)


def test_decimal_commas_between_commas_are_no_further_columns():
    """Half of each number would be read, silently."""
    text = "strain,stress_kPa\n" + "".join(f"0,{i},1,{i}\n" for i in range(6))
    with pytest.raises(MeasurementError, match="line 2: has 4 cells; there are 2 columns"):
        read_curve(text)


def test_a_comma_that_may_be_either_is_refused():
    text = "strain (%),stress_Pa\n" + "".join(f'{i},"{i},500"\n' for i in range(1, 7))
    with pytest.raises(MeasurementError, match=r'"1,500" may be 1500 or 1\.500'):
        read_curve(text)
    assert read_curve(text.replace('"1,500"', '"0,500"')).stress[0] == 0.5
    assert read_curve(text.replace("1,", "1.5,", 1)).stress[0] == 1500.0


def test_two_kinds_of_decimals_in_one_table_are_refused():
    text = "strain;stress_kPa\n0.5;1,5\n" + "".join(f"{i};{i}\n" for i in range(1, 6))
    with pytest.raises(MeasurementError, match=r"decimal comma and .* a decimal point"):
        read_curve(text)


def test_a_curve_comes_from_measured_data_of_one_clock():
    times = np.arange(6) / 10
    travel = Column("Cell/Extension", "mm", [33 * e for e in STRAINS], times)
    force = Column("Cell/Force", "N", [18e-6 * s for s in STRESSES], times)
    lamp = Column("Cell/lamp", "V", np.ones(6), times)
    curve = read_curve(Measured("a.tdms", (travel, force, lamp)), area=18e-6, length=33e-3)
    np.testing.assert_allclose(curve.strain, STRAINS, atol=1e-12)
    np.testing.assert_allclose(curve.stress, STRESSES, rtol=1e-12)
    held = Column("Strain", "%", [0, 50, 50, 50, 50, 50, 50], np.arange(7.0))
    stress = Column("Stress", "kPa", [0, 20, 15, 13, 12, 12, 12], np.arange(7.0))
    test = read_timed_test(Measured("b.mat", (held, stress)), kind="relaxation")
    # Held from 1 s to 6 s.
    assert (test.duration, float(test.stress[1])) == (5.0, 20e3)
    late = Column("Cell/Force", "N", force.numbers, times + 0.05)
    with pytest.raises(MeasurementError, match=r"different times.*resampled\(rate\)"):
        read_curve(Measured("a.tdms", (travel, late)), area=18e-6, length=33e-3)
    with pytest.raises(MeasurementError, match='no column of stress among "Cell/Extension"'):
        read_curve(Measured("a.tdms", (travel, lamp)), area=18e-6, length=33e-3)


def test_gaps_of_measured_data_are_no_points_of_a_curve():
    strain = Column("strain", "", [*STRAINS, np.nan])
    stress = Column("stress", "Pa", [*STRESSES, 1.0])
    assert len(read_curve(Measured("a.mat", (strain, stress))).strain) == len(STRAINS)
