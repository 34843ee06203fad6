import { existsSync } from "node:fs";
import { expect, it } from "vitest";
import { addressOf, TUTORIALS } from "../../src/start/tutorials";

it("leads to pages that the documentation has", () => {
  for (const tutorial of TUTORIALS) {
    expect(existsSync(new URL(`../../../docs/${tutorial.page}`, import.meta.url))).toBe(true);
    expect(addressOf(tutorial).endsWith(tutorial.page)).toBe(true);
  }
});
