"""Nothing that a design file may hold brings out any error but our own."""

import contextlib
import copy
import os
import tomllib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from voxsoft.design import Design, set_values
from voxsoft.errors import VoxSoftError
from voxsoft.files.designs import load

# Documents here are in no folder, where designs that they name could be.
EXAMPLES = sorted(
    path
    for path in (Path(__file__).parents[2] / "examples").glob("*.toml")
    if b"[[bodies]]" not in path.read_bytes()
)
TEXTS = [path.read_bytes() for path in EXAMPLES]
DOCUMENTS = [tomllib.loads(text.decode()) for text in TEXTS]

# VOXSOFT_FUZZ=100000 tries longer than a test run should.
TRIES = int(os.environ.get("VOXSOFT_FUZZ", "100"))
THOROUGH = settings(
    max_examples=TRIES,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)

SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=12),
    st.sampled_from(
        [
            "5 mm",
            "-5 mm",
            "0",
            "4 kPa",
            "= radius",
            "= radius - wall",
            "= 1/0",
            "=",
            "inf",
            "nan",
            "cylinder",
            "difference",
            "body",
            "cavity",
            "outer",
            "all",
            "xyz",
            "1e400 mm",
            "5 °",
            "==",
        ]
    ),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(
            st.sampled_from(["kind", "of", "x", "value", "min", "shape", "time", "", "a.b"]),
            inner,
            max_size=4,
        ),
    ),
    max_leaves=8,
)


def paths(value, path=()):
    """List every place in a document."""
    found = [path] if path else []
    if isinstance(value, dict):
        for key, entry in value.items():
            found += paths(entry, (*path, key))
    elif isinstance(value, list):
        for index, entry in enumerate(value):
            found += paths(entry, (*path, index))
    return found


@st.composite
def mutated_documents(draw):
    document = copy.deepcopy(draw(st.sampled_from(DOCUMENTS)))
    for _ in range(draw(st.integers(1, 4))):
        *way, last = draw(st.sampled_from(paths(document)))
        here = document
        for step in way:
            here = here[step]
        action = draw(st.sampled_from(["replace", "remove", "add"]))
        if action == "remove":
            del here[last]
        elif action == "add" and isinstance(here, dict):
            here[draw(st.text(max_size=6))] = draw(VALUES)
        else:
            here[last] = draw(VALUES)
        if not document:
            break
    return document


@st.composite
def mutated_texts(draw):
    text = bytearray(draw(st.sampled_from(TEXTS)))
    for _ in range(draw(st.integers(1, 6))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 20)))
        text[start:end] = draw(
            st.one_of(
                st.binary(max_size=6),
                st.sampled_from([b'"', b"[", b"]]", b"{", b"= ", b"\n", b"-", b"1e9", b" mm"]),
            )
        )
    return bytes(text)


def use(design):
    """Touch all that a design offers, so that lazy errors show as well."""
    assert len(design.hash) == 64
    assert Design.from_document(design.document).hash == design.hash
    assert tomllib.loads(design.to_toml(resolved=True))


@THOROUGH
@given(mutated_documents())
def test_changed_documents(document):
    with contextlib.suppress(VoxSoftError):
        use(Design.from_document(document))


@THOROUGH
@given(mutated_texts())
def test_changed_files(tmp_path, text):
    path = tmp_path / "design.toml"
    path.write_bytes(text)
    with contextlib.suppress(VoxSoftError):
        use(load(path))


@THOROUGH
@given(VALUES)
def test_documents_of_anything(document):
    with contextlib.suppress(VoxSoftError):
        Design.from_document(document)


@THOROUGH
@given(
    st.sampled_from(DOCUMENTS),
    st.one_of(
        st.text(max_size=30),
        st.tuples(
            st.sampled_from(["radius", "parts.0.shape", "parts.9", "clamps.0.region.z.0", "."]),
            st.text(max_size=20),
        ).map("=".join),
    ),
)
def test_assignments(document, assignment):
    with contextlib.suppress(VoxSoftError):
        Design.from_document(set_values(document, [assignment]))


@pytest.mark.parametrize("document", DOCUMENTS, ids=[path.stem for path in EXAMPLES])
def test_the_seeds_themselves_are_valid(document):
    use(Design.from_document(document))
