"""Connected components of graphs, beside those of SciPy."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from voxsoft._components import components


@st.composite
def graphs(draw):
    """Ends of links (k, 2), and the number of nodes."""
    count = draw(st.integers(1, 60))
    node = st.integers(0, count - 1)
    links = draw(st.lists(st.tuples(node, node), max_size=90))
    return np.array(links, dtype=np.int64).reshape(-1, 2), count


@given(graphs())
def test_components_are_those_of_scipy(graph):
    links, count = graph
    matrix = coo_array((np.ones(len(links)), links.T), shape=(count, count))
    _, expected = connected_components(matrix, directed=False)
    assert np.array_equal(components(*links.T, count), expected)


def test_a_long_chain_is_one_component():
    # Numbers in no order along the chain, where each round joins a part of them alone.
    order = np.random.default_rng(0).permutation(10_000)
    assert components(order[:-1], order[1:], len(order)).max() == 0
    assert components(order[:-2], order[2:], len(order)).max() == 1
