"""Environments of Gymnasium: spaces, seeds, ends, drives, pictures."""

import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import voxsoft as vs
from voxsoft.design import families
from voxsoft.environments import Drive, SoftRobotEnv, Task
from voxsoft.environments.environment import _BROKEN
from voxsoft.errors import DesignError, SimulationError

NAMES = ("Crawl", "Lift", "Peg", "PinchAndTurn", "Reach")
#: All that the checker finds fails, but for observations without bounds.
FINDINGS = pytest.mark.filterwarnings(
    "error", "ignore:.*A Box observation space m.* value is -?infinity"
)
CUP = families.cylinder(radius="20 mm", height="30 mm")


class Rise(Task):
    """Lift the top; shown its height, and done above a height."""

    def __init__(self, done=np.inf):
        self.done, self.started = done, []

    def start(self, seen, generator, options):
        self.started.append((float(generator.uniform()), dict(options)))

    def shown(self, seen):
        return {"height": 1e3 * float(seen.probes["top"][2])}

    def reward(self, before, after):
        return 1e3 * float(after.probes["top"][2] - before.probes["top"][2])

    def is_done(self, seen):
        return seen.probes["top"][2] > self.done


class Still(Task):
    def reward(self, before, after):
        return 0.0


def rise(done=np.inf, **options):
    return SoftRobotEnv(CUP, Rise(done), **({"sensors": ["probes.top"]} | options))


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
@FINDINGS
def test_gymnasium_finds_nothing_wrong(name):
    env = gymnasium.make(f"VoxSoft/{name}-v0", render_mode="rgb_array")
    check_env(env.unwrapped)


@FINDINGS
def test_gymnasium_finds_nothing_wrong_with_an_own_task():
    check_env(rise(), skip_render_check=True)


@pytest.mark.long
@pytest.mark.parametrize("name", NAMES)
def test_a_seed_decides_all_bits(name):
    def run(seed):
        env = gymnasium.make(f"VoxSoft/{name}-v0")
        env.action_space.seed(7)
        seen, _ = env.reset(seed=seed)
        found = [seen]
        for _ in range(3):
            seen, reward, terminated, truncated, _ = env.step(env.action_space.sample())
            assert seen in env.observation_space
            assert np.isfinite(seen).all()
            assert np.isfinite(reward)
            found += [seen, np.float64(reward)]
            assert not terminated
            assert not truncated
        return b"".join(each.tobytes() for each in found)

    once, again, other = run(1), run(1), run(2)
    assert once == again
    # Lift and Crawl draw nothing.
    assert (once == other) == (name in ("Lift", "Crawl"))


def test_an_observation_has_sensors_then_drives_then_numbers_of_the_task():
    env = rise()
    assert env.seen == (
        ("probes.top.x", "mm"),
        ("probes.top.y", "mm"),
        ("probes.top.z", "mm"),
        ("pressure", "1"),
        ("height", "1"),
    )
    env.reset(seed=0)
    seen, reward, *_ = env.step(np.array([0.5], np.float32))
    state = env.simulator.state
    # float32 keeps seven digits.
    assert seen[2] == pytest.approx(1e3 * state.probes["top"][2], rel=1e-6)
    assert seen[4] == pytest.approx(seen[2], rel=1e-6)
    assert seen[3] == pytest.approx(0.5, rel=1e-6)
    assert reward == pytest.approx(seen[2], rel=1e-6)
    assert seen.dtype == np.float32


def test_an_action_spans_the_bounds_of_a_drive():
    env = rise(drives={"pressure": ("1 kPa", "3 kPa")})
    values = [env.physical(np.array([each]))["pressure"] for each in (-1.0, 0.0, 1.0)]
    assert values == [1e3, 2e3, 3e3]
    env.reset(seed=0)
    env.step(np.array([1.0], np.float32))
    assert env.simulator.state.commands["pressure"] == 3e3
    # Beyond 1 it counts as 1.
    env.step(np.array([7.0], np.float32))
    assert env.simulator.state.commands["pressure"] == 3e3


def test_a_drive_goes_no_quicker_than_its_rate():
    drive = Drive(command="pressure", low=0, high="3 kPa", rate="5 kPa")
    env = rise(drives=[drive], period="0.1 s", substeps=2)
    env.reset(seed=0)
    found = [env.step(np.array([share], np.float32))[4]["pressure"] for share in (1, 1, -1)]
    assert found == pytest.approx([500.0, 1000.0, 500.0])


def test_a_component_of_a_vector_is_a_drive():
    env = gymnasium.make("VoxSoft/Lift-v0").unwrapped
    assert [each.name for each in env.channels] == ["fingers", "flange.z"]
    env.reset(seed=0)
    env.step(np.array([-1.0, 1.0], np.float32))
    assert env.simulator.state.commands["flange"] == pytest.approx((0.0, 0.0, 1.5e-3))


def test_an_episode_is_truncated_after_its_time():
    env = rise(episode="0.3 s")
    env.reset(seed=0)
    ends = [env.step(np.array([0.0], np.float32))[2:4] for _ in range(3)]
    assert ends == [(False, False), (False, False), (False, True)]
    with pytest.raises(SimulationError, match=r"call reset\(\)"):
        env.step(np.array([0.0], np.float32))
    env.reset()
    assert env.step(np.array([0.0], np.float32))[2:4] == (False, False)


def test_an_episode_is_terminated_by_its_task():
    env = rise(done=1e-9)
    env.reset(seed=0)
    assert env.step(np.array([1.0], np.float32))[2:4] == (True, False)


@pytest.mark.long
def test_a_body_that_breaks_truncates_its_episode_without_a_reward():
    # Ten times the modulus blows the wall up.
    env = rise(done=1e-9, drives={"pressure": (0, "600 kPa")})
    env.reset(seed=0)
    _, reward, terminated, truncated, info = env.step(np.array([1.0], np.float32))
    assert info["status"] in _BROKEN
    assert (reward, terminated, truncated) == (0.0, False, True)


def test_a_body_settles_before_an_episode():
    env = SoftRobotEnv(families.beam(), Still(), drives={"gravity": (0, 9.81)}, settle="0.3 s")
    assert env.reset(seed=0)[1]["time"] == 0.0
    assert env.simulator.state.time == pytest.approx(0.3)
    assert env.simulator.state.probes["station-9"][2] < -1e-3


def test_a_task_gets_options_and_numbers_that_the_seed_decides():
    env = rise()
    env.reset(seed=5, options={"goal": 1})
    env.reset(seed=5)
    (first, options), (second, _) = env.task.started[-2:]
    assert options == {"goal": 1}
    assert first == second


def test_noise_of_sensors_follows_the_seed():
    noisy = vs.Sensor(of="probes.top", noise="1 mm")
    env = rise(sensors=[noisy])

    def seen(seed):
        env.reset(seed=seed)
        return env.step(np.array([0.0], np.float32))[0].tobytes()

    assert seen(1) == seen(1) != seen(2)


def test_a_goal_may_be_given():
    env = gymnasium.make("VoxSoft/Reach-v0")
    _, info = env.reset(seed=0, options={"goal": (0.003, 0.004, 0.0)})
    assert info["distance"] == pytest.approx(5e-3)
    with pytest.raises(SimulationError, match="is no displacement"):
        env.reset(options={"goal": 3.0})


def test_a_picture_shows_one_room_for_all_of_an_episode():
    env = rise(render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    env.step(np.array([1.0], np.float32))
    second = env.render()
    assert first.dtype == np.uint8
    assert first.shape == second.shape
    assert (first != second).any()
    assert rise().render() is None


@pytest.mark.parametrize(
    ("options", "where"),
    [
        ({"drives": ["presure"]}, r"drives\[0\].command"),
        ({"drives": {"pressure": (0, "5 mm")}}, r"drives\[0\].high"),
        ({"drives": {"pressure": (2e3, 1e3)}}, r"drives\[0\]: has the bounds"),
        ({"drives": [Drive(command="pressure", rate=0)]}, r"drives\[0\].rate"),
        ({"drives": [Drive(command="pressure", axis="x")]}, r"drives\[0\].axis"),
        ({"drives": []}, "drives: are none"),
        ({"sensors": ["probes.bottom"]}, "sensors"),
        ({"substeps": 0}, "substeps"),
        ({"episode": "10 ms"}, "episode"),
        ({"render_mode": "human"}, "render_mode"),
    ],
)
def test_an_impossible_setting_is_an_error_of_the_design(options, where):
    with pytest.raises(DesignError, match=where):
        rise(**options)


@pytest.mark.parametrize("action", [np.zeros(2), np.array([np.nan]), np.array(0.0)])
def test_an_invalid_action_moves_nothing(action):
    env = rise()
    env.reset(seed=0)
    with pytest.raises(SimulationError, match="is no action"):
        env.step(action)
    assert env.simulator.state.time == 0.0


def test_a_step_without_an_episode_is_an_error():
    with pytest.raises(SimulationError, match="no episode"):
        rise().step(np.array([0.0], np.float32))


@pytest.mark.long
def test_the_import_without_gymnasium_says_how_to_get_it():
    code = """
import sys
sys.modules["gymnasium"] = None
import voxsoft as vs
vs.Simulator
try:
    import voxsoft.environments
except vs.errors.MissingPackageError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'voxsoft[environments]'" in done.stdout


@pytest.mark.long
def test_the_import_in_the_name_is_enough():
    name = "voxsoft.environments:VoxSoft/Reach-v0"
    code = f"import gymnasium; print(gymnasium.make({name!r}).spec.id)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "VoxSoft/Reach-v0"
