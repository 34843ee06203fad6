import { expect, it } from "vitest";
import { CAD_HINT } from "../../src/protocol";
import { refusalOf } from "../../src/shell/DropZone";

it("gives a remedy for a CAD model, and the accepted files for others", () => {
  const cad = refusalOf("Finger.STEP");
  expect(cad.what).toContain("Finger.STEP is a CAD model");
  expect(cad.hint).toContain(CAD_HINT);
  expect(CAD_HINT).toContain("STL");
  for (const ending of [".toml", ".stl", ".vti", ".inp"])
    expect(refusalOf("photo.png").hint).toContain(ending);
});
