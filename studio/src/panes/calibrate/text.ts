// Content of a calibration as tables for a spreadsheet: SI numbers, their units in the heads.
import { tableText } from "../../controls/tableText";
import type { GenerationEvent, StationError } from "../../protocol";

export function errorsText(rows: readonly StationError[], quantities: readonly string[]): string {
  return tableText(
    [
      "table",
      "station",
      ...quantities.flatMap((name) => [`${name} measured (m)`, `${name} simulated (m)`]),
      "error (m)",
      "error (% of the sag)",
    ],
    rows.map((row) => [
      row.experiment,
      row.station,
      ...quantities.flatMap((_, i) => [row.measured[i], row.simulated[i]]),
      row.error,
      row.percent,
    ]),
  );
}

export function generationsText(generations: readonly GenerationEvent[]): string {
  const names = Object.keys(generations.at(-1)?.parameters ?? {});
  return tableText(
    [
      "generation",
      "best fitness",
      "mean fitness",
      "error (m)",
      ...names.flatMap((name) => [`${name} (Pa)`, `${name} lowest (Pa)`, `${name} highest (Pa)`]),
    ],
    generations.map((one) => [
      one.index,
      one.best,
      one.mean,
      one.error,
      ...names.flatMap((name) => [one.parameters[name], ...(one.spread[name] ?? [null, null])]),
    ]),
  );
}
