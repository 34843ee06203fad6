import { useMemo, useState } from "react";
import { Button, Empty, Select } from "../../controls/Choice";
import { copy } from "../../controls/clipboard";
import { Plot, type Series } from "../../controls/Plot";
import type { GenerationEvent } from "../../protocol";
import { useCalibration } from "./current";
import { generationsText } from "./text";
import "../study/study.css";

interface Curves {
  readonly label: string;
  readonly series: readonly Series[];
  readonly data: readonly number[][];
  readonly log: boolean;
}

const number = (value: number | null | undefined) => value ?? Number.NaN;

/** The curves of one quantity over the generations; lengths in mm, moduli in kPa. */
function curvesOf(generations: readonly GenerationEvent[], what: string): Curves {
  const index = generations.map((one) => one.index);
  if (what === "error") {
    return {
      label: "mean error (mm)",
      series: [{ label: "best candidate", color: "--series-1", points: true }],
      data: [index, generations.map((one) => number(one.error) * 1e3)],
      log: false,
    };
  }
  if (what === "fitness") {
    return {
      label: "fitness",
      series: [
        { label: "best", color: "--series-1" },
        { label: "mean", color: "--series-2", dashed: true },
      ],
      data: [
        index,
        generations.map((one) => number(one.best)),
        generations.map((one) => number(one.mean)),
      ],
      log: false,
    };
  }
  const kilo = (value: number | null | undefined) => number(value) / 1e3;
  return {
    label: `${what} (kPa)`,
    series: [
      { label: "best", color: "--series-3" },
      { label: "spread of the generation", color: "--series-2", dashed: true },
      { label: "to", color: "--series-2", dashed: true },
    ],
    data: [
      index,
      generations.map((one) => kilo(one.parameters[what])),
      generations.map((one) => kilo(one.spread[what]?.[0])),
      generations.map((one) => kilo(one.spread[what]?.[1])),
    ],
    log: true,
  };
}

/** Progress of the search, generation by generation. */
export default function GenerationsPane() {
  const current = useCalibration();
  const [what, setWhat] = useState("error");
  const generations = current?.generations;
  const names = Object.keys(generations?.at(-1)?.parameters ?? {});
  const shown = what === "error" || what === "fitness" || names.includes(what) ? what : "error";
  const curves = useMemo(() => curvesOf(generations ?? [], shown), [generations, shown]);
  if (!generations || generations.length === 0) {
    return (
      <Empty title="No generations yet">
        <p>Error, fitness and the constants of each generation are plotted here.</p>
      </Empty>
    );
  }
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        <Select
          bare
          label="Quantity over the generations"
          value={shown}
          options={[
            { value: "error", label: "mean error" },
            { value: "fitness", label: "fitness" },
            ...names,
          ]}
          onChange={setWhat}
        />
        <Button
          kind="quiet"
          testId="copy-generations"
          label="Copy the generations as a table, in SI units"
          onClick={() => void copy(generationsText(generations), "the generations")}
        >
          Copy data
        </Button>
      </div>
      <div className="plot-rest">
        <Plot
          label={`${curves.label} over the generations`}
          testId="generations-plot"
          x={{ label: "generation" }}
          y={{ label: curves.label, log: curves.log }}
          series={curves.series}
          data={curves.data}
        />
      </div>
    </div>
  );
}
