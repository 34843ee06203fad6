"""Formulas of a design file: ``= radius - wall``, with units carried along.

The grammar (whitespace is free)::

    formula = "=" sum
    sum     = product { ("+" | "-") product }
    product = factor { ("*" | "/") factor }
    factor  = "-" factor | number [unit] | name | call | "(" sum ")"
    call    = ("min" | "max") "(" sum { "," sum } ")"
    unit    = power { ("*" | "/") power }
    power   = (name of a unit) ["^" ["-"] digit]

The name of a parameter is never read as a unit; straight after a number it is refused, as it may
have been meant as either. A formula is evaluated while it is read; nothing in it can call, index
or loop. The studio's page reads formulas by the same grammar (``studio/src/controls/formula.ts``),
and ``tests/unit/design/formulas.json`` holds both to the same cases.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import lru_cache
from typing import Final, NoReturn

from voxsoft.errors import FormulaError, UnitError, VoxSoftError
from voxsoft.units import COMMON_UNITS, Dimension, Quantity, describe_dimension, parse_any

LONGEST_FORMULA: Final = 500
DEEPEST_NESTING: Final = 40

_TOKEN: Final = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)"
    r"|(?P<name>[A-Za-z_µμ°%][\wµμ]*)|(?P<sign>[-+*/(),^]))",
    re.ASCII,
)
_SUPERSCRIPT: Final = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+")
_DIGITS: Final = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_FUNCTIONS: Final[dict[str, Callable[..., float]]] = {"min": min, "max": max}
_NUMBER: Final = Dimension()


def is_formula(value: object) -> bool:
    """Check if a value of a document is a formula: text that starts with ``=``.

    Examples
    --------
    >>> is_formula("= radius"), is_formula("5 mm"), is_formula(0)
    (True, False, False)
    """
    return isinstance(value, str) and value.lstrip().startswith("=")


def with_renamed(text: str, name: str, to: str) -> str:
    """Give a parameter of a formula another name; the rest of its text stays.

    A name straight after a number stays too: it is a unit, or is refused by :func:`evaluate`.

    Parameters
    ----------
    text
        The formula with its leading ``=``.
    name, to
        Name of the parameter now, and from now on.

    Examples
    --------
    >>> with_renamed("= m + 5 m - 2*m", "m", "height")
    '= height + 5 m - 2*height'
    """
    pieces, done, number = [], 0, False
    for found in _TOKEN.finditer(text):
        if found["name"] == name and not number:
            pieces += [text[done : found.start("name")], to]
            done = found.end()
        number = found["number"] is not None
    return "".join([*pieces, text[done:]])


def evaluate(text: str, parameter: Callable[[str], Quantity]) -> Quantity:
    """Evaluate a formula.

    Parameters
    ----------
    text
        The formula with its leading ``=``.
    parameter
        Gives the value of a parameter by name; raises :class:`FormulaError` for an unknown one.

    Returns
    -------
    Quantity
        The value in SI units with its dimension.

    Raises
    ------
    FormulaError
        Not a formula of this grammar, too long or nested too deep, an unknown name, a sum of
        different dimensions, a division by zero or a result that is not finite.

    Examples
    --------
    >>> from voxsoft.units import KINDS
    >>> radius = Quantity(0.025, KINDS["length"].dimension)
    >>> evaluate("= 2*radius", {"radius": radius}.__getitem__).value
    0.05
    """
    return _Reader(text, parameter).read()


class _Reader:
    """One pass over one formula: recursive descent with one token of lookahead."""

    def __init__(self, text: str, parameter: Callable[[str], Quantity]) -> None:
        if len(text) > LONGEST_FORMULA:
            raise FormulaError(
                f'"{text[:40]}..."',
                f"is longer than {LONGEST_FORMULA} characters",
                "split it over several parameters",
            )
        self._text = text
        self._parameter = parameter
        self._tokens = _tokens_of(text)
        self._position = 0
        self._depth = 0

    def read(self) -> Quantity:
        result = self._sum()
        if self._token:
            self._fail(f'"{self._token}" is not expected here')
        return result

    @property
    def _token(self) -> str:
        return self._tokens[self._position] if self._position < len(self._tokens) else ""

    def _take(self) -> str:
        token = self._token
        self._position += 1
        return token

    def _expect(self, token: str) -> None:
        if self._token != token:
            came = f'"{self._token}"' if self._token else "the end"
            self._fail(f'expected "{token}", but {came} stands there')
        self._position += 1

    def _sum(self) -> Quantity:
        total = self._product()
        while self._token in {"+", "-"}:
            sign = 1.0 if self._take() == "+" else -1.0
            term = self._product()
            dimension = self._shared_dimension([total, term], "added" if sign > 0 else "subtracted")
            total = self._finite(total.value + sign * term.value, dimension)
        return total

    def _product(self) -> Quantity:
        result = self._factor()
        while self._token in {"*", "/"}:
            divide = self._take() == "/"
            factor = self._factor()
            if divide and factor.value == 0:
                self._fail("divides by zero")
            value = result.value / factor.value if divide else result.value * factor.value
            power = -1 if divide else 1
            result = self._finite(value, result.dimension.times(factor.dimension, power))
        return result

    def _factor(self) -> Quantity:
        self._depth += 1
        if self._depth > DEEPEST_NESTING:
            self._fail(f"is nested deeper than {DEEPEST_NESTING} levels")
        token = self._take()
        if token == "-":
            inner = self._factor()
            result = Quantity(-inner.value, inner.dimension)
        elif token == "(":
            result = self._sum()
            self._expect(")")
        elif token in _FUNCTIONS and self._token == "(":
            result = self._call(token)
        elif token[:1].isdigit() or token[:1] == ".":
            result = self._quantity(token)
        elif _is_name(token):
            result = self._parameter(token)
        else:
            self._fail(
                f'expected a value, but "{token}" stands there' if token else "is not complete"
            )
        self._depth -= 1
        return result

    def _quantity(self, digits: str) -> Quantity:
        """Read a number and the unit behind it, if there is one."""
        token = self._token
        if not _is_name(token) or self._calls:
            return self._finite(float(digits), _NUMBER)
        if self._is_parameter(token):
            self._fail(f'"{token}" is not expected here', f'write "{digits}*{token}"')
        unit = self._power()
        while self._token in {"*", "/"} and self._goes_on_as_unit:
            unit += self._take() + self._power()
        try:
            return parse_any(f"{digits} {unit}")
        except UnitError as error:
            self._fail(error.what, error.hint)

    def _power(self) -> str:
        """Read a unit's name and its exponent."""
        name = self._take()
        if self._token != "^":
            return name
        self._position += 1
        sign = self._take() if self._token == "-" else ""
        exponent = self._take()
        if not (exponent.isdigit() and 1 <= int(exponent) <= 9):
            self._fail("expected an exponent from 1 to 9 after ^")
        return f"{name}^{sign}{exponent}"

    @property
    def _calls(self) -> bool:
        """Check if a function stands here, since a unit may have the same name."""
        return self._token in _FUNCTIONS and self._after == "("

    @property
    def _goes_on_as_unit(self) -> bool:
        """Check if the text after a sign belongs to the unit before it; only everyday units do."""
        return self._after in COMMON_UNITS and not self._is_parameter(self._after)

    @property
    def _after(self) -> str:
        at = self._position + 1
        return self._tokens[at] if at < len(self._tokens) else ""

    def _is_parameter(self, name: str) -> bool:
        try:
            self._parameter(name)
        except VoxSoftError:
            return False
        return True

    def _call(self, name: str) -> Quantity:
        self._expect("(")
        arguments = [self._sum()]
        while self._token == ",":
            self._position += 1
            arguments.append(self._sum())
        self._expect(")")
        dimension = self._shared_dimension(arguments, "compared")
        return Quantity(_FUNCTIONS[name](a.value for a in arguments), dimension)

    def _shared_dimension(self, terms: list[Quantity], verb: str) -> Dimension:
        """Find the one dimension of all terms; a plain zero goes with anything."""
        dimensions = {t.dimension for t in terms if t.value != 0 or t.dimension != _NUMBER}
        if len(dimensions) > 1:
            named = " and ".join(sorted(map(describe_dimension, dimensions)))
            hint = "give the number a unit, as in 5 mm" if _NUMBER in dimensions else ""
            self._fail(f"{named} cannot be {verb}", hint)
        return dimensions.pop() if dimensions else _NUMBER

    def _finite(self, value: float, dimension: Dimension) -> Quantity:
        if not math.isfinite(value):
            self._fail("is too large for a number")
        return Quantity(value, dimension)

    def _fail(self, what: str, hint: str = "") -> NoReturn:
        raise FormulaError("", f'in "{self._text}": {what}', hint)


@lru_cache(maxsize=1024)  # a study evaluates the same formulas for every trial
def _tokens_of(text: str) -> tuple[str, ...]:
    body = _SUPERSCRIPT.sub(
        lambda found: f"^{found.group().translate(_DIGITS)}", text.lstrip()[1:].rstrip()
    )
    tokens, position = [], 0
    while position < len(body):
        match = _TOKEN.match(body, position)
        if match is None:
            what = f'"{body[position:].lstrip()[:10]}" is not part of a formula'
            raise FormulaError("", f'in "{text}": {what}')
        tokens.append(match.group().strip())
        position = match.end()
    return tuple(tokens)


def _is_name(token: str) -> bool:
    return token[:1].isalpha() or token[:1] in {"_", "°", "%"}
