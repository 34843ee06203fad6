"""The guard before large bodies knows the limits of containers, schedulers and shells."""

import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from voxsoft import _memory
from voxsoft._cgroups import free_in_groups
from voxsoft._memory import memory_limit, shortage

GB = 1 << 30


def tree(root, groups, files):
    """Write a faked ``/proc/self/cgroup`` and the files of the groups."""
    (root / "proc/self").mkdir(parents=True)
    (root / "proc/self/cgroup").write_text("\n".join(groups) + "\n")
    for name, content in files.items():
        file = root / "sys/fs/cgroup" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"{content}\n")
    return root


def v2(path, limit, current, **more):
    named = {"memory.max": limit, "memory.current": current, **more}
    return {f"{path}/{name.replace('_', '.', 1)}".lstrip("/"): v for name, v in named.items()}


def v1(path, limit, used, stat="total_inactive_file 0"):
    names = {"limit_in_bytes": limit, "usage_in_bytes": used, "stat": stat}
    return {f"memory{path}/memory.{name}": value for name, value in names.items()}


@pytest.mark.parametrize(
    ("groups", "files", "free"),
    [
        ([], {}, None),
        (["0::/"], {}, None),
        (["0::/job"], v2("job", "max", GB), None),
        (["0::/job"], v2("job", 4 * GB, GB), 3 * GB),
        # Cache that was not used lately gives way.
        (["0::/job"], v2("job", 4 * GB, 3 * GB, memory_stat=f"anon 5\ninactive_file {GB}"), 2 * GB),
        # Above `high` a process is slowed down.
        (["0::/job"], v2("job", 4 * GB, GB, memory_high=2 * GB), GB),
        (["0::/job"], v2("job", "max", GB, memory_high=2 * GB), GB),
        # The least of all groups around it, as Slurm has one for the job and one for the step.
        (["0::/job/step"], v2("job/step", 8 * GB, 0) | v2("job", 3 * GB, GB), 2 * GB),
        # A container sees its group as the root, under a path of the host.
        (["0::/../../pod/abc"], v2("", 2 * GB, GB), GB),
        (["0::/unknown/to/it"], v2("", 2 * GB, GB), GB),
        (["4:memory:/job"], v1("/job", 4 * GB, GB), 3 * GB),
        (["4:memory:/job"], v1("/job", 4 * GB, GB, f"total_inactive_file {GB // 2}"), 7 * GB // 2),
        (["9:cpu,memory:/docker/abc"], v1("", 4 * GB, GB), 3 * GB),
        # Both versions at once, as systemd can mount them; other controllers do not count.
        (["4:memory:/job", "1:cpu:/job", "0::/"], v1("/job", 4 * GB, GB), 3 * GB),
        (["0::/job"], {f"unified/{k}": v for k, v in v2("job", 2 * GB, 0).items()}, 2 * GB),
        (["0::/job"], v2("job", GB, 2 * GB), 0),
        (["0::/job"], v2("job", "no number", GB), None),
    ],
)
def test_control_groups_are_read(tmp_path, groups, files, free):
    assert free_in_groups(tree(tmp_path, groups, files)) == free


def test_the_least_of_machine_groups_and_process_counts(monkeypatch):
    machine = psutil.virtual_memory().available
    monkeypatch.setattr(_memory, "free_in_groups", lambda: 12_345)
    assert _memory._read() == 12_345
    monkeypatch.setattr(_memory, "free_in_groups", lambda: None)
    assert 0 < _memory._read() <= machine + GB


def test_large_requests_are_not_judged_by_an_old_answer(monkeypatch):
    before = memory_limit()
    monkeypatch.setattr(_memory, "_read", lambda: 0)
    monkeypatch.setattr(_memory._Reading, "time", float("inf"))
    assert shortage(1e6) == ""
    assert "0 GB" in shortage(0.5 * before)


def test_no_other_system_needs_the_limits_of_unix(monkeypatch):
    monkeypatch.setitem(sys.modules, "resource", None)
    assert list(_memory._free_to_process()) == []


BOX = """
name = "box"
voxel_size = "= size"
parameters = { size = "VOXEL" }
shapes = { body = { kind = "box", size = ["100 mm", "100 mm", "100 mm"] } }
clamps = [{ region = { z = [0, 0] } }]
loads = [{ kind = "gravity" }]
[materials]
m = { model = "neo-hookean", young = "100 kPa", poisson = 0.3, density = "1000 kg/m^3" }
[[parts]]
shape = "body"
material = "m"
"""


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="ulimit -v counts on Linux only")
@pytest.mark.parametrize(
    ("verb", "voxel", "words"),
    [
        pytest.param("mesh", "0.8 mm", "counting the quality of", marks=pytest.mark.slow),
        ("mesh", "0.4 mm", "needs about"),
        pytest.param("run", "0.9 mm", "the problem of", marks=pytest.mark.slow),
        ("run", "0.05 mm", "a grid of"),
    ],
)
def test_commands_that_the_shell_forbids_are_refused_in_words(tmp_path, verb, voxel, words):
    design = tmp_path / "box.toml"
    design.write_text(BOX.replace("VOXEL", voxel))
    program = f"{sys.executable} -c 'from voxsoft.cli import main; main()'"
    call = f"ulimit -v 1500000; exec {program} {verb} {design}"
    outcome = subprocess.run(["bash", "-c", call], capture_output=True, text=True, cwd=tmp_path)
    assert outcome.returncode == 3, outcome.stderr[-500:]
    assert words in outcome.stderr
    assert "GB" in outcome.stderr or "bytes" in outcome.stderr
    assert "Traceback" not in outcome.stderr
