import { useEffect, useRef } from "react";
import uPlot from "uplot";
import { ladder } from "../view/drawing/quality";
import { decadeName, decades, tickSpace } from "./axes";
import { formatNumber } from "./units";
import "uplot/dist/uPlot.min.css";

// Milliseconds between two drawings of data that keep coming.
const BETWEEN = 60;
const BETWEEN_WHERE_SLOW = 400;

export interface Series {
  readonly label: string;
  /** A CSS variable of theme.css, such as "--series-1". */
  readonly color: string;
  readonly dashed?: boolean;
  readonly points?: boolean;
  /** False: points alone. */
  readonly line?: boolean;
}

export interface PlotProps {
  label: string;
  x: { readonly label: string };
  y: { readonly label: string; readonly log?: boolean };
  series: readonly Series[];
  /** The x values and then each series, all of one length; NaN leaves a gap. */
  data: readonly ArrayLike<number>[];
  /** Plots of one group share the cursor. */
  group?: string;
  /** Draws a vertical line, such as the time that is shown. */
  mark?: number | null;
  onSeek?(x: number): void;
  testId?: string;
}

/** A line plot in the theme's colors; redrawn when its data change, sized to its box. */
export function Plot(props: PlotProps) {
  const box = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const latest = useRef(props);
  latest.current = props;
  const shape = `${props.series.map((s) => s.label + s.color).join("|")}|${props.x.label}|${props.y.label}|${props.y.log}`;

  useEffect(() => {
    const element = box.current;
    if (!element) return;
    const make = () => {
      plot.current?.destroy();
      plot.current = new uPlot(options(element, latest), toData(latest.current), element);
    };
    make();
    const resize = new ResizeObserver(() => plot.current?.setSize(sizeOf(element)));
    resize.observe(element);
    const theme = new MutationObserver(make);
    theme.observe(document.documentElement, { attributeFilter: ["data-theme"] });
    return () => {
      resize.disconnect();
      theme.disconnect();
      plot.current?.destroy();
      plot.current = null;
    };
    // The options read the latest properties; only a change of shape needs a new plot.
  }, [shape]);

  const timer = useRef<ReturnType<typeof setTimeout> | null>(null);
  const drawnAt = useRef(Number.NEGATIVE_INFINITY);
  useEffect(() => {
    if (timer.current !== null) return; // what is drawn then is the latest
    const draw = () => {
      timer.current = null;
      drawnAt.current = performance.now();
      plot.current?.setData(toData(latest.current));
    };
    const due = drawnAt.current + (ladder.slow ? BETWEEN_WHERE_SLOW : BETWEEN) - performance.now();
    if (due <= 0) draw();
    else timer.current = setTimeout(draw, due);
  }, [props]);
  useEffect(
    () => () => {
      if (timer.current !== null) clearTimeout(timer.current);
      timer.current = null;
    },
    [],
  );

  return (
    <div className="plot" role="img" aria-label={props.label} data-testid={props.testId} ref={box}>
      <div className="plot-key">
        {props.series.map((series) => (
          <span key={series.label}>
            <i
              className={series.dashed ? "is-dashed" : undefined}
              style={{
                borderColor: `var(${series.color})`,
                borderStyle: series.line === false ? "dotted" : series.dashed ? "dashed" : "solid",
              }}
            />
            {series.label}
          </span>
        ))}
      </div>
    </div>
  );
}

function sizeOf(element: HTMLElement): { width: number; height: number } {
  return { width: Math.max(element.clientWidth, 60), height: Math.max(element.clientHeight, 60) };
}

function toData(props: PlotProps): uPlot.AlignedData {
  const columns = props.data.map((column) =>
    Array.from(column, (value) => (Number.isFinite(value) ? value : null)),
  );
  while (columns.length < props.series.length + 1) columns.push([]);
  return columns as unknown as uPlot.AlignedData;
}

// Without a filter uPlot would leave out most of the labels again.
const LOGARITHMIC: uPlot.Axis = {
  splits: (plot, _axis, low, high) => decades(low, high, plot.bbox.height / devicePixelRatio),
  values: (_plot, ticks) => ticks.map(decadeName),
  filter: (_plot, ticks) => ticks,
};

function options(element: HTMLElement, latest: { current: PlotProps }): uPlot.Options {
  const style = getComputedStyle(document.documentElement);
  const css = (name: string) => style.getPropertyValue(name).trim();
  const { x, y, series, group } = latest.current;
  const axis = (label: string, size: number): uPlot.Axis => ({
    label,
    labelSize: 16,
    labelFont: `11px ${css("--font")}`,
    font: `11px ${css("--font")}`,
    size,
    gap: 3,
    stroke: css("--muted"),
    grid: { stroke: css("--line"), width: 1 },
    ticks: { stroke: css("--line"), width: 1, size: 4 },
    values: (_plot, ticks) => ticks.map((tick) => (tick === null ? "" : formatNumber(tick, 3))),
  });
  return {
    ...sizeOf(element),
    padding: [20, 12, 0, 0],
    scales: { x: { time: false }, y: { distr: y.log ? 3 : 1 } },
    axes: [
      { ...axis(x.label, 28), space: (_plot, _axis, _low, _high, pixels) => tickSpace(pixels) },
      { ...axis(y.label, 48), ...(y.log ? LOGARITHMIC : {}) },
    ],
    cursor: {
      points: { size: 6 },
      ...(group ? { sync: { key: group } } : {}),
      drag: { x: true, y: false },
    },
    series: [
      { label: x.label },
      ...series.map((one) => ({
        label: one.label,
        stroke: css(one.color),
        width: 1.5,
        pxAlign: 0, // whole pixels would make waves of smooth curves
        dash: one.dashed ? [5, 4] : undefined,
        ...(one.line === false ? { paths: () => null } : {}),
        // A single row, as an equilibrium leaves it, is no line.
        points: { show: (plot: uPlot) => one.points === true || plot.data[0].length < 2, size: 5 },
        spanGaps: true,
      })),
    ] as uPlot.Series[],
    hooks: {
      draw: [
        (plot) => {
          const mark = latest.current.mark;
          if (mark == null) return;
          const at = plot.valToPos(mark, "x", true);
          const { top, height, left, width } = plot.bbox;
          if (at < left || at > left + width) return;
          plot.ctx.save();
          plot.ctx.strokeStyle = css("--text");
          plot.ctx.globalAlpha = 0.6;
          plot.ctx.beginPath();
          plot.ctx.moveTo(at, top);
          plot.ctx.lineTo(at, top + height);
          plot.ctx.stroke();
          plot.ctx.restore();
        },
      ],
      ready: [
        (plot) => {
          plot.over.addEventListener("click", () => {
            const left = plot.cursor.left;
            if (left != null && left >= 0) latest.current.onSeek?.(plot.posToVal(left, "x"));
          });
        },
      ],
    },
  };
}
