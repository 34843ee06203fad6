import { expect, it } from "vitest";
import { subjectOf } from "../../src/panes/body/subject";

it.each([
  ["probes.top", "Probe top"],
  ["probes.top.x", "Probe top"],
  ["loads[0].cavity", "Load 1"],
  ["clamps[1]", "Clamp 2"],
  ["bodies[0]", "Body 1"],
  ["voxels (1, 2, 3) and (1, 3, 4)", ""],
  ["voxel (1, 2, 3)", ""],
  ["mesh", ""],
  ["voxel_size", "Voxel size"],
  ["equilibrium", "Equilibrium"],
])("says what %s is about", (where, subject) => {
  expect(subjectOf(where)).toBe(subject);
});
