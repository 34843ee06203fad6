r"""Calibration: from measurements of a real body to the moduli of its material.

Examples
--------
>>> from voxsoft.design import families
>>> table = "arc_position_from_clamp_mm,dz_mm\n30,-15\n60,-44\n90,-75"
>>> beam = families.beam().with_values("parts.0.material=ecoflex-00-30-lattice")
>>> experiment = Experiment(beam, read_measurement(table))
>>> found = calibrate(experiment, parameters={"edge": ("5 kPa", "80 kPa")}, generations=3)
>>> found.identifiable
{'edge': True}
"""

from voxsoft.calibration.experiment import Experiment
from voxsoft.calibration.identifiability import Profile
from voxsoft.calibration.line import LineName
from voxsoft.calibration.measurement import Measurement
from voxsoft.calibration.misfit import Deviation
from voxsoft.calibration.result import Calibration, Candidate, Fit, Generation
from voxsoft.calibration.run import CalibrationEvent, ProgressCallback, calibrate
from voxsoft.calibration.space import DEFAULT_BOUNDS, usual_ranges
from voxsoft.calibration.states import measurements_at
from voxsoft.calibration.table import read_measurement, table_of

__all__ = [
    "DEFAULT_BOUNDS",
    "Calibration",
    "CalibrationEvent",
    "Candidate",
    "Deviation",
    "Experiment",
    "Fit",
    "Generation",
    "LineName",
    "Measurement",
    "Profile",
    "ProgressCallback",
    "calibrate",
    "measurements_at",
    "read_measurement",
    "table_of",
    "usual_ranges",
]
