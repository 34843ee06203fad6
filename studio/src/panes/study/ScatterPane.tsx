// Designs in space: three quantities along the axes, a fourth as color, a fifth as size.
import { useEffect, useMemo, useRef, useState } from "react";
import { Select } from "../../controls/Choice";
import { gradient } from "../../view/body/colormaps";
import { axisTitle, Tip } from "./chart/PointChart";
import { CORNERS, EDGES, labelEdge, type Projected, project, type Turn } from "./chart/space";
import { useSize } from "./chart/useSize";
import { coloring } from "./colors";
import { type CurrentStudy, useStudy } from "./current";
import { NoStudy } from "./NoStudy";
import { choose, hover, useSelection } from "./selection";
import { TrialTip } from "./TrialTip";
import { type Axis, isDone, rangeOf, textOn, valueOn, within } from "./trials";
import "./chart/chart.css";
import "./study.css";

export default function ScatterPane() {
  const current = useStudy();
  if (!current || current.study.trials.length === 0) {
    return <NoStudy what="Designs in the space of three parameters, colored by the objective." />;
  }
  return <Scatter current={current} />;
}

interface Dot {
  readonly index: number;
  readonly at: readonly [number, number, number];
  readonly color: string;
  readonly radius: number;
  readonly faded: boolean;
}

const START: Turn = { around: 0.6, above: 0.42, zoom: 1 };

function Scatter(props: { current: CurrentStudy }) {
  const { id, study, axes } = props.current;
  const selection = useSelection();
  const { hovered, pinned, opened, brushes } = selection;
  const [box, { width, height }] = useSize<HTMLDivElement>();
  const canvas = useRef<HTMLCanvasElement>(null);
  const [turn, setTurn] = useState(START);
  const [requested, setRequested] = useState<Readonly<Record<string, string>>>({});
  const [theme, retheme] = useState(0);
  const [inside, setInside] = useState(false);
  const places = useRef<readonly (Projected & { index: number; radius: number })[]>([]);
  const drag = useRef<{ x: number; y: number; moved: boolean; turn: Turn } | null>(null);

  const chosen = useMemo(() => {
    const usual = axes.filter((axis) => axis.role !== "metric");
    const pick = (slot: string, fallback: Axis | undefined) =>
      axes.find((axis) => axis.key === requested[slot]) ?? fallback;
    const objectives = axes.filter((axis) => axis.role === "objective");
    return {
      x: pick("x", usual[0]),
      y: pick("y", usual[1] ?? usual[0]),
      z: pick("z", usual[2] ?? objectives[0] ?? usual[0]),
      color: pick("color", objectives[0]),
      size: axes.find((axis) => axis.key === requested.size) ?? objectives[1],
    };
  }, [axes, requested]);

  const colors = useMemo(() => coloring(study, axes, chosen.color), [study, axes, chosen.color]);

  const dots = useMemo((): Dot[] => {
    const { x, y, z, size } = chosen;
    if (!x || !y || !z) return [];
    const done = study.trials.filter(isDone);
    const unit = (axis: Axis) => {
      const [low, high] = axis.choices
        ? [0, Math.max(1, axis.choices.length - 1)]
        : rangeOf(done.map((trial) => valueOn(trial, axis)));
      return (value: number) => ((value - low) / (high - low)) * 2 - 1;
    };
    const [ux, uy, uz] = [unit(x), unit(y), unit(z)];
    const us = size ? unit(size) : null;
    return done.map((trial) => ({
      index: trial.index,
      at: [ux(valueOn(trial, x)), uy(valueOn(trial, y)), uz(valueOn(trial, z))],
      color: colors.color(trial),
      radius: us && size ? 5 + 2.5 * us(valueOn(trial, size)) : 5,
      faded: !within(trial, axes, brushes),
    }));
  }, [study, axes, chosen, colors, brushes]);

  useEffect(() => {
    const watch = new MutationObserver(() => retheme((n) => n + 1));
    watch.observe(document.documentElement, { attributeFilter: ["data-theme"] });
    return () => watch.disconnect();
  }, []);

  useEffect(() => {
    const element = canvas.current;
    if (!element || width < 60 || height < 60) return;
    const ratio = devicePixelRatio;
    element.width = width * ratio;
    element.height = height * ratio;
    const context = element.getContext("2d");
    if (!context) return;
    context.scale(ratio, ratio);
    places.current = draw(context, width, height, turn, dots, chosen, { hovered, opened, pinned });
  }, [width, height, turn, dots, chosen, hovered, opened, pinned, theme]);

  const nearest = (event: { nativeEvent: { offsetX: number; offsetY: number } }) => {
    const { offsetX, offsetY } = event.nativeEvent;
    let found: number | null = null;
    let best = 12;
    for (const place of places.current) {
      const distance = Math.hypot(place.x - offsetX, place.y - offsetY);
      if (distance <= best) {
        best = distance;
        found = place.index;
      }
    }
    return found;
  };
  const options = axes.map((axis) => ({ value: axis.key, label: axis.name }));
  const slot = (name: "x" | "y" | "z" | "color" | "size", label: string) => (
    <div className="scatter-slot">
      <span aria-hidden="true">{label}</span>
      <Select
        bare
        label={`Design space ${label}`}
        value={chosen[name]?.key ?? ""}
        options={name === "size" ? [{ value: "", label: "equal" }, ...options] : options}
        onChange={(value) => setRequested({ ...requested, [name]: value })}
      />
    </div>
  );
  const tipped = study.trials.find((trial) => trial.index === hovered);
  const place = places.current.find((one) => one.index === hovered);
  const [low, high] = colors.range;
  return (
    <div className="plot-pane">
      <div className="scatter-bar">
        {slot("x", "x")}
        {slot("y", "y")}
        {slot("z", "z")}
        {slot("color", "color")}
        {slot("size", "size")}
      </div>
      <div className="chart" ref={box} data-testid="scatter-chart">
        <canvas
          ref={canvas}
          className="scatter-canvas"
          role="img"
          aria-label="Designs in space; drag to turn"
          onPointerDown={(event) => {
            event.currentTarget.setPointerCapture(event.pointerId);
            drag.current = { x: event.clientX, y: event.clientY, moved: false, turn };
          }}
          onPointerMove={(event) => {
            const held = drag.current;
            if (!held) {
              hover(nearest(event));
              return;
            }
            const [dx, dy] = [event.clientX - held.x, event.clientY - held.y];
            if (Math.hypot(dx, dy) > 3) held.moved = true;
            setTurn({
              ...held.turn,
              around: held.turn.around - dx * 0.01,
              above: Math.max(-1.5, Math.min(1.5, held.turn.above + dy * 0.01)),
            });
          }}
          onPointerUp={(event) => {
            const index = nearest(event);
            if (drag.current && !drag.current.moved && index !== null) {
              choose(id, index, event.shiftKey);
            }
            drag.current = null;
          }}
          onPointerEnter={() => setInside(true)}
          onPointerLeave={() => {
            setInside(false);
            hover(null);
          }}
          onDoubleClick={() => setTurn(START)}
          onWheel={(event) =>
            setTurn({
              ...turn,
              zoom: Math.max(0.4, Math.min(4, turn.zoom * Math.exp(-event.deltaY * 0.001))),
            })
          }
        />
        {colors.axis && (
          <div className="scatter-legend">
            <span>{textOn(colors.turned ? low : high, colors.axis, 3)}</span>
            <i style={{ background: gradient("viridis", 0) }} />
            <span>{textOn(colors.turned ? high : low, colors.axis, 3)}</span>
          </div>
        )}
        {tipped && place && inside && (
          <Tip x={place.x} y={place.y} width={width} height={height}>
            <TrialTip trial={tipped} axes={axes} />
          </Tip>
        )}
      </div>
    </div>
  );
}

function draw(
  context: CanvasRenderingContext2D,
  width: number,
  height: number,
  turn: Turn,
  dots: readonly Dot[],
  axes: { x?: Axis | undefined; y?: Axis | undefined; z?: Axis | undefined },
  marks: { hovered: number | null; opened: number | null; pinned: readonly number[] },
): (Projected & { index: number; radius: number })[] {
  const style = getComputedStyle(document.documentElement);
  const css = (name: string) => style.getPropertyValue(name).trim();
  context.clearRect(0, 0, width, height);
  const corners = CORNERS.map((corner) => project(corner, turn, width, height));
  const farthest = corners.reduce(
    (best, one, i) => (one.near < (corners[best]?.near ?? 0) ? i : best),
    0,
  );
  context.lineWidth = 1;
  for (const [a, b] of EDGES) {
    const [p, q] = [corners[a], corners[b]];
    if (!p || !q) continue;
    // The three edges behind are drawn faint, as walls of a room.
    context.strokeStyle = a === farthest || b === farthest ? css("--line") : css("--line-strong");
    context.beginPath();
    context.moveTo(p.x, p.y);
    context.lineTo(q.x, q.y);
    context.stroke();
  }
  context.font = `11px ${css("--font")}`;
  context.fillStyle = css("--muted");
  context.textBaseline = "middle";
  for (const [i, axis] of [axes.x, axes.y, axes.z].entries()) {
    if (!axis) continue;
    const [a, b] = labelEdge(i as 0 | 1 | 2, corners);
    const [p, q] = [corners[a], corners[b]];
    if (!p || !q) continue;
    const [x, y] = [(p.x + q.x) / 2, (p.y + q.y) / 2];
    const away = i === 2 ? [-8, 0] : [x < width / 2 ? -6 : 6, 14];
    context.textAlign = i === 2 ? "right" : x < width / 2 ? "right" : "left";
    const label = axisTitle(axis.name, axis.kind);
    const wide = context.measureText(label).width;
    const at = x + (away[0] ?? 0);
    const held =
      context.textAlign === "right" ? Math.max(at, wide + 4) : Math.min(at, width - wide - 4);
    context.fillText(label, held, y + (away[1] ?? 0));
  }
  const placed = dots
    .map((dot) => ({ ...project(dot.at, turn, width, height), dot }))
    .sort((a, b) => a.near - b.near);
  for (const { x, y, near, dot } of placed) {
    context.globalAlpha = dot.faded ? 0.1 : 1;
    const radius = dot.radius * (1 + 0.12 * near);
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fillStyle = dot.color.startsWith("var(") ? css(dot.color.slice(4, -1)) : dot.color;
    context.fill();
    context.strokeStyle = css("--panel");
    context.stroke();
    context.globalAlpha = 1;
    const pinned = marks.pinned.includes(dot.index);
    if (pinned || dot.index === marks.opened || dot.index === marks.hovered) {
      context.lineWidth = 2;
      context.strokeStyle = pinned ? css("--accent") : css("--text");
      context.beginPath();
      context.arc(x, y, radius + 3, 0, 2 * Math.PI);
      context.stroke();
      context.lineWidth = 1;
    }
  }
  return placed.map(({ x, y, near, dot }) => ({
    x,
    y,
    near,
    index: dot.index,
    radius: dot.radius,
  }));
}
