"""Closed form of a strip that is pulled over time, with the branches of its material.

A branch ``(g, τ)`` holds the stress ``q`` with ``dq/dt + q/τ = γ ds/dt``, ``γ = g/(1 - Σ g)``.
There ``s`` is the deviatoric stress by the stretch, ``sᵢ = (wᵢ - Σ w/3)/λᵢ`` with
``wᵢ = ∂W/∂ln λᵢ``. A strip of incompressible material has ``λ₂ = λ₃ = λ^(-1/2)`` and free sides, so
that the nominal stress is
``P = s₁ + q₁ - λ₂/λ₁ (s₂ + q₂)``. With the nominal stress ``P∞`` of the elastic material,
``s₁ = 2 P∞/3`` and ``s₂ = -P∞ r/3``, ``r = λ^(3/2)``, and

    P = P∞ + Σ (2 q[P∞] + q[P∞ r]/r)/3

with the branch's response ``q[·]`` to a stress over time. Simulations over time have the same law.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.errors import MaterialError
from voxsoft.materials.homogeneous import nominal_stress
from voxsoft.materials.hyperelastic import Floats, Hyperelastic

#: Largest change of stretch between instants at which the stress is computed: between them it is
#: taken for linear, an error of 1e-5 of it.
_FINEST: Final = 0.01
#: Decays of a branch that are added up in one go: e^30 leaves ten digits to the smallest of them.
_DECAYS: Final = 30.0


def relaxing_stress(material: Hyperelastic, time: ArrayLike, stretch: ArrayLike) -> Floats:
    """Compute the engineering stress of a strip of incompressible material over time, in Pa.

    Parameters
    ----------
    material
        Material with its `prony` branches; its Poisson's ratio and softening are ignored.
    time
        Instants in s, (n,), that rise, the first at zero or later.
    stretch
        Stretch at each, (n,), linear between them. The strip is at rest at time zero: a stretch at
        time zero is sudden, a later first one is reached from 1 at a constant rate.

    Returns
    -------
    numpy.ndarray
        Stress, (n,).

    Raises
    ------
    MaterialError
        Times that fall or are negative, or a stretch that is not above zero.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> soft = NeoHookean(young="60 kPa", prony=[{"g": 0.5, "tau": "10 s"}])
    >>> (relaxing_stress(soft, [0, 10, 1000], [2, 2, 2]) / 1e3).round(1).tolist()
    [70.0, 47.9, 35.0]
    """
    instants, stretches = (np.asarray(v, dtype=np.float64) for v in (time, stretch))
    if instants.ndim != 1 or instants.shape != stretches.shape or len(instants) == 0:
        what = f"{instants.shape} and stretch {stretches.shape} do not pair up"
        raise MaterialError("time", what, "give a stretch at each instant")
    if instants[0] < 0.0 or np.any(np.diff(instants) <= 0.0):
        raise MaterialError("time", "falls or is negative", "let it rise from zero or later")
    way = StretchHistory(instants, stretches)
    left = 1.0 - sum(term.g for term in material.prony)
    branches = [(term.g / left, term.tau) for term in material.prony]
    elastic = nominal_stress(material, way.stretch, "uniaxial")
    return way.response(elastic, [gamma for gamma, _ in branches], [tau for _, tau in branches])


class StretchHistory:
    """Stretches of a strip over time, at instants close enough for stresses linear between them.

    Parameters
    ----------
    time, stretch
        See :func:`relaxing_stress`.
    """

    def __init__(self, time: Floats, stretch: Floats) -> None:
        if time[0] > 0.0:
            time, stretch = np.concatenate([[0.0], time]), np.concatenate([[1.0], stretch])
            self._first = 1
        else:
            self._first = 0
        parts = np.maximum(np.ceil(np.abs(np.diff(stretch)) / _FINEST).astype(int), 1)
        ends = np.concatenate([[0], np.cumsum(parts)])
        #: Place of each given instant among all.
        self._kept = ends[self._first :]
        every = np.arange(ends[-1] + 1)
        #: Instants in s, (m,), and the stretch at each, (m,).
        self.time = np.interp(every, ends, time)
        self.stretch = np.interp(every, ends, stretch)
        self._turn = self.stretch**1.5

    def response(self, elastic: Floats, gammas: list[float], taus: list[float]) -> Floats:
        """Return the nominal stress at the given instants, (n, ...).

        Parameters
        ----------
        elastic
            Nominal stress of the elastic material at `stretch` in Pa, (m, ...).
        gammas, taus
            Stiffness of each branch over the long-term one, and its time in s.
        """
        stress = elastic.copy()
        for gamma, tau in zip(gammas, taus, strict=True):
            stress += gamma * self.overstress(elastic, tau)
        return self.given(stress)

    def given(self, stress: Floats) -> Floats:
        """Return values at the given instants, (m, ...) → (n, ...)."""
        given: Floats = stress[self._kept]
        return given

    def overstress(self, elastic: Floats, tau: float) -> Floats:
        """Return the stress of a branch as stiff as the long-term material, (m, ...) → (m, ...)."""
        turn = self._turn.reshape(-1, *(1,) * (elastic.ndim - 1))
        first = branch_stress(self.time, elastic, tau)
        second = branch_stress(self.time, elastic * turn, tau)
        total: Floats = (2.0 * first + second / turn) / 3.0
        return total


def branch_stress(time: Floats, stress: Floats, tau: float) -> Floats:
    """Return the response of one branch of unit stiffness to a stress that is linear in between.

    Parameters
    ----------
    time
        Instants in s, (m,), that rise.
    stress
        Stress at each, (m, ...); the first is sudden.
    tau
        Time of the branch in s.
    """
    steps = np.diff(time) / tau
    mean = -np.expm1(-steps) / steps
    shape = (-1, *(1,) * (stress.ndim - 1))
    change = np.concatenate([stress[:1], np.diff(stress, axis=0) * mean.reshape(shape)])
    ages = time / tau
    found = np.empty_like(change)
    begin, held = 0, np.zeros_like(change[0])
    while begin < len(time):
        end = int(np.searchsorted(ages, ages[begin] + _DECAYS, side="right"))
        age = (ages[begin:end] - ages[begin]).reshape(shape)
        added = change[begin:end] * np.exp(age)
        added[0] += held
        found[begin:end] = np.cumsum(added, axis=0) * np.exp(-age)
        if end < len(time):
            held = found[end - 1] * np.exp(ages[end - 1] - ages[end])
        begin = end
    return found
