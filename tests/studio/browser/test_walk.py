"""Walks that nobody wrote: random legal actions, with invariants after each."""

import os

import pytest
from walking import Walk

pytestmark = [pytest.mark.browser, pytest.mark.long]

#: Actions of one walk, from which undo leads back; and seeds of the walks.
LENGTH = 250
SEEDS = range(8)


@pytest.mark.timeout(1800)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_random_walk_leaves_the_studio_whole(serving, tmp_path, open_tab, seed):
    server = serving(tmp_path)
    try:
        tab = open_tab(server.address, mode="design", symbols=False)
        tab.until("window.voxsoft !== undefined && voxsoft.triangles > 0")
        walk = Walk(tab, server, seed)
        walk.go(LENGTH)
        walk.agree()
        walk.back_to_the_start()
    finally:
        server.stop()


@pytest.mark.slow
@pytest.mark.timeout(0)
def test_a_long_walk(serving, tmp_path, open_tab):
    """As many actions as VOXSOFT_WALK says, else 50,000, in walks of the seeds from 1000."""
    total = int(os.environ.get("VOXSOFT_WALK", "50000"))
    for seed in range(1000, 1000 + -(-total // LENGTH)):
        folder = tmp_path / str(seed)
        folder.mkdir()
        server = serving(folder)
        try:
            tab = open_tab(server.address, mode="design", symbols=False)
            walk = Walk(tab, server, seed)
            walk.go(LENGTH)
            walk.back_to_the_start()
            tab.page.context.close()
        finally:
            server.stop()
