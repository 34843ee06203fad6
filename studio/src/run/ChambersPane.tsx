import { useState } from "react";
import { Empty, Select } from "../controls/Choice";
import { siUnit } from "../controls/kinds";
import { Plot } from "../controls/Plot";
import { factorOf, shownUnit, unitText } from "../controls/units";
import type { ChamberCurve } from "../protocol";
import { useStudio } from "../store/studio";
import { seekTo } from "./seek";

const COLORS = ["--series-1", "--series-2", "--series-3", "--series-4", "--series-5", "--series-6"];

/** Readings of a chamber that can be plotted, with their kinds of quantity. */
const READINGS = {
  pressure: { label: "Pressure", kind: "pressure" },
  volume: { label: "Volume", kind: "volume" },
  flow: { label: "Flow of mass", kind: "mass flow" },
} as const satisfies Partial<Record<keyof ChamberCurve, { label: string; kind: string }>>;
type Reading = keyof typeof READINGS;

/** State of supplies over time: pressure, volume or flow of each of their chambers. */
export default function ChambersPane() {
  const [reading, setReading] = useState<Reading>("pressure");
  const found = useStudio(({ chambers, body }) =>
    chambers && chambers.topology === body?.topology ? chambers : null,
  );
  const time = useStudio((state) => (state.stat?.state === "past" ? state.stat.time : null));
  if (!found || found.times.length === 0) {
    return (
      <Empty title="No chamber was filled over time yet">
        <p>
          Give the design a supply, such as a pump or a tank with a valve, and an end time. Solve
          then finds the pressures over time.
        </p>
      </Empty>
    );
  }
  const { label, kind } = READINGS[reading];
  const unit = shownUnit(siUnit(kind));
  const factor = factorOf(unit);
  return (
    <div className="chambers">
      <div className="plot-bar">
        <Select
          bare
          label="What of the chambers"
          value={reading}
          options={Object.entries(READINGS).map(([value, one]) => ({ value, label: one.label }))}
          onChange={(value) => setReading(value as Reading)}
        />
      </div>
      <Plot
        key={reading}
        label={`${label} of the chambers over time`}
        testId="plot-chambers"
        x={{ label: "time [s]" }}
        y={{ label: `${label.toLowerCase()} [${unitText(unit)}]` }}
        series={found.chambers.map((each, i) => ({
          label: each.name,
          color: COLORS[i % COLORS.length] as string,
          dashed: i >= COLORS.length,
        }))}
        data={[
          found.times,
          ...found.chambers.map((each) => each[reading].map((value) => value / factor)),
        ]}
        group="time"
        mark={time}
        onSeek={seekTo}
      />
    </div>
  );
}
