// Every history of the design as a line over time; points of tables are moved by hand.
import { Button, Empty } from "../../controls/Choice";
import { formatNumber } from "../../controls/units";
import type { HistoryLine } from "../../protocol";
import { useStudio } from "../../store/studio";
import { edit } from "../design/edits";
import { inside } from "../design/fields/schema";
import { ticks } from "../study/chart/ticks";
import { useSize } from "../study/chart/useSize";
import { HistoryRow, setInType } from "./HistoryRow";
import { endOf } from "./points";
import { type Axis, MARGIN, xOf } from "./scale";
import "./timeline.css";

const NO_LINES: readonly HistoryLine[] = [];

export default function TimelinePane() {
  const document = useStudio((state) => state.document);
  const [box, { width }] = useSize<HTMLDivElement>();
  const lines = document?.histories ?? NO_LINES;
  const drawn = lines.filter((line) => line.way !== "none");
  const constant = lines.filter((line) => line.way === "none");
  const endTime = endTimeOf(document?.design);
  const axis: Axis = { width: Math.max(width, 160), end: endOf(drawn, endTime) };
  return (
    <div className="pane timeline" data-testid="timeline-pane" ref={box}>
      {document && !document.valid && drawn.length > 0 && (
        <p className="section bad" role="status">
          The text has errors: these are the last good histories, and cannot be moved.
        </p>
      )}
      {lines.length === 0 && (
        <Empty title="Nothing changes over time">
          <p>
            Give the design a load, a supply, a tendon or an activation: it can follow a history.
          </p>
        </Empty>
      )}
      {drawn.length > 0 && width > 0 && (
        <>
          <div className="timeline-rows">
            {drawn.map((line) => (
              <HistoryRow
                key={line.path.join(".")}
                line={line}
                axis={axis}
                source={document?.valid ? document.source : null}
              />
            ))}
            {endTime !== null && <EndTime axis={axis} at={endTime} />}
            <Cursor axis={axis} />
          </div>
          <TimeAxis axis={axis} />
          <p className="section muted">
            {drawn.some(({ lives }) => lives === "") &&
              "Double-click adds a point, Delete removes it; arrow keys move it, finer with Shift. "}
            An equilibrium takes the last factor of each.
          </p>
        </>
      )}
      {constant.map((line) => (
        <Constant
          key={line.path.join(".")}
          line={line}
          endTime={endTime}
          disabled={!document?.valid}
        />
      ))}
    </div>
  );
}

/** A place that has no history, with the button that gives it one. */
function Constant(props: { line: HistoryLine; endTime: number | null; disabled: boolean }) {
  const { line, endTime } = props;
  const amount = setInType(line.used_by[0]?.amount ?? "");
  const add = () => {
    const until = endTime === null ? 1 : endTime / 2;
    const time = ["0 s", `${Number(until.toPrecision(6))} s`];
    edit(line.path, { time, factor: [0, 1] });
  };
  return (
    <div className="timeline-constant" data-testid={`constant-${line.path.join("-")}`}>
      <span>
        {line.title} <span className="muted">{amount && `${amount}, `}constant</span>
      </span>
      <Button
        kind="quiet"
        label={`Add a history to ${line.title}`}
        title="From 0 to 1, to be changed here"
        disabled={props.disabled}
        onClick={add}
      >
        Add a history
      </Button>
    </div>
  );
}

/** The time that the view shows, across all lines; an equilibrium has none. */
function Cursor(props: { axis: Axis }) {
  const stat = useStudio((state) => state.stat);
  const time = stat?.time ?? 0;
  if (stat?.untimed || time > props.axis.end) return null;
  return (
    <div
      className="timeline-cursor"
      data-testid="timeline-cursor"
      title={`${formatNumber(time, 4)} s: the time that is shown`}
      style={{ left: xOf(time, props.axis) }}
    />
  );
}

function EndTime(props: { axis: Axis; at: number }) {
  return (
    <div
      className="timeline-end"
      title={`${formatNumber(props.at, 4)} s: the end time of a run`}
      style={{ left: xOf(props.at, props.axis) }}
    />
  );
}

function TimeAxis({ axis }: { axis: Axis }) {
  return (
    <svg className="timeline-axis" width={axis.width} height={30} aria-hidden="true">
      {ticks(0, axis.end, Math.max(2, Math.floor(axis.width / 80))).map((time) => (
        <g key={time} transform={`translate(${xOf(time, axis)} 0)`}>
          <path d="M0 0v4" />
          <text y={15}>{formatNumber(time, 4)}</text>
        </g>
      ))}
      <text x={axis.width - MARGIN.right} y={27} textAnchor="end">
        time [s]
      </text>
    </svg>
  );
}

function endTimeOf(design: unknown): number | null {
  const end = inside(inside(design, "solver"), "end_time");
  return typeof end === "number" ? end : null;
}
