import { expect, it } from "vitest";
import { CAD_HINT } from "../../src/protocol";
import { refusalOf } from "../../src/shell/DropZone";

it("says of a CAD model what to do with it, and of other files what is taken", () => {
  const cad = refusalOf("Finger.STEP");
  expect(cad.what).toContain("Finger.STEP is a CAD model");
  expect(cad.hint).toContain(CAD_HINT);
  expect(CAD_HINT).toContain("STL");
  for (const ending of [".toml", ".stl", ".vti", ".inp"])
    expect(refusalOf("photo.png").hint).toContain(ending);
});
