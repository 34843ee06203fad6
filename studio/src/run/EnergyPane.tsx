import { Empty } from "../controls/Choice";
import { Plot } from "../controls/Plot";
import { formatEnergy } from "../controls/units";
import { useStudio } from "../store/studio";
import { isStill, LastValues } from "./LastValues";
import { seekTo } from "./seek";

const ENERGY = [
  { label: "elastic", color: "--series-1" },
  { label: "kinetic", color: "--series-2" },
];
const RESIDUAL = [{ label: "out of balance", color: "--series-3" }];

/** Decay to rest: energies, and the residual force over the load. */
export default function EnergyPane() {
  useStudio((state) => state.plotted);
  const history = useStudio((state) => state.history);
  const time = useStudio((state) => (state.stat?.state === "past" ? state.stat.time : null));
  if (history.length === 0) {
    return (
      <Empty title="No time has passed yet">
        <p>Let time run: energies and the residual are plotted here.</p>
      </Empty>
    );
  }
  const [times = [], residual = [], elastic = [], kinetic = []] = history.columns;
  if (isStill(times)) {
    const percents = `${Number((100 * (residual.at(-1) ?? Number.NaN)).toPrecision(2))} %`;
    return (
      <LastValues
        testId="last-energies"
        rows={[
          ["elastic energy", formatEnergy(elastic.at(-1) ?? Number.NaN)],
          ["kinetic energy", formatEnergy(kinetic.at(-1) ?? Number.NaN)],
          ["out of balance, of the load", percents],
        ]}
      />
    );
  }
  const percent = residual.map((x) => (x > 0 ? 100 * x : Number.NaN));
  const milli = (column: number[]) => column.map((x) => x * 1000);
  const common = { x: { label: "time [s]" }, group: "time", mark: time, onSeek: seekTo };
  return (
    <div className="energy">
      <Plot
        {...common}
        label="Energies over time"
        testId="plot-energy"
        y={{ label: "energy [mJ]" }}
        series={ENERGY}
        data={[times, milli(elastic), milli(kinetic)]}
      />
      <Plot
        {...common}
        label="Residual over time"
        testId="plot-residual"
        y={{ label: "residual [% of load]", log: true }}
        series={RESIDUAL}
        data={[times, percent]}
      />
    </div>
  );
}
