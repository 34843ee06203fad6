"""The table of features and uses: supported pairs run, and refused ones give the reason."""

import itertools
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.comparison import confirm, refined
from voxsoft.comparison.bricks import BrickModel
from voxsoft.errors import VoxSoftError
from voxsoft.simulation import Setup, check
from voxsoft.simulation.compatibility import (
    REASONS,
    USES,
    reason_of,
    refusals,
    refused_together,
)
from voxsoft.simulation.features import FEATURES, IMPLIED, has_feature
from voxsoft.simulation.runs.state import result_at
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.html import page_of

RUBBER = {"model": "neo-hookean", "young": "100 kPa", "poisson": 0.45, "density": "1070 kg/m^3"}
RELAXING = {**RUBBER, "prony": [{"g": 0.2, "tau": "0.1 s"}]}
LATTICE = "ecoflex-00-30-lattice"


def box(size, corner):
    return {"kind": "box", "size": size, "corner": corner}


OUTER = box(["= length", "20 mm", "20 mm"], [0, "-10 mm", 0])
VOID = box(["10 mm", "10 mm", "10 mm"], ["5 mm", "-5 mm", "5 mm"])
# A surface that cuts voxels.
ROUND = {"kind": "sphere", "radius": "6 mm", "center": ["10 mm", 0, "10 mm"]}
SHAPES = {
    "outer": OUTER,
    "void": VOID,
    "whole": {"kind": "difference", "of": ["outer", "void"]},
    "post": box(["10 mm", "20 mm", "10 mm"], ["10 mm", "-10 mm", "21 mm"]),
    "tool": box(["10 mm", "20 mm", "10 mm"], ["10 mm", "-10 mm", "-12 mm"]),
}
PRESSURE = {"kind": "pressure", "value": "1 kPa"}
GRAVITY = {"kind": "gravity"}
RAMP = {"time": [0, "0.2 s"], "factor": [0, 1]}
POST = {"name": "post", "shape": "post"}
STRAIN = {"part": "soft", "kind": "strain", "value": 0.02}
PROFILE = {"axis": "z", "at": ["0 mm", "20 mm"], "factor": [0, 1]}
SHEET = {
    "part": "soft",
    "kind": "dielectric",
    "value": "1 MV/m",
    "permittivity": 2.8,
    "normal": [0, 0, 1],
}
CHAMBER = {
    "chambers": {"c": {"point": ["10 mm", 0, "10 mm"]}},
    "supplies": [{"chamber": "c", "kind": "volume", "value": "0.05 mL"}],
    "loads": [],
}
FIBER = {"direction": [1, 0, 0], "modulus": "0.2 MPa"}
WOUND = {"axis": "x", "angle": "60 deg", "modulus": "0.2 MPa", "center": [0, 0, "10 mm"]}
# A wound tube has no end walls of its own.
TUBE = {
    **SHAPES,
    "void": box(["= length", "10 mm", "10 mm"], [0, "-5 mm", "5 mm"]),
    "plug": box(["5 mm", "10 mm", "10 mm"], [0, "-5 mm", "5 mm"]),
    "cap": box(["5 mm", "10 mm", "10 mm"], ["15 mm", "-5 mm", "5 mm"]),
}
TENDON = {"through": [[0, 0, "17.5 mm"], ["20 mm", 0, "17.5 mm"]], "tension": "20 mN"}
SPRING = {
    "at": {"point": ["20 mm", 0, "10 mm"]},
    "anchor": ["20 mm", 0, "60 mm"],
    "stiffness": "5 N/m",
}
PLANES = [{"plane": "y"}]


def soft(**changes):
    return {"name": "soft", "shape": "whole", "material": RUBBER, **changes}


def two(**changes):
    """Two bodies, the second above the first."""
    above = box(["20 mm", "20 mm", "10 mm"], [0, "-10 mm", "25 mm"])
    second = {"shape": above, "material": RUBBER}
    return {
        "bodies": [{"name": "main"}, {"name": "other", "parts": [second]}],
        "parts": [soft(body="main", **changes)],
        "clamps": [{"region": {"x": [0, 0], "body": name}} for name in ("main", "other")],
        "probes": {"tip": {"x": ["20 mm", "20 mm"], "body": "main"}},
    }


def activated(**changes):
    return {"activations": [{**STRAIN, **changes}], "loads": []}


#: Entries that give the base design a feature, by its name in the table.
SAMPLES = {
    "gravity": {"loads": [GRAVITY]},
    "pressure": {},
    "force": {
        "loads": [{"kind": "force", "region": {"x": ["20 mm", "20 mm"]}, "value": [0, 0, "5 mN"]}]
    },
    "traction": {
        "loads": [
            {"kind": "traction", "region": {"z": ["20 mm", "20 mm"]}, "value": [0, 0, "20 Pa"]}
        ]
    },
    "magnetic field": {
        "loads": [{"kind": "magnetic_field", "value": [0, 0, "5 mT"]}],
        "parts": [soft(remanence=["20 mT", 0, 0])],
    },
    "immersion": {"loads": [GRAVITY, {"kind": "immersion", "level": "0.1 m"}]},
    "drag": {"loads": [GRAVITY, {"kind": "drag", "linear": "1 mm/s", "flow": [0, 0, "10 cm/s"]}]},
    "force field": {
        "loads": [{"kind": "force_field", "acceleration": ["-2*vx", "4*y", "-9.81 + 20*z"]}]
    },
    "load over time": {"loads": [{**PRESSURE, "history": RAMP}]},
    "floor": {"loads": [GRAVITY], "floor": {"z": "-1 mm"}},
    "contact": {"contact": {"friction": 0.2}},
    "objects": {"objects": [POST]},
    "free objects": {
        "loads": [GRAVITY],
        "objects": [{**POST, "motion": "free", "mass": "0.2 g"}],
        "solver": {"method": "statics"},
        "contact": {"friction": 0.5},
    },
    "objects that turn": {
        "objects": [
            {
                "name": "tool",
                "shape": "tool",
                "motion": {"rotation": {"axis": [0, 1, 0], "angle": "2 deg"}},
            }
        ]
    },
    "adhesion": {"contact": {"adhesion": {"strength": "1 kPa", "range": "1 mm"}}},
    "bonds": {
        "shapes": {
            **SHAPES,
            "post": box(["10 mm", "20 mm", "10 mm"], ["10 mm", "-10 mm", "20 mm"]),
        },
        "objects": [POST],
        "contact": {"pairs": [{"of": ["body", "post"], "kind": "bonded"}]},
    },
    "several bodies": two(),
    "tendons": {"tendons": [TENDON], "loads": []},
    "springs and the like": {"springs": [SPRING]},
    "supplies": CHAMBER,
    "layers that seal": {
        "layers": [{"region": {"z": [0, 0]}, "young": "5 MPa", "thickness": "0.1 mm", "seal": True}]
    },
    "layers": {"layers": [{"region": {"z": [0, 0]}, "young": "5 MPa", "thickness": "0.1 mm"}]},
    "fibers": {"parts": [soft(fibers=[FIBER])]},
    "wound fibers": {
        "shapes": TUBE,
        "parts": [
            soft(fibers=[WOUND, {**WOUND, "angle": "-60 deg"}]),
            *({"name": name, "shape": name, "material": RUBBER} for name in ("plug", "cap")),
        ],
    },
    "activations": activated(),
    "activations over time": activated(history=RAMP),
    "activations with a profile": activated(profile=PROFILE),
    "dielectrics": {"activations": [SHEET], "loads": []},
    "dielectrics over time": {"activations": [{**SHEET, "history": RAMP}], "loads": []},
    "softening": {
        "parts": [
            soft(material={**RUBBER, "mullins": {"r": 1.5, "m": "2 kPa", "beta": 0.1}}),
        ]
    },
    "viscosity": {"parts": [soft(material=RELAXING)]},
    "local refinement": {"refine": [{"region": {"x": [0, "5 mm"]}}]},
    "planes of symmetry": {"symmetry": PLANES},
    "cut voxels": {"fill": "fraction", "shapes": {**SHAPES, "void": ROUND}},
    "rigid parts": {
        "parts": [
            soft(),
            {
                "name": "end",
                "shape": box(["5 mm", "20 mm", "20 mm"], ["20 mm", "-10 mm", 0]),
                "material": {"model": "rigid"},
            },
        ]
    },
    "spring lattice": {"parts": [soft(material=LATTICE)]},
    "spring lattice and contact": {"parts": [soft(material=LATTICE)], "contact": {}},
    "profiles and contact": {**activated(profile=PROFILE), "contact": {}},
    "symmetry and contact": {"symmetry": PLANES, "contact": {}},
    "symmetry and friction": {"symmetry": PLANES, "contact": {"friction": 0.2}},
    "fibers of several bodies": two(fibers=[FIBER]),
    "activations of several bodies": {**two(), "activations": [STRAIN]},
}

#: Features and uses whose cells other tests run: a mesh of a file needs a file, calibrations a
#: measurement, and the code with scikit-fem that package.
FEATURES_ELSEWHERE = {"mesh of a file"}
USES_ELSEWHERE = {"calibration", "calibration along gradients", "scikit-fem"}


#: Entries that a use needs beside those of the feature.
VARIANTS = {
    "volume control": {"loads": [PRESSURE]},
    "path of activations": {"activations": [STRAIN]},
    "symmetry": {"symmetry": PLANES},
    "softening": {"parts": SAMPLES["softening"]["parts"]},
}


def design_with(feature, **more):
    return vs.Design.from_document(
        {
            "schema": "voxsoft/1",
            "name": "small",
            "voxel_size": "5 mm",
            "parameters": {
                "length": {"value": "20 mm", "min": "20 mm", "max": "30 mm", "step": "10 mm"}
            },
            "shapes": SHAPES,
            "parts": [soft()],
            "clamps": [{"region": {"x": [0, 0]}}],
            "loads": [PRESSURE],
            "probes": {"tip": {"x": ["= length", "= length"]}},
            "objectives": {"reach": {"maximize": "displacement", "probe": "tip", "axis": "z"}},
            **SAMPLES[feature],
            **more,
        }
    )


def variant(feature, use):
    own = SAMPLES[feature]
    return design_with(feature, **{k: v for k, v in VARIANTS.get(use, {}).items() if k not in own})


@cache
def at_rest(feature):
    return vs.simulate(design_with(feature), method="statics", tolerance=1e-9)


def on_live(feature, folder):
    reason = StudioBody.of(design_with(feature), 0, 0).not_live
    if reason:
        found = refusals(design_with(feature), "live motion")
        raise VoxSoftError("live", "; ".join(each.what for each in found))


def on_study(feature, folder):
    study = vs.Study(design_with(feature), {"length": ["20 mm"]}, folder=folder)
    study.grid(workers=1)


def on_confirmation(feature, folder):
    design = design_with(feature)
    if (feature, "confirmation") in REASONS:
        confirm(design, None)
    study = vs.Study(design, {"length": ["20 mm", "30 mm"]}, folder=folder)
    confirm(design, study.grid(workers=1), count=1)


def on_mesh_file(feature, folder):
    vs.save(design_with(feature), folder / "a.toml")
    asked = ["mesh", str(folder / "a.toml"), "--out", str(folder / "a.inp")]
    found = CliRunner().invoke(app, asked)
    assert found.exit_code == 0, found.output


def on_refining(feature, folder):
    design = design_with(feature)
    result = vs.simulate(design.replace(refine=()), method="statics")
    assert vs.simulate(refined(result), method="statics").status == "ok"


def on_simulator(feature, folder):
    simulator = vs.Simulator(design_with(feature))
    simulator.step()
    assert np.isfinite(simulator.state.positions).all()


def on_comparison(feature, folder):
    vs.compare(
        design_with(feature), solvers=["statics"], outside="none", voxel_sizes=[], splits=[1]
    )


def on_states(feature, folder):
    setup = Setup.of(design_with(feature))
    result_at(setup, setup.mesh.vertices)


def solved(use, **settings):
    return lambda feature, folder: vs.simulate(variant(feature, use), **settings)


#: Function for each use of the table.
CALLS = {
    "check": lambda feature, folder: check(design_with(feature)),
    "load control": solved("load control", method="statics"),
    "arc length": solved("arc length", method="statics", control="arc-length", steps=3),
    "volume control": solved("volume control", method="statics", control="volume", steps=3),
    "dynamics": solved("dynamics", method="dynamics", end_time=0.005),
    "explicit dynamics": solved("explicit dynamics", method="xpbd", end_time=0.005),
    "relaxation": solved("relaxation", method="relaxation"),
    "error bars": lambda feature, folder: vs.error_bars(at_rest(feature)),
    "gradient": lambda feature, folder: vs.gradient(
        at_rest(feature), ["reach"], ["parts.0.material.density"]
    ),
    "path": lambda feature, folder: vs.follow(design_with(feature), "time=0..0.1 s/2"),
    "path of activations": lambda feature, folder: vs.follow(
        variant(feature, "path of activations"), "activations[0].value=0.01..0.02/2"
    ),
    "study": on_study,
    "modes": lambda feature, folder: vs.modes(at_rest(feature), 2),
    "simulator": on_simulator,
    "live motion": on_live,
    "comparison": on_comparison,
    "outside codes": lambda feature, folder: BrickModel.of(Setup.of(design_with(feature)), nodes=8),
    "mesh file": on_mesh_file,
    "page": lambda feature, folder: page_of(design_with(feature)),
    "refining": on_refining,
    "confirmation": on_confirmation,
    "unsolved states": on_states,
    "symmetry": solved("symmetry", method="statics"),
    "softening": solved("softening", method="statics"),
}


def cells():
    """Every pair of a feature and a use, where the design of the use can have the feature."""
    for feature, use in itertools.product(SAMPLES, CALLS):
        taken = VARIANTS.get(use, {}).keys() & SAMPLES[feature].keys()
        if not taken or (feature, use) in REASONS:
            yield feature, use


def quick_cells():
    """All refusals by features alone, and each feature and each use that works, with one other."""
    works = [cell for cell in cells() if cell not in REASONS and cell[1] not in SLOW]
    uses = [use for use in CALLS if use not in SLOW]
    of_features = (
        (feature, uses[(7 * number) % len(uses)]) for number, feature in enumerate(SAMPLES)
    )
    of_uses = ((feature, use) for feature, use in zip(itertools.cycle(SAMPLES), uses, strict=False))
    refused = [cell for cell in cells() if cell in REASONS]
    chosen = {*of_features, *of_uses} & set(works)
    return sorted({*chosen, *refused})


#: Uses that take more than a second.
SLOW = {"confirmation", "error bars", "comparison", "refining", "study"}


def run(feature, use, folder: Path):
    design = variant(feature, use)
    expected = [each.what for each in (*refusals(design, use), *refused_together(design))]
    if not expected:
        CALLS[use](feature, folder)
        return
    with pytest.raises(VoxSoftError) as caught:
        CALLS[use](feature, folder)
    assert any(what in str(caught.value) for what in expected)


def test_every_feature_and_use_is_tried_and_every_reason_is_of_some():
    assert SAMPLES.keys() | FEATURES_ELSEWHERE == FEATURES.keys()
    assert CALLS.keys() | USES_ELSEWHERE == USES.keys()
    assert {feature for feature, _ in REASONS} <= FEATURES.keys()
    assert {use for _, use in REASONS} <= USES.keys()


@pytest.mark.parametrize("feature", ["supplies", "several bodies"])
def test_a_comparison_has_the_numbers_of_runs_on_each_voxel_size(feature):
    design = design_with(feature)
    found = vs.compare(
        design, solvers=["statics"], outside="none", voxel_sizes=["2.5 mm"], splits=[1]
    )
    for run_of_it, size in zip(found.runs, ("5 mm", "2.5 mm"), strict=True):
        alone = vs.simulate(design.replace(voxel_size=size), method="statics")
        assert run_of_it.quantities["tip x"].value == pytest.approx(alone.probes["tip"][0])


@pytest.mark.parametrize("feature", SAMPLES)
def test_a_sample_has_its_feature(feature):
    design = design_with(feature)
    assert has_feature(design, feature)
    # The cells of the page, which count features that are always there too, are those of it.
    every = {each for each in ("contact", "fibers", "supplies") if has_feature(design, each)}
    if every <= {feature, *IMPLIED.get(feature, ())}:
        for use in USES:
            assert bool(list(refusals(design, use))) == (reason_of(feature, use) is not None), use


@pytest.mark.parametrize(("feature", "use"), quick_cells())
def test_a_cell_of_the_table_holds(feature, use, tmp_path):
    run(feature, use, tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("feature", [name for name in SAMPLES if "parts" not in SAMPLES[name]])
def test_a_path_over_time_of_relaxing_rubber_has_every_feature(feature):
    design = design_with(feature, parts=[soft(material=RELAXING)])
    path = vs.follow(design, "time=0..0.1 s/2")
    assert path.status == "ok"
    assert path.results[-1].solver["way"] == "creep"


@pytest.mark.slow
@pytest.mark.parametrize(("feature", "use"), sorted(set(cells()) - set(quick_cells())))
def test_every_cell_of_the_table_holds(feature, use, tmp_path):
    run(feature, use, tmp_path)
