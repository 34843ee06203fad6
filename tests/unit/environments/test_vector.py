"""Many environments at a time have the bits of each alone."""

import multiprocessing

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from voxsoft.environments import ThreadVectorEnv
from voxsoft.environments.reach import reach
from voxsoft.errors import SimulationError

ACTIONS = np.random.default_rng(0).uniform(-1, 1, (6, 2, 4)).astype(np.float32)


def alone(index):
    """Return what one environment gives for its share of the actions, with a reset at its end."""
    env = gymnasium.make("VoxSoft/Reach-v0", episode="0.3 s")
    seen, _ = env.reset(seed=4 + index)
    rows, over = [(seen, 0.0, False, False)], False
    for action in ACTIONS[:, index]:
        if over:
            rows.append((env.reset()[0], 0.0, False, False))
            over = False
        else:
            rows.append(env.step(action)[:4])
            over = rows[-1][2] or rows[-1][3]
    return rows


def assert_alike(envs):
    seen, _ = envs.reset(seed=4)
    found = [(seen, np.zeros(2), np.zeros(2, bool), np.zeros(2, bool))]
    found += [envs.step(actions)[:4] for actions in ACTIONS]
    envs.close()
    for index in range(2):
        for row, (seen, reward, terminated, truncated) in zip(found, alone(index), strict=True):
            assert row[0][index].tobytes() == seen.tobytes()
            assert row[1][index] == reward
            assert (row[2][index], row[3][index]) == (terminated, truncated)
    assert any(row[3].any() for row in found)


def test_threads_give_the_bits_of_each_alone():
    envs = gymnasium.make_vec("VoxSoft/Reach-v0", num_envs=2, episode="0.3 s")
    assert isinstance(envs, ThreadVectorEnv)
    assert_alike(envs)


@pytest.mark.long
@pytest.mark.parametrize(("mode", "options"), [("sync", {}), ("async", {"context": "spawn"})])
def test_processes_and_turns_give_the_bits_of_each_alone(mode, options):
    assert_alike(
        gymnasium.make_vec(
            "VoxSoft/Reach-v0",
            num_envs=2,
            vectorization_mode=mode,
            vector_kwargs=options,
            episode="0.3 s",
        )
    )


def test_a_fork_says_that_it_cannot_go_on_and_does_not_wait():
    reach()  # the core has its threads
    child, parent = multiprocessing.Pipe()

    def make():
        try:
            reach()
        except SimulationError as error:
            parent.send(str(error))

    process = multiprocessing.get_context("fork").Process(target=make)
    process.start()
    assert child.poll(60)
    assert '"context": "spawn"' in child.recv()
    process.join()


def test_the_last_step_resets_too_where_that_is_asked_for():
    envs = gymnasium.make_vec(
        "VoxSoft/Reach-v0",
        num_envs=2,
        episode="0.1 s",
        autoreset_mode=AutoresetMode.SAME_STEP,
    )
    first, _ = envs.reset(seed=4)
    seen, _, _, truncated, infos = envs.step(ACTIONS[0])
    assert truncated.all()
    # The drives are back where they begin, and the last observation is told.
    assert (seen[:, 6:10] == -1.0).all()
    assert (infos["final_obs"][0][6:10] > -1.0).any()
    assert first.shape == seen.shape == envs.observation_space.shape
    envs.close()


def test_infos_hold_an_entry_for_each():
    envs = ThreadVectorEnv([reach, reach], threads=1)
    _, infos = envs.reset(seed=[7, None])
    assert infos["distance"].shape == (2,)
    assert infos["_distance"].all()
    envs.close()


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda: ThreadVectorEnv([]), "makes no environment"),
        (lambda: ThreadVectorEnv([reach], autoreset_mode="Disabled"), "autoreset_mode"),
        (lambda: ThreadVectorEnv([reach, lambda: reach(sensors=())]), "has other spaces"),
        (lambda: ThreadVectorEnv([reach]).reset(seed=[1, 2]), "are 2, for 1"),
        (lambda: ThreadVectorEnv([reach]).step(ACTIONS[0]), "have 2 rows, for 1"),
    ],
)
def test_impossible_vectors_are_errors(call, what):
    with pytest.raises(SimulationError, match=what):
        call()
