"""Factors to SI: ``5 * mm`` is 0.005 (meters). They are plain floats."""

from math import pi
from typing import Final

um: Final = 1e-6
mm: Final = 1e-3
cm: Final = 1e-2
m: Final = 1.0
inch: Final = 0.0254
mL: Final = 1e-6
L: Final = 1e-3

mg: Final = 1e-6
g: Final = 1e-3
kg: Final = 1.0

ms: Final = 1e-3
s: Final = 1.0
Hz: Final = 1.0

mN: Final = 1e-3
N: Final = 1.0
kN: Final = 1e3
mJ: Final = 1e-3
J: Final = 1.0
mW: Final = 1e-3
W: Final = 1.0

Pa: Final = 1.0
kPa: Final = 1e3
MPa: Final = 1e6
GPa: Final = 1e9
bar: Final = 1e5
psi: Final = 6894.757293168361

mT: Final = 1e-3
T: Final = 1.0
V: Final = 1.0
kV: Final = 1e3
MV: Final = 1e6
K: Final = 1.0

deg: Final = pi / 180.0
rad: Final = 1.0
