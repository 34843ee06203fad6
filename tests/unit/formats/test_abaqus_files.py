"""Abaqus and CalculiX input: assemblies, sets, elements and cards as the programs take them."""

from pathlib import Path

import numpy as np
import pytest

from voxsoft.errors import FileError
from voxsoft.formats.abaqus import read
from voxsoft.formats.split import tets_of

TET = "1,0,0,0\n2,10,0,0\n3,0,10,0\n4,0,0,10\n"


def deck(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "deck.inp"
    path.write_text(text, encoding="utf-8")
    return path


def volume_of(path: Path) -> float:
    contents = read(path)
    tets = tets_of(contents, str(path)).tets
    a, b, c, d = (contents.points[tets[:, corner]] for corner in range(4))
    return float(np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)).sum() / 6)


def test_parts_keep_their_own_nodes(tmp_path):
    path = deck(
        tmp_path,
        f"""*Part, name=P1
*Node
{TET}*Element, type=C3D4
1,1,2,3,4
*End Part
*Part, name=P2
*Node
1,100,0,0
2,105,0,0
3,100,5,0
4,100,0,5
5,105,5,5
*Element, type=C3D4
1,2,3,4,5
*End Part
*Assembly, name=A
*Instance, name=I1, part=P1
*End Instance
*Instance, name=I2, part=P2
*End Instance
*End Assembly
""",
    )
    # 10^3 / 6, and the tetrahedron within a cube of 5 that stands on four of its corners: 5^3 / 3.
    assert volume_of(path) == pytest.approx(1000 / 6 + 125 / 3)
    assert read(path).instances == ("I1", "I2")


def test_instances_are_moved_then_turned(tmp_path):
    path = deck(
        tmp_path,
        f"""*PART, NAME=FINGER
*NODE, NSET=ALL
{TET}*ELEMENT, TYPE=C3D4, ELSET=RUBBER
7,1,2,3,4
*NSET, NSET=TIP
2
*END PART
*ASSEMBLY, NAME=HAND
*INSTANCE, NAME=ONE, PART=FINGER
*END INSTANCE
*INSTANCE, NAME=TWO, PART=FINGER
30, 0, 0
*END INSTANCE
*INSTANCE, NAME=THREE, PART=FINGER
0, 0, 50
0, 0, 0, 0, 0, 1, 90
*END INSTANCE
*NSET, NSET=BOTH, INSTANCE=TWO
1, TIP
*NSET, NSET=BOTH, INSTANCE=THREE
TIP
*NSET, NSET=DOTTED
ONE.3, THREE.TIP
*END ASSEMBLY
""",
    )
    contents = read(path)
    assert volume_of(path) == pytest.approx(3 * 1000 / 6)
    np.testing.assert_allclose(contents.points[4:6], [[30, 0, 0], [40, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(contents.points[8:10], [[0, 0, 50], [0, 10, 50]], atol=1e-12)
    assert set(contents.cell_sets) == {"ONE.RUBBER", "TWO.RUBBER", "THREE.RUBBER"}
    sets = {name: members.tolist() for name, members in contents.point_sets.items()}
    assert sets["BOTH"] == [4, 5, 9]
    assert sets["DOTTED"] == [2, 9]
    assert sets["TWO.TIP"] == [5]


def test_sets_are_unions_over_their_cards_and_hold_sets(tmp_path):
    path = deck(
        tmp_path,
        """** from a text editor
*node, nset=fixed
1,0,0,0
2,10,0,0
*NODE
3,0,10,0
4,0,0,10
5,10,10,10
*element, type=c3d4h, elset=soft
1,1,2,3,4
*Element, Type=C3D4,
 Elset=stiff
2,2,3,
4,5
*NSET, NSET=FIX
1, 2
*NSET, NSET=FIX
3
*NSET, NSET=RUN, GENERATE
1, 3
*NSET, NSET=ALL2
FIX, 5,
*ELSET, ELSET=BOTH
SOFT, STIFF
*NSET, NSET=OF, ELSET=STIFF
*SOLID SECTION, ELSET=SOFT, MATERIAL=M
""",
    )
    contents = read(path)
    assert {name: found.tolist() for name, found in contents.point_sets.items()} == {
        "fixed": [0, 1],
        "FIX": [0, 1, 2],
        "RUN": [0, 1, 2],
        "ALL2": [0, 1, 2, 4],
        "OF": [1, 2, 3, 4],
    }
    assert {name: found.tolist() for name, found in contents.cell_sets.items()} == {
        "soft": [0],
        "stiff": [1],
        "BOTH": [0, 1],
    }
    assert contents.sections == ("soft",)
    assert volume_of(path) == pytest.approx(1000 / 6 + 1000 / 3)


def test_a_local_system_places_nodes(tmp_path):
    text = f"*SYSTEM\n0,0,5, 0,1,5, -1,0,5\n*NODE\n{TET}*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n"
    points = read(deck(tmp_path, text)).points
    # Local x is y, local y is -x, and the origin is 5 up.
    expected = [[0, 0, 5], [0, 10, 5], [-10, 0, 5], [0, 0, 15]]
    np.testing.assert_allclose(points, expected, atol=1e-12)


def test_an_included_file_is_read_in_its_place(tmp_path):
    (tmp_path / "nodes.txt").write_text(f"*NODE\n{TET}")
    text = "*INCLUDE, INPUT=nodes.txt\n*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n"
    assert volume_of(deck(tmp_path, text)) == pytest.approx(1000 / 6)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (f"*NODE\n{TET}*NGEN\n1,4,1\n", r"deck.inp, line 6: \*NGEN makes or moves nodes"),
        (f"*NODE\n{TET}*ELEMENT,TYPE=C3D4\n1,1,2,3,9\n", "line 6: .* node 9, which is missing"),
        (f"*NODE\n{TET}*ELEMENT,TYPE=C3D4\n1,1,2,3\n", "line 6: element 1 has 3 nodes"),
        (f"*NODE\n{TET}*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n1,1,2,3,4\n", "element 1 stands twice"),
        ("*INSTANCE, NAME=A, PART=B\n*END INSTANCE\n", "names part B, which is missing"),
        ("*INCLUDE, INPUT=no.inp\n", "names no.inp, which is missing"),
        ("no card\n", "line 1: begins with 'no card'; expected a card"),
    ],
)
def test_decks_that_cannot_be_followed_say_where(tmp_path, text, match):
    with pytest.raises(FileError, match=match):
        read(deck(tmp_path, text))
