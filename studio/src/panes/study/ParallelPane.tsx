// Parallel coordinates: one line for each design; drag along an axis to keep the designs there.
import { memo, type PointerEvent as ReactPointerEvent, useMemo, useRef } from "react";
import { Button } from "../../controls/Choice";
import { useSize } from "./chart/useSize";
import { coloring } from "./colors";
import { type CurrentStudy, useStudy } from "./current";
import { NoStudy } from "./NoStudy";
import { brush, choose, clearBrushes, hover, useSelection } from "./selection";
import { type Axis, isDone, rangeOf, textOn, valueOn, within } from "./trials";
import "./chart/chart.css";
import "./study.css";

const TOP = 34;
const BOTTOM = 18;
const SIDE = 44;

export default function ParallelPane() {
  const current = useStudy();
  if (!current || current.study.trials.length === 0) {
    return <NoStudy what="Each design as a line across its parameters and objectives." />;
  }
  return <Parallel current={current} />;
}

interface Scale {
  readonly axis: Axis;
  readonly x: number;
  readonly low: number;
  readonly high: number;
  toY(value: number): number;
  toValue(y: number): number;
}

function Parallel(props: { current: CurrentStudy }) {
  const { id, study, axes } = props.current;
  const { hovered, pinned, opened, brushes } = useSelection();
  const [box, { width, height }] = useSize<HTMLDivElement>();
  const done = useMemo(() => study.trials.filter(isDone), [study]);
  const scales = useMemo((): Scale[] => {
    const shown = axes.filter((axis) => axis.role !== "metric");
    const bottom = height - BOTTOM;
    return shown.map((axis, i) => {
      const [low, high] = axis.choices
        ? [-0.2, Math.max(axis.choices.length - 0.8, 0.2)]
        : rangeOf(done.map((trial) => valueOn(trial, axis)));
      const x = shown.length < 2 ? width / 2 : SIDE + (i / (shown.length - 1)) * (width - 2 * SIDE);
      return {
        axis,
        x,
        low,
        high,
        toY: (value) => bottom - ((value - low) / (high - low)) * (bottom - TOP),
        toValue: (y) => low + ((bottom - y) / (bottom - TOP)) * (high - low),
      };
    });
  }, [axes, done, width, height]);
  const lines = useMemo(() => {
    const { color } = coloring(study, axes);
    return done.map((trial) => ({
      index: trial.index,
      color: color(trial),
      faded: !within(trial, axes, brushes),
      path: scales
        .map((scale, i) => {
          const y = scale.toY(valueOn(trial, scale.axis));
          return Number.isFinite(y) ? `${i ? "L" : "M"}${scale.x.toFixed(1)} ${y.toFixed(1)}` : "";
        })
        .join(""),
    }));
  }, [study, axes, done, scales, brushes]);
  const kept = lines.filter((line) => !line.faded).length;
  const brushed = Object.keys(brushes).length > 0;
  const marked = new Set([hovered, opened, ...pinned]);
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        {brushed ? (
          <>
            <span>
              {kept} of {lines.length} designs
            </span>
            <Button kind="quiet" testId="clear-brushes" onClick={clearBrushes}>
              Show all
            </Button>
          </>
        ) : (
          <span className="muted">Drag along an axis to keep the designs that lie there.</span>
        )}
      </div>
      <div className="chart" ref={box} data-testid="parallel-chart">
        {width > 60 && height > 60 && (
          <svg width={width} height={height} role="img" aria-label="Parallel coordinates">
            <Lines lines={lines} onChoose={(trial, mark) => choose(id, trial, mark)} />
            {lines
              .filter((line) => marked.has(line.index))
              .map((line) => (
                <path
                  key={line.index}
                  className={`parallel-mark${pinned.includes(line.index) ? " pinned" : ""}`}
                  d={line.path}
                />
              ))}
            {scales.map((scale) => (
              <AxisBar
                key={scale.axis.key}
                scale={scale}
                height={height}
                stretch={brushes[scale.axis.key] ?? null}
              />
            ))}
          </svg>
        )}
      </div>
    </div>
  );
}

interface Line {
  readonly index: number;
  readonly color: string;
  readonly faded: boolean;
  readonly path: string;
}

const Lines = memo(
  (props: { lines: readonly Line[]; onChoose(trial: number, mark: boolean): void }) => (
    <g fill="none">
      {[...props.lines]
        .sort((a, b) => Number(b.faded) - Number(a.faded))
        .map((line) => (
          // biome-ignore lint/a11y/noStaticElementInteractions: the table does the same by keyboard
          <path
            key={line.index}
            className={`parallel-line${line.faded ? " faded" : ""}`}
            data-trial={line.index}
            d={line.path}
            stroke={line.color}
            onPointerEnter={() => hover(line.index)}
            onPointerLeave={() => hover(null)}
            onClick={(event) => props.onChoose(line.index, event.shiftKey)}
          />
        ))}
    </g>
  ),
  (before, after) => before.lines === after.lines,
);

function AxisBar(props: {
  scale: Scale;
  height: number;
  stretch: readonly [number, number] | null;
}) {
  const { scale, stretch } = props;
  const start = useRef<number | null>(null);
  const bottom = props.height - BOTTOM;
  const at = (event: ReactPointerEvent<SVGRectElement>) => {
    const top = event.currentTarget.ownerSVGElement?.getBoundingClientRect().top ?? 0;
    return Math.min(bottom, Math.max(TOP, event.clientY - top));
  };
  // A requirement may be open at one end.
  const toY = (value: number) => scale.toY(Math.min(scale.high, Math.max(scale.low, value)));
  const ends = scale.axis.choices
    ? null
    : [textOn(scale.high, scale.axis, 3), textOn(scale.low, scale.axis, 3)];
  return (
    <g>
      <path className="parallel-axis" d={`M${scale.x} ${TOP}V${bottom}`} />
      <text className="parallel-name" x={scale.x} y="13" textAnchor="middle">
        {scale.axis.name}
      </text>
      {ends && (
        <>
          <text className="parallel-end" x={scale.x} y={TOP - 6} textAnchor="middle">
            {ends[0]}
          </text>
          <text className="parallel-end" x={scale.x} y={bottom + 14} textAnchor="middle">
            {ends[1]}
          </text>
        </>
      )}
      {scale.axis.choices?.map((word, i) => (
        <text key={word} className="parallel-end" x={scale.x + 5} y={scale.toY(i) + 4}>
          {word}
        </text>
      ))}
      {stretch && (
        <rect
          className="parallel-brush"
          x={scale.x - 7}
          width="14"
          y={toY(stretch[1])}
          height={Math.max(2, toY(stretch[0]) - toY(stretch[1]))}
        />
      )}
      <rect
        className="parallel-grip"
        data-axis={scale.axis.name}
        x={scale.x - 10}
        width="20"
        y={TOP - 4}
        height={bottom - TOP + 8}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          start.current = at(event);
        }}
        onPointerMove={(event) => {
          if (start.current === null) return;
          const end = at(event);
          if (Math.abs(end - start.current) < 3) return;
          const [a, b] = [scale.toValue(start.current), scale.toValue(end)];
          brush(scale.axis.key, [Math.min(a, b), Math.max(a, b)]);
        }}
        onPointerUp={(event) => {
          if (start.current !== null && Math.abs(at(event) - start.current) < 3) {
            brush(scale.axis.key, null);
          }
          start.current = null;
        }}
      />
    </g>
  );
}
