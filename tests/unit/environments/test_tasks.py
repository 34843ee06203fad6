"""Tasks of the registered environments can be done, by hand."""

import gymnasium
import numpy as np
import pytest

import voxsoft.environments  # noqa: F401 - registers


def run(name, policy, seed=3, **options):
    """Return the sum of rewards, the last ends and the last info of one episode."""
    env = gymnasium.make(f"VoxSoft/{name}-v0", **options)
    seen, info = env.reset(seed=seed)
    total, ends = 0.0, (False, False)
    while not any(ends):
        action = np.asarray(policy(env.unwrapped, seen), dtype=np.float32)
        seen, reward, *ends, info = env.step(action)
        total += reward
    return total, tuple(ends), info


@pytest.mark.long
def test_a_box_is_lifted_by_closing_and_going_up():
    total, ends, info = run("Lift", lambda env, _: (1, 1 if env.simulator.state.time > 1.5 else -1))
    assert ends == (True, False)
    assert info["is_success"]
    # Each mm is a reward of 1, and the box is done at 20 mm; 15 mm/s are 1.5 mm in a step.
    assert 20.0 <= total < 22.0


@pytest.mark.long
def test_a_box_stays_where_open_fingers_go_up():
    total, ends, _ = run("Lift", lambda *_: (-1, 1), episode="2 s")
    assert ends == (False, True)
    assert total == pytest.approx(0.0, abs=0.1)


@pytest.mark.long
def test_a_peg_is_inserted_by_going_on():
    total, ends, info = run("Peg", lambda *_: (1, 0))
    assert ends == (True, False)
    assert info["distance"] < 1e-3
    # The rewards are the way: 32 mm, and the place aside.
    assert total == pytest.approx(32.0, abs=1.2)


@pytest.mark.long
def test_a_bar_is_turned_by_one_pad_ahead_and_one_back():
    def turn(env, seen):
        rest = float(seen[-1])
        side = np.clip(10.0 * rest, -1, 1)
        now = env.simulator.state.commands
        goes = [now[pad][1] / 8e-3 for pad in ("right", "left")]
        if env.simulator.state.time < 0.6:
            return (-0.5, goes[0], 0.5, goes[1])
        return (-0.5, goes[0] + 0.1 * side, 0.5, goes[1] - 0.1 * side)

    total, ends, info = run("PinchAndTurn", turn)
    assert ends == (True, False)
    assert info["turn"] == pytest.approx(info["angle"], abs=0.02)
    assert total == pytest.approx(np.degrees(abs(info["angle"])), abs=np.degrees(0.02))


@pytest.mark.long
def test_a_tip_reaches_its_goal_by_the_tendons_of_that_side():
    def pull(env, seen):
        x, y = env.task.goal[:2] / 16e-3  # what 8 mm of one tendon reach
        return np.clip(2.0 * np.array([x, -x, y, -y]).clip(0, 1) - 1.0, -1, 1)

    for seed in range(3):
        total, ends, info = run("Reach", pull, seed=seed)
        assert ends == (False, True)
        assert info["distance"] < 3e-3
        assert total < 0.0


@pytest.mark.long
def test_a_body_crawls_forward_or_back_by_the_order_of_its_halves():
    def gait(lag):
        def policy(env, _):
            turn = 2.0 * np.pi * (env.simulator.state.time / 2.0 + np.array([0.0, lag]))
            return -np.cos(turn)

        return policy

    forward, ends, info = run("Crawl", gait(0.25), episode="6 s")
    assert ends == (False, True)
    assert forward == pytest.approx(1e3 * info["x"], abs=1e-6)
    back, *_ = run("Crawl", gait(-0.25), episode="6 s")
    # Two mirrored gaits of a symmetric body, but for the way from rest into the gait.
    assert forward > 10.0
    assert back < -5.0
