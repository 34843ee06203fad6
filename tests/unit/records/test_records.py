"""Tables of a design: every problem is named with its place, in plain words."""

import pickle
from typing import Annotated, Literal

import pytest
from pydantic import Field

from voxsoft.errors import DesignError, ErrorDetail, VoxSoftError
from voxsoft.records import Record, closest, place
from voxsoft.units import FILE_CONTEXT, Point, PositiveLength


class Ball(Record):
    kind: Literal["ball"] = "ball"
    radius: PositiveLength
    center: Point = (0, 0, 0)


class Joint(Record):
    kind: Literal["joint"] = "joint"
    of: tuple["str | Operand", ...]


Operand = Annotated[Ball | Joint, Field(discriminator="kind")]
Joint.model_rebuild()


class Arrow(Record):
    along: Literal["x", "y"] | tuple[float, float] = "x"


class Scene(Record):
    shapes: dict[str, Annotated[Ball | Joint, Field(discriminator="kind")]] = Field({})
    count: int = 1
    label: str = ""


def problems(**data):
    with pytest.raises(DesignError) as caught:
        Scene(**data)
    return caught.value.problems


def test_a_nested_problem_carries_its_whole_place():
    found = problems(shapes={"a": {"kind": "ball", "radius": "-1 mm"}})
    assert found == (
        ErrorDetail("shapes.a.radius", '"-1 mm" is not positive', "give a length above zero"),
    )


def test_every_problem_is_listed():
    found = problems(shapes={"a": {"kind": "ball"}}, count="many", lable="x")
    assert [p.where for p in found] == ["shapes.a.radius", "count", "lable"]
    assert found[2].hint == 'did you mean "label"?'


def test_an_unknown_key_is_matched_with_the_keys_of_its_own_table():
    (found,) = problems(shapes={"a": {"kind": "ball", "radius": "1 mm", "centre": [0, 0, 0]}})
    assert found == ErrorDetail("shapes.a.centre", "is not known here", 'did you mean "center"?')


def test_an_unknown_kind_lists_known_ones():
    (found,) = problems(shapes={"a": {"kind": "bal", "radius": "1 mm"}})
    assert found == ErrorDetail("shapes.a.kind", '"bal" is not known', 'did you mean "ball"?')
    (found,) = problems(shapes={"a": {"radius": "1 mm"}})
    assert found.where == "shapes.a.kind"


def test_a_faulty_operand_is_reported_once_and_inside():
    found = problems(shapes={"a": {"kind": "joint", "of": [{"kind": "ball", "radius": "1 kPa"}]}})
    assert any("is a pressure" in p.what for p in found)
    assert not any("expected text" in p.what for p in found)


def test_the_branches_of_a_union_are_reported_in_one_sentence():
    with pytest.raises(DesignError) as caught:
        Arrow(along="w")
    assert caught.value.problems == (
        ErrorDetail("along", '"w" came; expected "x" or "y", or a list'),
    )
    with pytest.raises(DesignError) as caught:
        Arrow(along=(0, "q"))
    assert [p.where for p in caught.value.problems] == ["along[1]"]


def test_a_wrong_kind_of_operand_is_all_that_is_reported():
    (found,) = problems(shapes={"a": {"kind": "joint", "of": [{"kind": "bal"}]}})
    assert found.where == "shapes.a.of[0].kind"


def test_tables_in_tables_see_the_context_of_the_file():
    document = {"shapes": {"a": {"kind": "ball", "radius": 1.0}}}
    with pytest.raises(ValueError, match="has no unit"):
        Scene.model_validate(document, context=FILE_CONTEXT)
    assert Scene(**document).shapes["a"].radius == 1.0


def test_errors_survive_pickling_with_all_problems():
    error = DesignError.listing(
        [ErrorDetail("a", "is missing"), ErrorDetail("b", "is wrong", "try c")]
    )
    again = pickle.loads(pickle.dumps(error))
    assert again.problems == error.problems
    assert str(again) == str(error)
    assert "2 problems" in str(error)


def test_records_are_immutable():
    with pytest.raises(ValueError, match="does not change"):
        Ball(radius=1.0).radius = 2.0


def test_places_and_suggestions():
    assert place(["loads", 1, "history", "time", 0]) == "loads[1].history.time[0]"
    assert closest("xyz", []) == ""
    assert issubclass(DesignError, VoxSoftError)
