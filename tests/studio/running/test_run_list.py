"""The list of runs tells the best values with their units."""

import json

from voxsoft.studio.running.runs import RunList

DESIGN = '[objectives]\nrise = { maximize = "displacement", probe = "top" }\n'


def rows(folder):
    return {row.id: row for row in RunList(folder, folder / ".own", lambda _: False).event().rows}


def write(folder, **files):
    folder.mkdir()
    for name, content in files.items():
        text = content if isinstance(content, str) else json.dumps(content)
        (folder / name.replace("_", ".")).write_text(text)


def test_the_best_of_a_study_has_the_units_of_its_objectives(tmp_path):
    targets = {"rise": {"maximize": "displacement"}, "weight": {"minimize": "mass"}}
    best = {"objectives": {"rise": 0.0046718, "weight": 0.0269}}
    write(
        tmp_path / "arm",
        study_json={"objectives": targets},
        summary_json={"best": best, "trials": 40},
    )
    assert rows(tmp_path)["arm"].best == "rise 4.672 mm, weight 26.9 g"


def test_the_best_of_a_run_has_the_units_of_its_design(tmp_path):
    summary = {"status": "ok", "seconds": 1.0, "metrics": {"rise": 0.002, "max_displacement": 0.1}}
    write(tmp_path / "one", design_toml=DESIGN, summary_json=summary)
    assert rows(tmp_path)["one"].best == "rise 2 mm"


def test_values_whose_metric_is_not_reported_stand_without_a_unit(tmp_path):
    best = {"objectives": {"rise": 0.5}}
    write(tmp_path / "old", study_json="no JSON", summary_json={"best": best, "trials": 1})
    assert rows(tmp_path)["old"].best == "rise 0.5"
