"""Free expressions of x, y, z: as text, or written with Python operators.

``x``, ``y`` and ``z`` are expressions; arithmetic with them gives expressions, and each is a shape
whose inside is where it is negative. They are kept as text, so a design that holds one can be
saved. Between two expressions ``-`` is arithmetic; ``|`` and ``&`` join shapes as always.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from voxsoft import _core
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Scope, Shape

__all__ = [
    "Expression",
    "atan2",
    "cos",
    "exp",
    "log",
    "maximum",
    "minimum",
    "sin",
    "sqrt",
    "tan",
    "x",
    "y",
    "z",
]


def _readable(text: str) -> str:
    _core.Shape.expression(text)
    return text


def _as_text(value: object) -> object:
    return value.text if isinstance(value, Expression) else value


#: Text of an expression, checked; an :class:`Expression` is accepted too.
ExpressionText = Annotated[str, BeforeValidator(_as_text), AfterValidator(_readable)]


class Expression(Shape):
    """The points where a function of x, y, z (m) is negative.

    Operators are ``+ - * / %`` and powers ``^`` or ``**``; functions sqrt abs exp log sin cos tan
    asin acos atan floor ceil, atan2 hypot of two, min max of two or more arguments; pi is known.
    Offset, shell and smooth operators take the value for a distance in m, so scale it to be one.

    Examples
    --------
    >>> from voxsoft.shapes import Expression, sqrt, x, y, z
    >>> pipe = sqrt(x**2 + y**2) - 0.02
    >>> pipe.text
    'sqrt(x**2 + y**2) - 0.02'
    >>> pipe == Expression(text="sqrt(x**2 + y**2) - 0.02")
    True
    >>> pipe.evaluate([[0.03, 0, 0]])
    array([0.01])
    """

    kind: Literal["expression"] = "expression"
    text: Annotated[str, AfterValidator(_readable)] = Field(
        description="The function of x, y, z in m; negative inside."
    )

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return _core.Shape.expression(self.text)

    def __neg__(self) -> Expression:
        return Expression(text=f"-{_factor(self)}")

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return call("abs", self)

    def __add__(self, other: Expression | float) -> Expression:
        return _infix(self, "+", other)

    def __radd__(self, other: float) -> Expression:
        return _infix(other, "+", self)

    def __sub__(self, other: Any) -> Any:  # noqa: ANN401 - arithmetic, or a difference of shapes
        if isinstance(other, Shape) and not isinstance(other, Expression):
            return super().__sub__(other)
        return _infix(self, "-", other)

    def __rsub__(self, other: float) -> Expression:
        return _infix(other, "-", self)

    def __mul__(self, other: Expression | float) -> Expression:
        return _infix(self, "*", other)

    def __rmul__(self, other: float) -> Expression:
        return _infix(other, "*", self)

    def __truediv__(self, other: Expression | float) -> Expression:
        return _infix(self, "/", other)

    def __rtruediv__(self, other: float) -> Expression:
        return _infix(other, "/", self)

    def __mod__(self, other: Expression | float) -> Expression:
        return _infix(self, "%", other)

    def __rmod__(self, other: float) -> Expression:
        return _infix(other, "%", self)

    def __pow__(self, other: Expression | float) -> Expression:
        return _infix(self, "**", other)

    def __rpow__(self, other: float) -> Expression:
        return _infix(other, "**", self)


def _written(value: Expression | float) -> str:
    if isinstance(value, Expression):
        return value.text
    if isinstance(value, bool) or not isinstance(value, int | float):
        try:
            value = float(value)
        except (TypeError, ValueError):
            what = f"{value!r} came; expected a number or an expression"
            raise ShapeError("expression", what) from None
    return repr(value)


def _loosest(text: str) -> int:
    """Rank the weakest operator outside parentheses: 1 sum, 2 product, 3 sign, 4 power, 5 none."""
    rank, depth, previous = 5, 0, ""
    for position, symbol in enumerate(text):
        depth += (symbol == "(") - (symbol == ")")
        if (
            depth == 0
            and symbol in "+-"
            and previous not in ("", "e", "E", "*", "/", "%", "^", "(")
        ):
            rank = min(rank, 1)
        elif depth == 0 and symbol in "+-" and previous not in ("e", "E"):
            rank = min(rank, 3)
        elif depth == 0 and symbol in "*/%^":
            power = symbol == "^" or "**" in text[max(position - 1, 0) : position + 2]
            rank = min(rank, 4 if power else 2)
        previous = symbol if symbol != " " else previous
    return rank


def _wrapped(value: Expression | float, needed: int) -> str:
    text = _written(value)
    return text if _loosest(text) >= needed else f"({text})"


def _factor(value: Expression | float) -> str:
    return _wrapped(value, 4)


_NEEDED = {"+": (1, 2), "-": (1, 2), "*": (2, 4), "/": (2, 4), "%": (2, 4), "**": (5, 5)}


def _infix(left: Expression | float, operator: str, right: Expression | float) -> Expression:
    """Write an operation with as few parentheses as its meaning requires."""
    of_left, of_right = _NEEDED[operator]
    space = "" if operator == "**" else " "
    return Expression(
        text=f"{_wrapped(left, of_left)}{space}{operator}{space}{_wrapped(right, of_right)}"
    )


def call(function: str, *arguments: Expression | float) -> Expression:
    """Write a call of one of the functions that :class:`Expression` knows."""
    return Expression(text=f"{function}({', '.join(map(_written, arguments))})")


def sqrt(a: Expression | float) -> Expression:
    """Return the square root."""
    return call("sqrt", a)


def exp(a: Expression | float) -> Expression:
    """Return the exponential."""
    return call("exp", a)


def log(a: Expression | float) -> Expression:
    """Return the natural logarithm."""
    return call("log", a)


def sin(a: Expression | float) -> Expression:
    """Return the sine of an angle in rad."""
    return call("sin", a)


def cos(a: Expression | float) -> Expression:
    """Return the cosine of an angle in rad."""
    return call("cos", a)


def tan(a: Expression | float) -> Expression:
    """Return the tangent of an angle in rad."""
    return call("tan", a)


def atan2(a: Expression | float, b: Expression | float) -> Expression:
    """Return the angle of the point (b, a) in rad."""
    return call("atan2", a, b)


def minimum(a: Expression | float, *others: Expression | float) -> Expression:
    """Return the smallest of two or more."""
    return call("min", a, *others)


def maximum(a: Expression | float, *others: Expression | float) -> Expression:
    """Return the largest of two or more."""
    return call("max", a, *others)


x = Expression(text="x")
y = Expression(text="y")
z = Expression(text="z")
