"""Bend a PneuNet actuator by pulses of pressure: 200 steps of 20 ms, the valve open half the time.

``python examples/pulse.py [pressure]``; each line tells of one pulse.
"""

import sys

import voxsoft as vs
from voxsoft.design import families

pressure = sys.argv[1] if len(sys.argv) > 1 else "2 kPa"
simulator = vs.Simulator(families.pneunet(chambers=3), damping="10 1/s")
print(" pulse   bends to   after    breathes    swings on by")
for pulse in range(5):
    open_ = [simulator.step({"pressure": pressure}) for _ in range(20)]
    closed = [simulator.step({"pressure": 0.0}) for _ in range(20)]
    for seen in (*open_, *closed):
        if seen.status in ("inverted", "diverged"):
            raise SystemExit(f"{seen.time:.2f} s: {seen.message}")
    down = [-1e3 * seen.probes["tip"][2] for seen in open_]
    back = [1e3 * seen.probes["tip"][2] for seen in closed]
    delay = 0.02 * (down.index(max(down)) + 1)
    air = 1e6 * (open_[-1].chambers[0].volume - closed[-1].chambers[0].volume)
    print(f"{pulse:6} {max(down):7.2f} mm {delay:5.2f} s {air:8.3f} ml {max(back):10.2f} mm")
