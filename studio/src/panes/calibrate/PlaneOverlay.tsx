// Measured and simulated stations over each other in a plane, at true proportions.
import { Fragment, type ReactNode, useMemo, useState } from "react";
import { Select } from "../../controls/Choice";
import { formatKind } from "../../controls/kinds";
import { formatNumber } from "../../controls/units";
import type { OverlayExperiment, Triple } from "../../protocol";
import { ticks } from "../study/chart/ticks";
import { useSize } from "../study/chart/useSize";
import { AXES, bestPlane, fitPlane } from "./plane";
import "../study/chart/chart.css";
import "./calibrate.css";

const MARGIN = { left: 56, right: 24, top: 20, bottom: 40 };

export function PlaneOverlay(props: {
  experiments: readonly OverlayExperiment[];
  /** Content of the bar before the choice of the plane. */
  bar: ReactNode;
}) {
  const { experiments } = props;
  const [box, { width, height }] = useSize<HTMLDivElement>();
  const [requested, setRequested] = useState<string | null>(null);
  const [pointed, point] = useState<readonly [number, number] | null>(null);
  const all = useMemo(
    () => experiments.flatMap((one) => [...one.measured, ...one.simulated]),
    [experiments],
  );
  const [h, v] = useMemo(() => {
    if (requested !== null) return [Number(requested[0]), Number(requested[1])] as const;
    return bestPlane(all);
  }, [requested, all]);
  const fitted = useMemo(
    () =>
      fitPlane(
        all.map((one): [number, number] => [one[h] ?? 0, one[v] ?? 0]),
        width,
        height,
        MARGIN,
      ),
    [all, h, v, width, height],
  );
  const at = (one: Triple) => [fitted.toX(one[h] ?? 0), fitted.toY(one[v] ?? 0)] as const;
  const marks = (axis: 0 | 1, pixels: number) =>
    ticks(fitted.low[axis] * 1e3, fitted.high[axis] * 1e3, Math.max(2, Math.floor(pixels / 70)));
  const held = pointed && experiments[pointed[0]];
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        {props.bar}
        <Select
          bare
          label="Plane of the overlay"
          value={`${h}${v}`}
          options={[
            { value: "02", label: "x and z" },
            { value: "01", label: "x and y" },
            { value: "12", label: "y and z" },
          ]}
          onChange={setRequested}
        />
      </div>
      <div className="chart" ref={box} data-testid="overlay-chart">
        {width > 80 && height > 80 && (
          <svg width={width} height={height} role="img" aria-label="Measured and simulated shape">
            <g className="chart-frame">
              {marks(0, width).map((mark) => (
                <Fragment key={mark}>
                  <path
                    d={`M${fitted.toX(mark / 1e3)} ${MARGIN.top - 8}V${height - MARGIN.bottom + 6}`}
                  />
                  <text
                    x={fitted.toX(mark / 1e3)}
                    y={height - MARGIN.bottom + 20}
                    textAnchor="middle"
                  >
                    {formatNumber(mark)}
                  </text>
                </Fragment>
              ))}
              {marks(1, height).map((mark) => (
                <Fragment key={mark}>
                  <path d={`M${MARGIN.left - 6} ${fitted.toY(mark / 1e3)}H${width - 8}`} />
                  <text x={MARGIN.left - 10} y={fitted.toY(mark / 1e3) + 4} textAnchor="end">
                    {formatNumber(mark)}
                  </text>
                </Fragment>
              ))}
              <text x={width / 2} y={height - 6} textAnchor="middle">
                {AXES[h]} (mm)
              </text>
              <text transform={`translate(12 ${height / 2}) rotate(-90)`} textAnchor="middle">
                {AXES[v]} (mm)
              </text>
            </g>
            {experiments.map((experiment, e) => (
              <g key={experiment.name} className={`overlay-${e % 4}`}>
                <path
                  className="overlay-line"
                  d={experiment.simulated
                    .map((one, i) => `${i ? "L" : "M"}${at(one).join(" ")}`)
                    .join("")}
                />
                {experiment.measured.map((one, i) => {
                  const [mx, my] = at(one);
                  const [sx, sy] = at(experiment.simulated[i] ?? one);
                  return (
                    // biome-ignore lint/suspicious/noArrayIndexKey: stations have their order for a name
                    <Fragment key={i}>
                      <path className="overlay-error" d={`M${mx} ${my}L${sx} ${sy}`} />
                      <circle className="overlay-simulated" cx={sx} cy={sy} r="3" />
                      <circle
                        className="overlay-measured"
                        cx={mx}
                        cy={my}
                        r="5.5"
                        onPointerEnter={() => point([e, i])}
                        onPointerLeave={() => point(null)}
                      />
                    </Fragment>
                  );
                })}
              </g>
            ))}
          </svg>
        )}
        {held && pointed && (
          <div className="chart-tip" style={{ left: MARGIN.left + 8, bottom: MARGIN.bottom + 8 }}>
            <strong>
              {held.name}, station {pointed[1] + 1}
            </strong>
            <dl>
              <dt>error</dt>
              <dd>{formatKind(held.error[pointed[1]], "length", 3)}</dd>
              <dt>of the sag</dt>
              <dd>{formatNumber(held.percent[pointed[1]] ?? Number.NaN, 3)} %</dd>
            </dl>
          </div>
        )}
      </div>
    </div>
  );
}
