// Points over two axes, with lines under them; each point stands for a design.
import { memo, type ReactNode, useMemo, useState } from "react";
import { siUnit } from "../../../controls/kinds";
import { factorOf, formatNumber, shownUnit, unitText } from "../../../controls/units";
import { padded, ticks } from "./ticks";
import { useSize } from "./useSize";
import "./chart.css";

export interface ChartPoint {
  readonly id: number;
  readonly x: number;
  readonly y: number;
  readonly color: string;
  readonly faded?: boolean;
  readonly hollow?: boolean;
}

export interface ChartAxis {
  readonly label: string;
  readonly kind: string;
  readonly range: readonly [number, number];
  /** Whole numbers only, such as the numbers of trials. */
  readonly whole?: boolean;
}

export interface PointChartProps {
  label: string;
  x: ChartAxis;
  y: ChartAxis;
  points: readonly ChartPoint[];
  /** Lines under the points. */
  lines?: readonly {
    readonly color: string;
    readonly points: readonly { x: number; y: number }[];
    readonly steps?: boolean;
  }[];
  hovered: number | null;
  opened: number | null;
  pinned: readonly number[];
  tip(id: number): ReactNode;
  onHover(id: number | null): void;
  onChoose(id: number, mark: boolean): void;
  testId?: string;
}

/** Room for the numbers and names around a chart, pixels. */
export const MARGINS = { left: 58, right: 14, top: 10, bottom: 36 } as const;
const { left: LEFT, right: RIGHT, top: TOP, bottom: BOTTOM } = MARGINS;

export function PointChart(props: PointChartProps) {
  const [box, { width, height }] = useSize<HTMLDivElement>();
  const [x0, x1] = padded(props.x.range, props.x.whole ? 0.03 : 0.06);
  const [y0, y1] = padded(props.y.range, 0.08);
  const plotWidth = Math.max(10, width - LEFT - RIGHT);
  const plotHeight = Math.max(10, height - TOP - BOTTOM);
  const toX = (value: number) => LEFT + ((value - x0) / (x1 - x0)) * plotWidth;
  const toY = (value: number) => TOP + (1 - (value - y0) / (y1 - y0)) * plotHeight;
  const scale = `${width}|${height}|${x0}|${x1}|${y0}|${y1}`;
  const place = useMemo(
    () => new Map(props.points.map((point) => [point.id, point])),
    [props.points],
  );
  const marked = [...new Set([...props.pinned, props.opened, props.hovered])].flatMap((id) =>
    id === null ? [] : (place.get(id) ?? []),
  );
  // The other plots mark the same design; only the one under the pointer describes it.
  const [inside, setInside] = useState(false);
  const tipped = inside && props.hovered !== null ? place.get(props.hovered) : undefined;
  return (
    <div
      className="chart"
      ref={box}
      data-testid={props.testId}
      onPointerEnter={() => setInside(true)}
      onPointerLeave={() => setInside(false)}
    >
      {width > 40 && height > 40 && (
        <svg width={width} height={height} role="img" aria-label={props.label}>
          <Frame
            x={props.x}
            y={props.y}
            limits={[x0, x1, y0, y1]}
            size={[width, height]}
            toX={toX}
            toY={toY}
          />
          {props.lines?.map((line) => (
            <path
              key={line.color}
              d={pathOf(line.points, line.steps ?? false, toX, toY)}
              fill="none"
              stroke={`var(${line.color})`}
              strokeWidth="1.8"
              strokeLinejoin="round"
            />
          ))}
          <Points
            points={props.points}
            scale={scale}
            toX={toX}
            toY={toY}
            onHover={props.onHover}
            onChoose={props.onChoose}
          />
          {marked.map((point) => (
            <circle
              key={point.id}
              className={`chart-mark${props.pinned.includes(point.id) ? " pinned" : ""}`}
              cx={toX(point.x)}
              cy={toY(point.y)}
              r="7"
            />
          ))}
        </svg>
      )}
      {tipped && (
        <Tip x={toX(tipped.x)} y={toY(tipped.y)} width={width} height={height}>
          {props.tip(tipped.id)}
        </Tip>
      )}
    </div>
  );
}

/** A note beside a point, on the side where there is room. */
export function Tip(props: {
  x: number;
  y: number;
  width: number;
  height: number;
  children: ReactNode;
}) {
  const { x, y, width, height } = props;
  const sideways = x > width / 2 ? "-100%" : "0";
  const upwards = y > height / 2 ? "-100%" : "0";
  return (
    <div
      className="chart-tip"
      style={{
        left: x > width / 2 ? x - 12 : x + 12,
        top: y > height / 2 ? Math.min(height, y + 24) : Math.max(0, y - 24),
        transform: `translate(${sideways}, ${upwards})`,
      }}
    >
      {props.children}
    </div>
  );
}

function pathOf(
  points: readonly { x: number; y: number }[],
  steps: boolean,
  toX: (x: number) => number,
  toY: (y: number) => number,
): string {
  return points
    .map(({ x, y }, i) => {
      const at = `${toX(x).toFixed(1)} ${toY(y).toFixed(1)}`;
      if (i === 0) return `M${at}`;
      return steps ? `H${toX(x).toFixed(1)}V${toY(y).toFixed(1)}` : `L${at}`;
    })
    .join("");
}

export interface FrameProps {
  x: ChartAxis;
  y: ChartAxis;
  limits: readonly [number, number, number, number];
  size: readonly [number, number];
  toX(value: number): number;
  toY(value: number): number;
}

/** Label with its unit: "rise (mm)". */
export function axisTitle(label: string, kind: string): string {
  const unit = unitText(shownUnit(siUnit(kind)));
  return unit ? `${label} (${unit})` : label;
}

/** Lines of equal values with their numbers, and the names of both axes. */
export function Frame(props: FrameProps) {
  const [x0, x1, y0, y1] = props.limits;
  const [width, height] = props.size;
  const along = (axis: ChartAxis, low: number, high: number, pixels: number, each: number) => {
    const factor = factorOf(shownUnit(siUnit(axis.kind)));
    const marks = ticks(low / factor, high / factor, Math.max(2, Math.floor(pixels / each)));
    return (axis.whole ? marks.filter(Number.isInteger) : marks).map((mark) => ({
      at: mark * factor,
      text: formatNumber(mark, 4),
    }));
  };
  const bottom = height - BOTTOM;
  return (
    <g className="chart-frame">
      {along(props.x, x0, x1, width - LEFT - RIGHT, 80).map((mark) => (
        <g key={mark.at}>
          <path d={`M${props.toX(mark.at)} ${TOP}V${bottom}`} />
          <text x={props.toX(mark.at)} y={bottom + 14} textAnchor="middle">
            {mark.text}
          </text>
        </g>
      ))}
      {along(props.y, y0, y1, height - TOP - BOTTOM, 38).map((mark) => (
        <g key={mark.at}>
          <path d={`M${LEFT} ${props.toY(mark.at)}H${width - RIGHT}`} />
          <text x={LEFT - 6} y={props.toY(mark.at) + 4} textAnchor="end">
            {mark.text}
          </text>
        </g>
      ))}
      <text x={(LEFT + width - RIGHT) / 2} y={height - 6} textAnchor="middle">
        {axisTitle(props.x.label, props.x.kind)}
      </text>
      <text transform={`translate(12 ${(TOP + bottom) / 2}) rotate(-90)`} textAnchor="middle">
        {axisTitle(props.y.label, props.y.kind)}
      </text>
    </g>
  );
}

interface PointsProps {
  points: readonly ChartPoint[];
  /** Changes with the scale, so that points are placed again. */
  scale: string;
  toX(value: number): number;
  toY(value: number): number;
  onHover(id: number | null): void;
  onChoose(id: number, mark: boolean): void;
}

// Hundreds of circles: drawn again only when they or the scale change, not when one is hovered.
const Points = memo(
  (props: PointsProps) => (
    <g>
      {props.points.map((point) =>
        Number.isFinite(point.x) && Number.isFinite(point.y) ? (
          // biome-ignore lint/a11y/noStaticElementInteractions: the table does the same by keyboard
          <circle
            key={point.id}
            className={`chart-point${point.faded ? " faded" : ""}`}
            data-trial={point.id}
            cx={props.toX(point.x)}
            cy={props.toY(point.y)}
            r={point.hollow ? 3.5 : 4.5}
            fill={point.hollow ? "none" : point.color}
            stroke={point.hollow ? point.color : undefined}
            onPointerEnter={() => props.onHover(point.id)}
            onPointerLeave={() => props.onHover(null)}
            onClick={(event) => props.onChoose(point.id, event.shiftKey)}
          />
        ) : null,
      )}
    </g>
  ),
  (before, after) => before.points === after.points && before.scale === after.scale,
);
