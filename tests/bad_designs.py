"""Changes that make the cylinder of the examples a bad design, with the message for each."""

# Changes for `--set`. The first are no designs; the others cannot be solved, or not judged.
NO_DESIGN = [
    ("color=red", "is not known here"),
    ("voxel_size=5", "has no unit"),
    ("voxel_size=5 kPa", "expected a length"),
    ("voxel_size=-5 mm", "-5 mm"),
    ("voxel_size=0", "0"),
    ("voxel_size=1 um", "of memory"),
    ("voxel_size=100 mm", "is empty"),
    ("shapes.outer.radius== radus", "radus"),
    ("parameters.cap.value== cap", "cap"),
    ("radius=100 mm", "25 mm"),
    ("parts.0.material=ecoflex", "did you mean"),
    ("clamps.0.region.z=[1, 2]", "unit"),
    ("objectives.rise.probe=tip", 'no probe "tip"'),
    ("solver.method=magic", "magic"),
]
NOT_SOLVABLE = [
    ("clamps=[]", "nothing holds the body"),
    ('clamps.0.region.z=["1 m", "2 m"]', "touches nothing"),
    ('probes.top.z=["1 m", "1 m"]', "touches nothing"),
    ("shapes.cavity.radius=1 mm", "no enclosed cavity"),
    ('constraints.light={metric = "mass", max = "30 mm"}', "mass is a mass"),
    ('constraints.light={metric = "mass", max = "30 g", axis = "z"}', "no direction"),
    ("objectives.rise.maximize=displacment", 'did you mean "displacement"'),
]
NO_TEXT = {
    "empty": b"",
    "truncated": b'name = "a',
    "not-utf8": b"\xff\xfe",
    "binary": b"\x89PNG\r\n\x1a\n\x00",
    "deep": b"a = " + b"[" * 10_000,
}
