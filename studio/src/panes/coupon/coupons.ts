// Tests of a material that were dropped, and the models fitted to them. Kept while the page is there.
import { create } from "zustand";
import type { CouponFitEvent, ErrorEvent } from "../../protocol";
import { ask } from "../../store/session";

/** Tests by their names in requests; the last is fitted with the softening of its cycles. */
export const TESTS = {
  uniaxial: "tension along one axis",
  planar: "planar tension (pure shear)",
  equibiaxial: "equibiaxial tension",
  cyclic: "load and unload along one axis",
} as const;

export type TestMode = keyof typeof TESTS;

export interface CouponTest {
  readonly name: string;
  readonly text: string;
  readonly mode: TestMode;
}

/** Sizes as they were typed; empty where no table needs them. */
export interface SpecimenSizes {
  readonly area: string;
  readonly length: string;
  /** Largest strain that counts. */
  readonly max_strain: string;
}

type Problem = Pick<ErrorEvent, "where" | "what" | "hint">;

interface Coupons {
  readonly tests: readonly CouponTest[];
  readonly sizes: SpecimenSizes;
  readonly fit: CouponFitEvent | null;
  readonly problem: Problem | null;
  /** True while the server fits. */
  readonly busy: boolean;
  /** Chosen model; null is the recommended one. */
  readonly model: string | null;
  /** Name of the material as it was typed; null is that of the first test. */
  readonly name: string | null;
}

export const useCoupons = create<Coupons>(() => ({
  tests: [],
  sizes: { area: "", length: "", max_strain: "" },
  fit: null,
  problem: null,
  busy: false,
  model: null,
  name: null,
}));

/** Take a table of strain and stress, and fit all tests anew. */
export function addTest(name: string, text: string): void {
  const others = useCoupons.getState().tests.filter((one) => one.name !== name);
  fitAnew({ tests: [...others, { name, text, mode: "uniaxial" }] });
}

export function removeTest(name: string): void {
  fitAnew({ tests: useCoupons.getState().tests.filter((one) => one.name !== name) });
}

export function setTestMode(name: string, mode: TestMode): void {
  const tests = useCoupons.getState().tests;
  fitAnew({ tests: tests.map((one) => (one.name === name ? { ...one, mode } : one)) });
}

export function setSizes(change: Partial<SpecimenSizes>): void {
  fitAnew({ sizes: { ...useCoupons.getState().sizes, ...change } });
}

/** Fits that were asked for: the answer to an earlier one is no longer wanted. */
let asked = 0;

function fitAnew(change: Partial<Pick<Coupons, "tests" | "sizes">>): void {
  asked += 1;
  useCoupons.setState({ ...change, model: null });
  const { tests, sizes } = useCoupons.getState();
  if (tests.length === 0) {
    useCoupons.setState({ fit: null, problem: null, busy: false, name: null });
    return;
  }
  useCoupons.setState({ busy: true });
  void answered({ tables: tests, ...sizes }, asked);
}

async function answered(request: Record<string, unknown>, number: number): Promise<void> {
  const found = await answer(request);
  if (number !== asked) return;
  const isFit = "models" in found;
  useCoupons.setState({
    fit: isFit ? found : null,
    problem: isFit ? null : found,
    busy: false,
  });
}

async function answer(request: Record<string, unknown>): Promise<CouponFitEvent | Problem> {
  try {
    const reply = await ask("/coupons", request);
    const said: unknown = await reply.json();
    if (reply.ok) return said as CouponFitEvent;
    const { where = "", what = "", hint = "" } = said as Partial<Problem>;
    return { where, what, hint };
  } catch {
    const hint = "VoxSoft does not answer; drop the table again when it does.";
    return { where: "", what: "The tests could not be fitted", hint };
  }
}
