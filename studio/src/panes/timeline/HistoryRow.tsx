// One history: its line, its points, and the numbers of the point that is chosen.
import { type KeyboardEvent, type PointerEvent, useEffect, useRef, useState } from "react";
import { Button } from "../../controls/Choice";
import { NumberField } from "../../controls/NumberField";
import { formatNumber } from "../../controls/units";
import type { HistoryLine } from "../../protocol";
import { useStudio } from "../../store/studio";
import { editAll } from "../design/edits";
import { ticks } from "../study/chart/ticks";
import {
  added,
  moved,
  type Point,
  pointsOf,
  rangeOf,
  removed,
  roomOf,
  round,
  snapped,
  snapStep,
  whole,
  written,
} from "./points";
import { type Axis, factorAt, MARGIN, ROW, timeAt, xOf, yOf } from "./scale";

export interface HistoryRowProps {
  line: HistoryLine;
  axis: Axis;
  /** The document as it is written, or null while it is not good. */
  source: Readonly<Record<string, unknown>> | null;
}

export function HistoryRow({ line, axis, source }: HistoryRowProps) {
  const kept = source && line.lives === "" ? pointsOf(line, source) : null;
  const [draft, setDraft] = useState<readonly Point[] | null>(null);
  const [chosen, choose] = useState<number | null>(null);
  const dragged = useRef<number | null>(null);
  /** True if arrow keys moved a point that the text does not have yet. */
  const nudged = useRef(false);
  /** Revision of the document that holds the newest change made here. */
  const awaited = useRef(0);
  const points = draft ?? kept;
  // Documents of earlier changes still arrive: the points must not jump back to those.
  useEffect(() => {
    const answered = revision() >= awaited.current;
    // A server that was started anew counts from one again.
    if (answered) awaited.current = 0;
    if (answered && dragged.current === null && !nudged.current) setDraft(null);
  }, [line]);

  const range = rangeOf(line.factors);
  const times = points?.map(({ time }) => time) ?? line.times;
  const factors = points?.map(({ factor }) => factor) ?? line.factors;
  const [allTimes, allFactors] = whole(times, factors, line.repeat);
  const path = (xs: readonly number[], ys: readonly number[]) =>
    xs.map((time, i) => `${i ? "L" : "M"}${xOf(time, axis)} ${yOf(ys[i]!, range)}`).join("");
  const held = [...allTimes, axis.end];
  const line_ = path(held, [...allFactors, allFactors.at(-1) ?? 1]);
  const start = times[0] ?? 0;
  const before = start > 0 ? path([0, start], [factors[0]!, factors[0]!]) : "";

  const commit = (next: readonly Point[]) => {
    if (!kept) return;
    nudged.current = false;
    setDraft(next);
    awaited.current = Math.max(awaited.current, revision()) + 1;
    editAll(written(line, next));
  };
  const place = (event: { clientX: number; clientY: number }, svg: Element, fine: boolean) => {
    const { left, top } = svg.getBoundingClientRect();
    return {
      time: snapped(timeAt(event.clientX - left, axis), snapStep(axis.end, fine)),
      factor: snapped(factorAt(event.clientY - top, range), snapStep(range[1] - range[0], fine)),
    };
  };
  const add = (time: number, factor: number): boolean => {
    const found = points && added(points, time, factor, line);
    if (!found) return false;
    commit(found.points);
    choose(found.index);
    return true;
  };
  const remove = (index: number) => {
    const next = points && removed(points, index, line);
    if (!next) return;
    commit(next);
    choose(Math.min(index, next.length - 1));
  };

  const onPointerMove = (event: PointerEvent<SVGSVGElement>) => {
    const index = dragged.current;
    if (index === null || !points) return;
    const { time, factor } = place(event, event.currentTarget, event.shiftKey);
    setDraft(moved(points, index, time, factor, line));
  };
  const onPointerUp = () => {
    if (dragged.current === null) return;
    dragged.current = null;
    if (draft) commit(draft);
  };
  const onKeyDown = (event: KeyboardEvent, index: number) => {
    const point = points?.[index];
    if (!points || !point) return;
    const steps = KEYS[event.key];
    if (steps) {
      const by = (count: number, span: number) => count * snapStep(span, event.shiftKey);
      const time = point.time + by(steps[0], axis.end);
      const factor = point.factor + by(steps[1], range[1] - range[0]);
      nudged.current = true;
      setDraft(moved(points, index, round(time), round(factor), line));
    } else if (event.key === "Delete" || event.key === "Backspace") remove(index);
    else if (event.key === "Enter" || event.key === "Insert") add(...beside(points, index, axis));
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  // Holding an arrow key is one change of the text.
  const settle = () => {
    if (nudged.current && draft) commit(draft);
  };

  return (
    <div className="history" data-testid={`history-${line.path.join("-")}`}>
      <div className="history-head">
        <strong>{line.title}</strong>
        <span className="muted">{about(line)}</span>
      </div>
      <svg
        className="history-plot"
        width={axis.width}
        height={ROW}
        role="group"
        aria-label={`${line.title} over time`}
        onDoubleClick={(event) => {
          // If the round time has a point already, one beside it was meant.
          const places = [event.shiftKey, true].map((fine) =>
            place(event, event.currentTarget, fine),
          );
          places.some(({ time, factor }) => add(time, factor));
        }}
        onPointerMove={onPointerMove}
        onPointerUp={onPointerUp}
        onPointerCancel={onPointerUp}
      >
        <Grid axis={axis} range={range} />
        <path className="history-line is-held" d={before} />
        <path className="history-line" d={line_} />
        {points?.map(({ time, factor }, index) => (
          <g
            // biome-ignore lint/suspicious/noArrayIndexKey: points have their order for a name
            key={index}
            className={`history-point${chosen === index ? " is-chosen" : ""}`}
            transform={`translate(${xOf(time, axis)} ${yOf(factor, range)})`}
            role="slider"
            tabIndex={0}
            aria-label={`Point ${index + 1} of ${line.title}`}
            aria-valuenow={factor}
            aria-valuetext={`${formatNumber(time, 5)} s, factor ${formatNumber(factor, 5)}`}
            onFocus={() => choose(index)}
            onKeyDown={(event) => onKeyDown(event, index)}
            onKeyUp={settle}
            onBlur={settle}
            onDoubleClick={(event) => event.stopPropagation()}
            onPointerDown={(event) => {
              if (event.button !== 0) return;
              choose(index);
              dragged.current = index;
              event.currentTarget.closest("svg")?.setPointerCapture(event.pointerId);
            }}
          >
            <circle r={11} className="history-reach" />
            <circle r={4.5} />
          </g>
        ))}
      </svg>
      {points && chosen !== null && points[chosen] && (
        <PointFields
          points={points}
          index={chosen}
          line={line}
          axis={axis}
          onMove={(time, factor) => commit(moved(points, chosen, time, factor, line))}
          onAdd={add}
          onRemove={() => remove(chosen)}
        />
      )}
    </div>
  );
}

const revision = () => useStudio.getState().document?.rev ?? 0;

const KEYS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** A place for a new point: half way to the next one, or a step beyond the last. */
function beside(points: readonly Point[], index: number, axis: Axis): [number, number] {
  const [here, next] = [points[index]!, points[index + 1]];
  if (!next) return [here.time + snapStep(axis.end, false) * 2, here.factor];
  return [(here.time + next.time) / 2, (here.factor + next.factor) / 2];
}

/** An amount with its exponents raised. */
export function setInType(amount: string): string {
  return amount.replaceAll("^2", "²").replaceAll("^3", "³");
}

/** Entries that use it, and the text of a history that is no list of points. */
function about(line: HistoryLine): string {
  const named = line.path.at(-2) === "histories";
  const users = line.used_by.map(({ title, amount }) => {
    const one = amount && `1 is ${setInType(amount)}`;
    // The history of a body needs its name.
    const whose = named || line.path[0] === "bodies";
    return whose ? [title, one && `(${one})`].filter(Boolean).join(" ") : one;
  });
  const followed = named && users.length === 0 ? "nothing follows it" : users.join(", ");
  const repeat = line.repeat > 1 ? `${line.repeat} times` : "";
  const many = line.way === "points" && line.times.length > 200 ? "changed in the text" : "";
  const elsewhere = line.lives && `written in ${line.lives}, changed there`;
  return [followed, line.words, repeat, elsewhere || many].filter(Boolean).join(" · ");
}

function Grid(props: { axis: Axis; range: readonly [number, number] }) {
  const { axis, range } = props;
  const [left, right] = [MARGIN.left, axis.width - MARGIN.right];
  return (
    <g className="history-grid">
      {ticks(range[0], range[1], 3).map((factor) => (
        <g key={factor}>
          <path d={`M${left} ${yOf(factor, range)}H${right}`} />
          <text x={left - 6} y={yOf(factor, range) + 4}>
            {formatNumber(factor, 3)}
          </text>
        </g>
      ))}
    </g>
  );
}

function PointFields(props: {
  points: readonly Point[];
  index: number;
  line: HistoryLine;
  axis: Axis;
  onMove(time: number, factor: number): void;
  onAdd(time: number, factor: number): void;
  onRemove(): void;
}) {
  const { points, index, line } = props;
  const { time, factor } = points[index]!;
  const room = roomOf(points, index, line);
  const bounds = ([low, high]: readonly [number, number]) => ({
    min: Number.isFinite(low) ? low : null,
    max: Number.isFinite(high) ? high : null,
    disabled: low === high,
    title: low === high ? "A formula of the text: change it there" : "",
  });
  return (
    <div className="history-fields">
      <NumberField
        label={`Time ${index + 1}`}
        value={time}
        unit="s"
        {...bounds(room.time)}
        onChange={(next) => props.onMove(next, factor)}
      />
      <NumberField
        label={`Factor ${index + 1}`}
        value={factor}
        {...bounds(room.factor)}
        onChange={(next) => props.onMove(time, next)}
      />
      <span className="row">
        <Button kind="quiet" onClick={() => props.onAdd(...beside(points, index, props.axis))}>
          Add a point
        </Button>
        <Button
          kind="quiet"
          disabled={removed(points, index, line) === null}
          onClick={props.onRemove}
        >
          Remove
        </Button>
      </span>
    </div>
  );
}
