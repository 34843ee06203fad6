"""Setting single values of a document by path."""

import pytest

from voxsoft.design import set_values
from voxsoft.errors import DesignError

DOCUMENT = {
    "name": "a",
    "voxel_size": "5 mm",
    "parameters": {"radius": {"value": "25 mm", "max": "30 mm"}, "cap": "5 mm"},
    "parts": [{"shape": "body", "material": "x"}],
    "clamps": [{"region": {"z": [0, 0]}}],
    "solver": {},
}


@pytest.mark.parametrize(
    ("assignment", "path", "value"),
    [
        ("radius=20 mm", ("parameters", "radius", "value"), "20 mm"),
        ("radius = = 2*cap", ("parameters", "radius", "value"), "= 2*cap"),
        ("cap=1 mm", ("parameters", "cap"), "1 mm"),
        ("voxel_size=2 mm", ("voxel_size",), "2 mm"),
        ("parts.0.material=y", ("parts", 0, "material"), "y"),
        ('parts.0.name="2024"', ("parts", 0, "name"), "2024"),
        ("clamps.0.region.z.1=1 mm", ("clamps", 0, "region", "z", 1), "1 mm"),
        ("clamps.0.region.z=[0, '1 mm']", ("clamps", 0, "region", "z"), [0, "1 mm"]),
        ("solver.substeps=4", ("solver", "substeps"), 4),
        ("floor.z=-1 mm", ("floor", "z"), "-1 mm"),
        ("description=a note", ("description",), "a note"),
        ("parameters.radius.max=40 mm", ("parameters", "radius", "max"), "40 mm"),
    ],
)
def test_paths_reach_every_value(assignment, path, value):
    here = set_values(DOCUMENT, [assignment])
    for step in path:
        here = here[step]
    assert here == value


def test_the_document_itself_stays():
    set_values(DOCUMENT, ["radius=1 mm", "parts.0.material=y"])
    assert DOCUMENT["parameters"]["radius"]["value"] == "25 mm"
    assert DOCUMENT["parts"][0]["material"] == "x"


@pytest.mark.parametrize(
    ("assignment", "words"),
    [
        ("radius", "is not an assignment"),
        ("=5", "is not an assignment"),
        ("radios=5 mm", 'did you mean "radius"'),
        ("parts.1.material=y", "use a number from 0 to 0"),
        ("parts.x.material=y", 'no entry "x"'),
        ("voxel_size.x=1", "nothing below it can be set"),
    ],
)
def test_wrong_paths_say_where_they_end(assignment, words):
    with pytest.raises(DesignError) as caught:
        set_values(DOCUMENT, [assignment])
    assert words in str(caught.value)
