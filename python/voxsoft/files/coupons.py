"""Files of coupon tests: curves and moduli in, a material card and its evidence out."""

from __future__ import annotations

from pathlib import Path

from voxsoft._folders import folder_name
from voxsoft.files.cards import save_card
from voxsoft.files.designs import FilePath, read_document, read_text
from voxsoft.files.figures import save_figure
from voxsoft.files.run_folder import make_folder, provenance, write_json
from voxsoft.instruments import Measured, measured
from voxsoft.instruments.read import is_text, table_text
from voxsoft.materials import Mode
from voxsoft.materials.card import Card
from voxsoft.materials.coupon import (
    BranchFit,
    CouponFit,
    Curve,
    Cycles,
    MeasuredModulus,
    TestKind,
    TimedTest,
    read_curve,
    read_cycles,
    read_modulus_tests,
    read_timed_test,
)
from voxsoft.plot.branches import plot_branches
from voxsoft.plot.coupon import plot_coupons


def load_curve(
    path: FilePath,
    *,
    mode: Mode = "uniaxial",
    area: float | None = None,
    length: float | None = None,
) -> Curve:
    r"""Read a stress-strain curve from a table, or a file of :func:`voxsoft.measured`.

    Parameters
    ----------
    path
        Path of the file; see :func:`voxsoft.materials.coupon.read_curve` for its format.
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    area, length
        Original cross section in m² and gauge length in m, for forces and displacements.

    Raises
    ------
    FileError
        A missing, unreadable or too large file.
    MeasurementError
        No text, or a table that cannot be used, with the line.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "coupon.csv"
    >>> _ = file.write_text("strain,stress_kPa\n0,0\n0.1,5\n0.2,9\n0.3,13\n0.4,17\n")
    >>> float(load_curve(file).stress[-1])
    17000.0
    """
    return read_curve(_table(path), name=Path(path).name, mode=mode, area=area, length=length)


def load_cycles(
    path: FilePath, *, area: float | None = None, length: float | None = None
) -> Cycles:
    """Read a uniaxial test with load and unload from a file; see :func:`load_curve`.

    Raises
    ------
    FileError
        A missing, unreadable or too large file.
    MeasurementError
        No text, a table that cannot be used, or no cycle in it.
    """
    return read_cycles(_table(path), name=Path(path).name, area=area, length=length)


def load_timed_test(
    path: FilePath,
    *,
    kind: TestKind,
    area: float | None = None,
    length: float | None = None,
) -> TimedTest:
    """Read a uniaxial test over time from a file; see :func:`load_curve`.

    Parameters
    ----------
    path
        Path of the file; see :func:`voxsoft.materials.coupon.read_timed_test` for its format.
    kind
        ``"relaxation"`` or ``"rate"``.
    area, length
        Original cross section in m² and gauge length in m, for forces and displacements.

    Raises
    ------
    FileError
        A missing, unreadable or too large file.
    MeasurementError
        No text, a table that cannot be used, or a test unlike its kind.
    """
    return read_timed_test(_table(path), kind=kind, name=Path(path).name, area=area, length=length)


def _table(path: FilePath) -> str | Measured:
    """Read a table: its text, or the columns of an instrument's own format."""
    return table_text(path) if is_text(path) else measured(path)


def load_modulus_tests(path: FilePath) -> list[MeasuredModulus]:
    r"""Read measured moduli (bending, frequency, or known) from a TOML file.

    Raises
    ------
    FileError
        The file cannot be read, or is not TOML.
    MeasurementError
        A table that is no such test; every problem is listed.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "beam.toml"
    >>> table = '[[observation]]\nkind = "modulus"\nyoung = "60 kPa"\nuncertainty = "3 kPa"'
    >>> _ = file.write_text(table)
    >>> load_modulus_tests(file)
    [MeasuredModulus(name='modulus', young=60000.0, uncertainty=3000.0)]
    """
    return read_modulus_tests(read_document(read_text(path), Path(path).name))


def write_coupon_fit(fit: CouponFit, card: Card, folder: FilePath) -> list[Path]:
    """Write a fit to a folder, which is made if it is not there.

    The folder then holds ``NAME.toml``, the material card; ``summary.json``, everything in SI
    units; and ``fits.png``, the picture.

    Parameters
    ----------
    fit
        Result of :func:`voxsoft.materials.coupon.fit_coupons`.
    card
        Card of the fit, see :meth:`~voxsoft.materials.coupon.CouponFit.card`.
    folder
        Folder to write.

    Returns
    -------
    list of pathlib.Path
        Files that were written, the card first.

    Raises
    ------
    FileError
        The folder or a file in it cannot be written.
    """
    place = make_folder(folder)
    written = [place / f"{folder_name(card.name, 'card')}.toml", place / "summary.json"]
    save_card(card, written[0])
    write_json(written[1], fit.summary(str(card.calibration["model"])) | provenance())
    written.append(
        save_figure(plot_coupons(fit, str(card.calibration["model"])), place / "fits.png")
    )
    return written


def write_branch_fit(fit: BranchFit, card: Card, folder: FilePath) -> list[Path]:
    """Write a fit to tests over time to a folder, which is made if it is not there.

    The folder then holds ``NAME.toml``, the material card, whose ``[material]`` table a design may
    take as it is; ``summary.json``, everything in SI units; and ``branches.png``, the picture.

    Parameters
    ----------
    fit
        Result of :func:`voxsoft.materials.coupon.fit_branches`.
    card
        Card of the fit, see :meth:`~voxsoft.materials.coupon.BranchFit.card`.
    folder
        Folder to write.

    Returns
    -------
    list of pathlib.Path
        Files that were written, the card first.

    Raises
    ------
    FileError
        The folder or a file in it cannot be written.
    """
    place = make_folder(folder)
    written = [place / f"{folder_name(card.name, 'card')}.toml", place / "summary.json"]
    save_card(card, written[0])
    write_json(written[1], fit.summary() | provenance())
    written.append(save_figure(plot_branches(fit), place / "branches.png"))
    return written
