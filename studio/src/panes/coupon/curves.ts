// Measured points and the line of a model through them, as columns of one plot.
import type { Series } from "../../controls/Plot";
import type { CouponFitEvent, CouponModel } from "../../protocol";

const PERCENT = 100;
const KILOPASCAL = 1e3;
const COLORS = ["--series-2", "--series-3", "--series-4", "--series-5"] as const;

/** Strain in percent, then stress in kPa of each test, then that of the model in each mode. */
export function chartOf(
  fit: CouponFitEvent,
  model: CouponModel,
): { readonly series: readonly Series[]; readonly data: readonly number[][] } {
  const modes = [...new Set(fit.curves.map(({ mode }) => mode))];
  const tests = fit.curves.length;
  const rows = fit.curves.flatMap((curve, i) =>
    curve.strain.map((strain, k) => {
      const row = new Array<number>(1 + tests + modes.length).fill(Number.NaN);
      row[0] = PERCENT * strain;
      row[1 + i] = (curve.stress[k] ?? Number.NaN) / KILOPASCAL;
      row[1 + tests + modes.indexOf(curve.mode)] =
        (model.stresses[i]?.[k] ?? Number.NaN) / KILOPASCAL;
      return row;
    }),
  );
  rows.sort((a, b) => a[0]! - b[0]!);
  const measured = fit.curves.map(
    (curve, i): Series => ({
      label: curve.name,
      color: COLORS[i % COLORS.length] ?? COLORS[0],
      points: true,
      line: false,
    }),
  );
  const fitted = modes.map(
    (mode, i): Series => ({
      label: modes.length > 1 ? `${model.name}, ${mode}` : model.name,
      color: "--series-1",
      dashed: i > 0,
    }),
  );
  const series = [...measured, ...fitted];
  return { series, data: [0, ...series.keys()].map((_, k) => rows.map((row) => row[k]!)) };
}
