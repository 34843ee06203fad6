#!/usr/bin/env bash
# MuJoCo 4.0.0: pinned nodes of a trilinear flexcomp give their mass to the nodes beside them.
#
# The reference says of the mass of a flexcomp: "The mass of each automatically-generated body equals
# this value divided by the number of points. Note that pinning some points does not affect the mass
# of the other bodies." Seen: with dof="trilinear" half of the nodes pinned double the masses of the
# others, and their sum stays that of all, so that a clamped body weighs more than it does; with
# full dofs masses are as the reference says. Exits 1 where that has changed.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
  mujoco-core==4.0.0 numpy==2.2.6
cd "$folder"

venv/bin/python - <<'SCRIPT'
import sys

import mujoco

print("MuJoCo", mujoco.__version__)
BAR = """<mujoco><worldbody><flexcomp name="bar" type="grid" dim="3" count="4 2 2" spacing="1 1 1"
 mass="1.6" radius="0.001" {dof}><elasticity young="1e5"/>{pin}</flexcomp></worldbody></mujoco>"""
PIN = '<pin gridrange="0 0 0 1 1 1"/>'


def masses(dof, pin):
    model = mujoco.MjModel.from_xml_string(BAR.format(dof=dof, pin=pin))
    return {model.body(body).name: float(model.body_mass[body]) for body in range(1, model.nbody)}


ratios = {}
for name, dof in (("full", ""), ("trilinear", 'dof="trilinear" cellcount="3 1 1"')):
    free, pinned = masses(dof, ""), masses(dof, PIN)
    ratios[name] = {round(pinned[body] / free[body], 6) for body in pinned}
    print(f"{name}: {len(free)} bodies of {sum(free.values()):g}; half of them pinned, the others")
    print(f"  have {sum(pinned.values()):g}, each {ratios[name]} times its mass before")
sys.exit(0 if ratios == {"full": {1.0}, "trilinear": {2.0}} else 1)
SCRIPT
