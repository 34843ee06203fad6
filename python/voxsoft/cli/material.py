"""``voxsoft material``: constants from coupon tests, and the cards there are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer

from voxsoft._folders import folder_name
from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import Json
from voxsoft.cli.output import plain, print_json, quantity, say, show_table

if TYPE_CHECKING:
    from voxsoft.materials import Card, Material, Mode
    from voxsoft.materials.coupon import (
        BranchFit,
        CouponFit,
        Curve,
        Interval,
        TestKind,
        TimedTest,
        ToeCorrection,
    )

material = typer.Typer(
    name="material",
    help="Fit a material to coupon tests; list and show material cards.",
    no_args_is_help=True,
)

# The voxel size at which raw compliances, which belong to one, are shown as moduli.
_VOXEL_SIZE = 5e-3

_Files = Annotated[
    list[Path] | None,
    typer.Argument(
        help="Uniaxial stress-strain curves (CSV).", exists=True, dir_okay=False, metavar="CSV..."
    ),
]


def _curves(option: str, what: str) -> Any:  # noqa: ANN401 - the type that typer returns
    return typer.Option(option, help=what, exists=True, dir_okay=False, metavar="FILE")


@material.command()
def fit(
    tensile: _Files = None,
    planar: Annotated[
        list[Path] | None, _curves("--planar", "Curve of planar tension (pure shear). Repeatable.")
    ] = None,
    equibiaxial: Annotated[
        list[Path] | None, _curves("--equibiaxial", "Curve of equibiaxial tension. Repeatable.")
    ] = None,
    cyclic: Annotated[
        list[Path] | None,
        _curves("--cyclic", "Uniaxial test with load and unload, for softening. Repeatable."),
    ] = None,
    modulus: Annotated[
        list[Path] | None,
        _curves("--modulus", "Bending, frequency or known moduli (TOML). Repeatable."),
    ] = None,
    relaxation: Annotated[
        list[Path] | None,
        _curves("--relaxation", "Uniaxial test over time, at a strain that is held. Repeatable."),
    ] = None,
    rate: Annotated[
        list[Path] | None,
        _curves("--rate", "Uniaxial test over time, at one strain rate. Repeatable."),
    ] = None,
    branches: Annotated[
        int | None,
        typer.Option("--branches", help="Number of branches, 1 to 4; default: as many as show."),
    ] = None,
    model: Annotated[
        str | None, typer.Option("--model", help="Model of the card; default: the recommended one.")
    ] = None,
    max_strain: Annotated[
        str, typer.Option("--max-strain", help="Largest strain that counts: 1.5 or '150 %'.")
    ] = "3",
    toe: Annotated[
        str,
        typer.Option(
            "--toe", help="Stress at zero strain: slack (strain), load cell (stress) or leave (off)"
        ),
    ] = "strain",
    area: Annotated[
        str | None, typer.Option("--area", help="Original cross section, for forces: '18 mm^2'.")
    ] = None,
    length: Annotated[
        str | None, typer.Option("--length", help="Gauge length, for displacements: '33 mm'.")
    ] = None,
    poisson: Annotated[float, typer.Option("--poisson", help="Poisson's ratio of the card.")] = (
        0.499
    ),
    density: Annotated[str, typer.Option("--density", help="Density of the card.")] = "1070 kg/m^3",
    name: Annotated[
        str | None, typer.Option("--name", help="Name of the card; default: the first file's.")
    ] = None,
    source: Annotated[
        str, typer.Option("--source", help="Source of the data: who, when, license.")
    ] = "",
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder; default: runs/NAME-material.")
    ] = None,
    json: Json = False,
) -> None:
    """Fit all hyperelastic models to coupon tests, rank them, and write a card with a picture.

    Tests over time (--relaxation, --rate) give the branches by which the material relaxes, too.
    """
    from voxsoft.files.cards import card_name
    from voxsoft.files.coupons import (
        load_curve,
        load_cycles,
        load_modulus_tests,
        load_timed_test,
        write_branch_fit,
        write_coupon_fit,
    )
    from voxsoft.materials import NeoHookean
    from voxsoft.materials.coupon import fit_branches, fit_coupons
    from voxsoft.units import UnitOf

    with errors_in_words(json=json):
        # The checks of the card's own constants, before any work.
        rest = NeoHookean(young_modulus=1.0, poisson=poisson, density=cast("float", density))
        section = None if area is None else UnitOf("area", positive=True).read(area)
        gauge = None if length is None else UnitOf("length", positive=True).read(length)
        farthest = UnitOf("number", positive=True).read(max_strain)
        files = [("uniaxial", tensile), ("planar", planar), ("equibiaxial", equibiaxial)]
        curves: list[Curve] = [
            load_curve(path, mode=cast("Mode", mode), area=section, length=gauge)
            for mode, paths in files
            for path in paths or []
        ]
        timed: list[TimedTest] = [
            load_timed_test(path, kind=cast("TestKind", kind), area=section, length=gauge)
            for kind, paths in (("relaxation", relaxation), ("rate", rate))
            for path in paths or []
        ]
        _refuse_beside_time(timed, cyclic, modulus, branches)
        if timed:
            over_time = fit_branches(
                timed,
                curves,
                branches=branches,
                model=model,
                toe=cast("ToeCorrection", toe),
                max_strain=farthest,
                poisson=rest.poisson,
                density=rest.density,
            )
            chosen = name or card_name(Path(timed[0].name).stem)
            card = over_time.card(chosen, source=source)
            folder = out or Path("runs") / f"{folder_name(chosen, 'card')}-material"
            written = write_branch_fit(over_time, card, folder)
            if json:
                print_json(over_time.summary() | {"card": str(written[0]), "folder": str(folder)})
            else:
                _show_branches(over_time)
                say(f"wrote {plain(str(folder))}: {', '.join(file.name for file in written)}")
            return
        observed = [seen for path in modulus or [] for seen in load_modulus_tests(path)]
        cycles = [load_cycles(path, area=section, length=gauge) for path in cyclic or []]
        answer = fit_coupons(
            curves,
            observed,
            cycles=cycles,
            toe=cast("ToeCorrection", toe),
            max_strain=farthest,
            poisson=rest.poisson,
            density=rest.density,
        )
        chosen = name or card_name(Path(answer.curves[0].name).stem)
        card = answer.card(chosen, model, source=source)
        folder = out or Path("runs") / f"{folder_name(chosen, 'card')}-material"
        written = write_coupon_fit(answer, card, folder)
        if json:
            print_json(
                answer.summary(str(card.calibration["model"]))
                | {"card": str(written[0]), "folder": str(folder)}
            )
        else:
            _show_fit(answer, str(card.calibration["model"]))
            say(f"wrote {plain(str(folder))}: {', '.join(file.name for file in written)}")


@material.command("list")
def list_cards(json: Json = False) -> None:
    """List the material cards that come with VoxSoft."""
    from voxsoft.materials import card_names, load_card

    cards = [load_card(name) for name in card_names()]
    if json:
        print_json({"cards": [_summary(card) for card in cards]})
        return
    stood_for = [card.same_as for card in cards]
    rows = [_row(card) for card in cards if card.name not in stood_for]
    columns = ["card", "model", "initial E", "break", "stands for"]
    show_table("Materials", columns, rows)
    say("voxsoft material show CARD says where the numbers come from")


@material.command()
def show(
    card: Annotated[str, typer.Argument(help="Name of a card, or a card file (TOML).")],
    json: Json = False,
) -> None:
    """Show a material card: constants, their source, and cautions."""
    from voxsoft.files.cards import card_text, load_card_file
    from voxsoft.materials import Hyperelastic, card_names, load_card, stable_ranges

    with errors_in_words(json=json):
        is_file = card not in card_names() and (card.endswith(".toml") or Path(card).is_file())
        found = load_card_file(card) if is_file else load_card(card)
        if json:
            print_json(_summary(found) | {"calibration": found.calibration})
            return
        young, poisson = _moduli(found.material)
        say(plain(card_text(found)))
        say(f"Young's modulus {quantity(young, 'modulus')}, Poisson's ratio {poisson:.4g}")
        if isinstance(found.material, Hyperelastic):
            for stable in stable_ranges(found.material):
                low, high = stable.scanned
                everywhere = f"{stable.mode}: stable from stretch {low:g} to {high:g}"
                say(plain(stable.sentence or everywhere))


def _show_fit(answer: CouponFit, chosen: str) -> None:
    for curve, raw, toe in zip(answer.curves, answer.measured, answer.toes, strict=True):
        line = f"{curve.name}: {curve.mode}, {len(curve.strain)} of {len(raw.strain)} points"
        if toe is not None:
            line += f", toe ({100.0 * toe.strain:.2f} ± {100.0 * toe.uncertainty:.2f}) % strain"
            line += f" or load-cell offset {_kpa(toe.offset)}"
        say(plain(line))
    rows = [
        [
            f"{found.name} *" if found.name == chosen else found.name,
            str(found.size),
            _kpa(found.cv_rmse),
            _kpa(found.rmse),
            _with_interval(found.young),
            "yes" if found.stable_in_fit else "no",
        ]
        for found in answer.models
    ]
    columns = ["model", "size", "CV error", "error", "initial E (95 %)", "stable"]
    show_table("Models, best prediction first (* on the card)", columns, rows)
    constants = answer.of(chosen).constants
    show_table(
        f"Constants of {chosen}",
        ["name", "value", "95 % interval"],
        [
            [
                name,
                _constant(name, i.value),
                f"{_constant(name, i.low)} to {_constant(name, i.high)}",
            ]
            for name, i in constants.items()
        ],
    )
    soft = answer.softening(chosen)
    if soft is not None:
        show_table(
            f"Softening, with an error of {_kpa(soft.rmse)}",
            ["name", "value", "95 % interval"],
            [
                [
                    name,
                    _softening(name, i.value),
                    f"{_softening(name, i.low)} to {_softening(name, i.high)}",
                ]
                for name, i in soft.constants.items()
            ],
        )
    for name, why in answer.rejected.items():
        say(f"{name}: {plain(why)}")
    softening = [] if soft is None else list(soft.warnings)
    for warning in answer.summary(chosen)["warnings"] + softening:
        say(f"[yellow]warning:[/yellow] {plain(warning)}")


def _refuse_beside_time(
    timed: list[TimedTest],
    cyclic: list[Path] | None,
    modulus: list[Path] | None,
    branches: int | None,
) -> None:
    """Refuse options that have no meaning beside tests over time, or without them."""
    from voxsoft.errors import MeasurementError

    if timed and cyclic:
        raise MeasurementError(
            "--cyclic",
            "beside a test over time: a way back shows softening and relaxation in one",
            "fit the cycles alone, and write mullins into the table of the other card",
        )
    if timed and modulus:
        raise MeasurementError(
            "--modulus",
            "beside a test over time: it does not say at which time the modulus is",
            "leave it out, or give a quasi-static curve",
        )
    if branches is not None and not timed:
        raise MeasurementError(
            "--branches", "without a test over time", "give --relaxation or --rate"
        )


def _show_branches(answer: BranchFit) -> None:
    for test in answer.tests:
        kind = "held" if test.rate is None else f"{test.rate:.3g} /s"
        error = _kpa(answer.errors[test.name])
        say(plain(f"{test.name}: {kind}, {len(test.time)} points, error {error}"))
    rows = [
        [
            _constant(name, each.value),
            f"{_constant(name, each.low)} to {_constant(name, each.high)}",
        ]
        for name, each in answer.constants.items()
    ]
    names = list(answer.constants)
    for number, branch in enumerate(answer.branches, 1):
        names += [f"g{number}", f"tau{number}"]
        rows.append([f"{branch.g.value:.4g}", f"{branch.g.low:.4g} to {branch.g.high:.4g}"])
        rows.append(
            [
                _seconds(branch.tau.value),
                f"{_seconds(branch.tau.low)} to {_seconds(branch.tau.high)}",
            ]
        )
    show_table(
        f"{answer.model}, long-term, and branches; error {_kpa(answer.rmse)}, "
        f"{answer.relative_error:.2%} of the largest stress",
        ["name", "value", "95 % interval"],
        [[name, *row] for name, row in zip(names, rows, strict=True)],
    )
    say(plain(f"{answer.sentence}."))
    for warning in answer.warnings:
        say(f"[yellow]warning:[/yellow] {plain(warning)}")


def _seconds(value: float) -> str:
    return quantity(float(f"{value:.4g}"), "time")


def _kpa(value: float) -> str:
    from math import isfinite

    return quantity(float(f"{value:.3g}"), "pressure") if isfinite(value) else "none"


def _with_interval(interval: Interval) -> str:
    spread = float(f"{interval.half_width / 1e3:.2g}")
    return f"{interval.value / 1e3:.4g} ± {spread:g} kPa"


def _constant(name: str, value: float) -> str:
    if name == "jm" or name.startswith("alpha"):
        return f"{value:.4g}"
    return quantity(value, "modulus")


def _softening(name: str, value: float) -> str:
    return quantity(value, "modulus") if name == "m" else f"{value:.4g}"


def _moduli(material: Material) -> tuple[float, float]:
    """Young's modulus in Pa and Poisson's ratio."""
    from voxsoft.materials import Hyperelastic

    if isinstance(material, Hyperelastic):
        return material.young(), material.poisson
    return material.young(_VOXEL_SIZE), material.poisson(_VOXEL_SIZE)


def _row(card: Card) -> list[str]:
    broken = card.elongation_at_break
    return [
        card.name,
        card.material.model,
        quantity(_moduli(card.material)[0], "modulus"),
        "" if broken is None else f"{broken:.0%}",
        card.same_as.removeprefix(card.name),
    ]


def _summary(card: Card) -> dict[str, Any]:
    young, poisson = _moduli(card.material)
    return {
        "name": card.name,
        "title": card.title,
        "same_as": card.same_as,
        "choice": card.choice,
        "material": card.material.model_dump(by_alias=True),
        "young": young,
        "poisson": poisson,
        "density": card.material.density,
        "elongation_at_break": card.elongation_at_break,
        "source": card.source,
        "caution": card.caution,
        "license": card.license,
        "licence": card.license,  # as earlier versions printed it
    }
