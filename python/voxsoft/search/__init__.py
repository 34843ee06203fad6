"""Search algorithms: the paper's genetic algorithm, and Optuna's samplers by name.

Importing this module needs NumPy only; :mod:`voxsoft.search.samplers` imports Optuna.
"""

from voxsoft.search.genetic import Genetic, Individual

__all__ = ["Genetic", "Individual"]
