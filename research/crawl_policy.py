"""A policy that crawls, learned in ``VoxSoft/Crawl-v0``, beside the best sine gait.

``pip install 'voxsoft[environments]' stable-baselines3 pillow``, then

- ``python research/crawl_policy.py sine`` tries gaits of two sines: periods, phases and strokes;
- ``python research/crawl_policy.py train one`` trains soft actor-critic for three seeds, one after
  the other, on one thread, and keeps returns and the policies in `research/crawl_policy`; ``train
  many 0`` does so for one seed, with another friction and another stiffness in each episode;
- ``python research/crawl_policy.py fine`` repeats the best sine and the policies with four steps of
  25 ms in each period, in place of one of 100 ms, and with other friction: a gait that lives on
  large steps would not survive;
- ``python research/crawl_policy.py figure`` draws `docs/images/crawl_policy.png`;
- ``python research/crawl_policy.py video`` draws `docs/images/crawl_policy.gif`.

A return is the way in mm of one episode of 10 s.
"""

from __future__ import annotations

import os

# One core, for the simulation and for the learner; read when they start their threads.
os.environ["RAYON_NUM_THREADS"] = "1"

import csv
import itertools
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

import gymnasium
import numpy as np

from voxsoft.environments import Randomization

ROOT = Path(__file__).parents[1]
KEPT = ROOT / "research" / "crawl_policy"
SEEDS = (0, 1, 2)
#: Steps of training of each seed, and between two episodes without exploration.
STEPS, BETWEEN = 9_000, 900
#: Seeds of actions that are shaken.
SHAKEN = (1, 2, 3, 4)
#: Text of an array with all of its numbers.
_ALL = {"threshold": 10**9, "separator": ",", "max_line_width": 10**9, "floatmode": "unique"}

#: Robots of the training: one alone, or another in each episode.
WAYS = {
    "one": {},
    "many": {"randomize": Randomization(parameters={"friction": (0.3, 0.8)}, spread=0.2)},
}

Policy = Callable[[np.ndarray, int], np.ndarray]


def environment(**options):
    """The environment."""
    return gymnasium.make("VoxSoft/Crawl-v0", **options)


def episode(env, policy: Policy, shaken: int | None = None) -> float:
    """Return of one episode under a policy of observation and step.

    Actions may be shaken by a millionth, by numbers of a seed.
    """
    seen, _ = env.reset(seed=0)
    shakes = np.random.default_rng(shaken).standard_normal((1000, 2)) * 1e-6
    total, step, over = 0.0, 0, False
    while not over:
        action = policy(seen, step) + (0.0 if shaken is None else shakes[step])
        seen, reward, terminated, truncated, _ = env.step(action)
        total, step, over = total + reward, step + 1, terminated or truncated
    return total


def gait(period: float, lag: float, stroke: float, middle: float) -> Policy:
    """Two sines, the front one a lag of the period ahead; a period in s, stroke and middle of 1.

    Beyond a stroke of 1 they are clipped, up to steps from low to high.
    """

    def policy(_: np.ndarray, step: int) -> np.ndarray:
        turn = 2.0 * np.pi * (0.1 * step / period + np.array([0.0, lag]))
        return np.clip(middle - stroke * np.cos(turn), -1.0, 1.0).astype(np.float32)

    return policy


def scan() -> None:
    """Try sine gaits, and keep their returns."""
    env = environment()
    ways = itertools.product(
        (0.8, 1.0, 1.4, 2.0), (0.125, 0.1875, 0.25, 0.3125), (0.6, 1.0, 1.5, 3.0), (0.0,)
    )
    with (KEPT / "sine.csv").open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["period", "lag", "stroke", "middle", "return_mm"])
        for way in ways:
            rows.writerow([*way, round(episode(env, gait(*way)), 2)])
            file.flush()


def train(way: str, *seeds: str) -> None:
    """Train seeds, or all; keep the returns of episodes and the policies."""
    import torch
    from stable_baselines3 import SAC
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.monitor import Monitor
    from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

    torch.set_num_threads(1)

    class Keep(BaseCallback):
        """Write the return of each training episode, and of some without exploration."""

        def __init__(self, seed: int, rows) -> None:
            super().__init__()
            self.seed, self.rows, self.test = seed, rows, environment()

        def _on_step(self) -> bool:
            for info in self.locals["infos"]:
                if "episode" in info:
                    self.write("training", info["episode"]["r"])
            if self.num_timesteps % BETWEEN == 0:
                self.write("policy", episode(self.test, acting(self.model, self.training_env)))
            return True

        def write(self, kind: str, value: float) -> None:
            seconds = round(time.process_time() - begun)
            self.rows.writerow([self.seed, self.num_timesteps, kind, round(value, 2), seconds])
            file.flush()

    with (KEPT / f"returns_{way}.csv").open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["seed", "step", "kind", "return_mm", "processor_seconds"])
        for seed in map(int, seeds or SEEDS):
            begun = time.process_time()
            env = VecNormalize(
                DummyVecEnv([lambda: Monitor(environment(**WAYS[way]))]), norm_reward=False
            )
            model = SAC(
                "MlpPolicy",
                env,
                learning_rate=1e-3,
                gamma=0.97,
                learning_starts=400,
                batch_size=128,
                use_sde=True,
                policy_kwargs={"net_arch": [64, 64]},
                seed=seed,
            )
            model.learn(STEPS, callback=Keep(seed, rows))
            keep_policy(model, env, KEPT / f"policy_{way}_{seed}.json")


def acting(model, normalized) -> Policy:
    """The policy of a model without exploration."""

    def policy(seen: np.ndarray, _: int) -> np.ndarray:
        return model.predict(normalized.normalize_obs(seen[None]), deterministic=True)[0][0]

    return policy


def keep_policy(model, normalized, path: Path) -> None:
    """Write the layers of the policy, and by what it scales observations."""
    weights = {name: value.numpy() for name, value in model.actor.state_dict().items()}
    layers = {
        f"{part}{index}": weights[f"{layer}.{kind}"].astype(np.float32)
        for index, layer in enumerate(("latent_pi.0", "latent_pi.2", "mu.0"))
        for part, kind in (("w", "weight"), ("b", "bias"))
    }
    scale = np.sqrt(normalized.obs_rms.var + normalized.epsilon)
    kept = {"mean": normalized.obs_rms.mean, "scale": scale} | layers
    # The shortest text of each number reads back to the same bits.
    rows = (f'"{name}": {np.array2string(v, **_ALL).replace(" ", "")}' for name, v in kept.items())
    path.write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")


def learned(way: str, seed: int) -> Policy:
    """The policy that a seed has learned, as it was kept."""
    text = (KEPT / f"policy_{way}_{seed}.json").read_text(encoding="utf-8")
    kept = {name: np.array(value) for name, value in json.loads(text).items()}

    def policy(seen: np.ndarray, _: int) -> np.ndarray:
        # Ten deviations, as the learner clips them; the last layer is clipped to 2, then squashed.
        layer = np.clip((seen - kept["mean"]) / kept["scale"], -10.0, 10.0)
        for index in (0, 1):
            layer = np.maximum(kept[f"w{index}"] @ layer + kept[f"b{index}"], 0.0)
        return np.tanh(np.clip(kept["w2"] @ layer + kept["b2"], -2.0, 2.0)).astype(np.float32)

    return policy


def best_gait() -> tuple[Policy, dict[str, float]]:
    """The sine gait with the largest return, and its numbers."""
    with (KEPT / "sine.csv").open(encoding="utf-8") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    best = max(rows, key=lambda row: row["return_mm"])
    return gait(best["period"], best["lag"], best["stroke"], best["middle"]), best


def fine() -> None:
    """Repeat the best gait and the policies: other steps of time, other friction, shaken."""
    ways = {
        "as learned": {},
        "25 ms steps": {"substeps": 4},
        "friction 0.3": {"randomize": Randomization(parameters={"friction": (0.2999, 0.3001)})},
        "friction 0.8": {"randomize": Randomization(parameters={"friction": (0.7999, 0.8001)})},
    }
    policies = {"sine": best_gait()[0]}
    policies |= {
        f"{way} {seed}": learned(way, seed)
        for way in WAYS
        for seed in SEEDS
        if (KEPT / f"policy_{way}_{seed}.json").exists()
    }
    with (KEPT / "fine.csv").open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["policy", *ways, *(f"shaken {shaken}" for shaken in SHAKEN)])
        for name, policy in policies.items():
            found = [episode(environment(**options), policy) for options in ways.values()]
            found += [episode(environment(), policy, shaken) for shaken in SHAKEN]
            rows.writerow([name, *(round(each, 2) for each in found)])
            file.flush()


def figure() -> None:
    """Draw the learning curves beside the best sine gait."""
    from matplotlib.figure import Figure

    from voxsoft.plot.style import SERIES

    with (KEPT / "returns_one.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    drawn = Figure(figsize=(7.0, 4.0), layout="constrained")
    axes = drawn.add_subplot()
    for seed, color in zip(SEEDS, SERIES, strict=False):
        for kind, style in (("training", {"lw": 0.7, "alpha": 0.5}), ("policy", {"marker": "o"})):
            own = [r for r in rows if int(r["seed"]) == seed and r["kind"] == kind]
            label = f"seed {seed}" if kind == "policy" else None
            steps, returns = ([float(r[key]) for r in own] for key in ("step", "return_mm"))
            axes.plot(steps, returns, color=color, label=label, **style)
    _, sine = best_gait()
    label = f"best sine gait ({sine['period']:g} s, lag {sine['lag']:g})"
    axes.axhline(sine["return_mm"], color="black", ls="--", lw=1.0, label=label)
    axes.set_xlabel("steps of 0.1 s")
    axes.set_ylabel("way in an episode of 10 s (mm)")
    axes.legend(frameon=False)
    drawn.savefig(ROOT / "docs" / "images" / "crawl_policy.png", dpi=110)


def video() -> None:
    """Draw an episode of the best policy above one of the best sine gait."""
    from PIL import Image

    ends = {seed: episode(environment(), learned("one", seed)) for seed in SEEDS}
    ways = [learned("one", max(ends, key=ends.__getitem__)), best_gait()[0]]
    films = []
    for policy in ways:
        env = environment(render_mode="rgb_array")
        seen, _ = env.reset(seed=0)
        frames = [env.render()]
        for step in range(100):
            seen, *_ = env.step(policy(seen, step))
            frames.append(env.render())
        films.append(frames)
    pictures = [Image.fromarray(np.concatenate(pair)) for pair in zip(*films, strict=True)]
    palette = pictures[50].quantize(48)
    drawn = [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures]
    place = ROOT / "docs" / "images" / "crawl_policy.gif"
    drawn[0].save(place, save_all=True, append_images=drawn[1:], duration=100, loop=0)


if __name__ == "__main__":
    verbs = {"sine": scan, "train": train, "fine": fine, "figure": figure, "video": video}
    verbs[sys.argv[1]](*sys.argv[2:])
