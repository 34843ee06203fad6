import { expect, test } from "vitest";
import { standing } from "../../src/panes/jobs/standing";
import type { SubjectEvent } from "../../src/protocol";

const of = (change: Partial<SubjectEvent>): SubjectEvent => ({
  t: "subject",
  job: "finger-run",
  document: "one",
  design: "finger",
  hash: "abc",
  ...change,
});
const open = { id: "one", hash: "abc", design: { name: "finger" } };

test("a job is of the present design while the hash is that", () => {
  expect(standing(of({}), open)).toBe("present");
  // Also where another document holds it.
  expect(standing(of({ document: "two", design: "arm" }), open)).toBe("present");
});

test("a changed design makes its jobs those of an earlier one", () => {
  expect(standing(of({}), { ...open, hash: "def" })).toBe("earlier");
  expect(standing(of({}), { ...open, hash: "" })).toBe("earlier");
});

test("jobs of other documents are told apart, also under one name", () => {
  expect(standing(of({ document: "two" }), { ...open, hash: "def" })).toBe("other");
  expect(standing(of({ document: "", design: "arm" }), { ...open, hash: "def" })).toBe("other");
});

test("the name of a design decides where its document is not known", () => {
  expect(standing(of({ document: "" }), { ...open, hash: "def" })).toBe("earlier");
});

test("nothing is said of a job of an unknown design, or before a document came", () => {
  expect(standing(undefined, open)).toBe("present");
  expect(standing(of({}), null)).toBe("present");
});
