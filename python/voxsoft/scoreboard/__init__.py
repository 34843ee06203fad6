"""Scoreboard of measured robots: predictions with their intervals beside measured numbers."""

from voxsoft.scoreboard.board import Scoreboard, read_scores, score
from voxsoft.scoreboard.prediction import Prediction
from voxsoft.scoreboard.scripts import predictions_in

__all__ = ["Prediction", "Scoreboard", "predictions_in", "read_scores", "score"]
