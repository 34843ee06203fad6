import { Empty } from "../controls/Choice";
import { Plot, type Series } from "../controls/Plot";
import { factorOf, formatQuantity, shownUnit, unitText } from "../controls/units";
import { useStudio } from "../store/studio";
import { isStill, LastValues } from "./LastValues";
import { seekTo } from "./seek";

const COLORS = [
  "--series-1",
  "--series-2",
  "--series-3",
  "--series-4",
  "--series-5",
  "--series-6",
  "--series-7",
];
// Time, residual, elastic and kinetic energy come before the probes.
const FIRST_PROBE = 4;

/** Displacement of each probe over time. */
export default function ProbesPane() {
  useStudio((state) => state.plotted);
  const history = useStudio((state) => state.history);
  const time = useStudio((state) => (state.stat?.state === "past" ? state.stat.time : null));
  const names = history.names.slice(FIRST_PROBE);
  if (names.length === 0 || history.length === 0) {
    return (
      <Empty title="No probe has measured yet">
        <p>
          Let time run: the design's probes are plotted here. Click the body and choose “Plot over
          time” to add any point.
        </p>
      </Empty>
    );
  }
  const si = history.units[FIRST_PROBE] ?? "m";
  const [times = []] = history.columns;
  if (isStill(times)) {
    const last = names.map((name, i): readonly [string, string] => [
      name,
      formatQuantity(history.columns[FIRST_PROBE + i]?.at(-1) ?? Number.NaN, si),
    ]);
    return <LastValues testId="last-probes" rows={last} />;
  }
  const unit = shownUnit(si);
  const factor = factorOf(unit);
  const series: Series[] = names.map((name, i) => ({
    label: name,
    color: COLORS[i % COLORS.length] as string,
    dashed: i >= COLORS.length,
  }));
  const columns = history.columns.slice(FIRST_PROBE).map((column) => column.map((x) => x / factor));
  return (
    <Plot
      label="Displacement of the probes over time"
      testId="plot-probes"
      x={{ label: "time [s]" }}
      y={{ label: `displacement [${unitText(unit)}]` }}
      series={series}
      data={[history.columns[0] ?? [], ...columns]}
      group="time"
      mark={time}
      onSeek={seekTo}
    />
  );
}
