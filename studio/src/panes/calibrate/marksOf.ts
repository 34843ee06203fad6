// Measured points as marks in space, with the error at each in words.
import { formatKind } from "../../controls/kinds";
import { formatNumber } from "../../controls/units";
import type { OverlayExperiment } from "../../protocol";
import type { Mark } from "../../view/still/marks";

/** The color variables of the tables, in their order; the second is that of the simulated shape. */
const COLORS = ["--series-1", "--series-3", "--series-4", "--series-5"] as const;

export function marksOf(experiments: readonly OverlayExperiment[]): Mark[] {
  return experiments.flatMap((experiment, e) =>
    experiment.measured.map((measured, i): Mark => {
      const error = formatKind(experiment.error[i], "length", 3);
      const percent = `${formatNumber(experiment.percent[i] ?? Number.NaN, 3)} %`;
      return {
        key: `station-${e}-${i}`,
        measured,
        simulated: experiment.simulated[i] ?? measured,
        text: `${error}, ${percent}`,
        title: `${experiment.name}, station ${i + 1}: off by ${error}, ${percent} of the sag`,
        color: COLORS[e % COLORS.length] ?? COLORS[0],
      };
    }),
  );
}
