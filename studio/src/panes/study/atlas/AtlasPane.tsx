// All designs of a study as pictures: on a map of two quantities, or in rows, the best first.
import { type KeyboardEvent, useCallback, useEffect, useMemo, useState } from "react";
import { Button, Select, Toggle } from "../../../controls/Choice";
import { Frame, MARGINS, Tip } from "../chart/PointChart";
import { useSize } from "../chart/useSize";
import { coloring } from "../colors";
import { type CurrentStudy, useStudy } from "../current";
import { NoStudy } from "../NoStudy";
import { choose, clearBrushes, select, useSelection } from "../selection";
import { TrialTip } from "../TrialTip";
import { type Axis, bestFirst, isDone, remaining, textOn, valueOn, within } from "../trials";
import { mostImportant } from "./importance";
import { attendPictures, longestSide, nameOf, usePictures } from "./pictures";
import { placed } from "./places";
import { Requirements } from "./Requirements";
import { TrialCard } from "./TrialCard";
import { TrialFrame, type TrialFrameProps } from "./TrialFrame";
import "../chart/chart.css";
import "../study.css";
import "./atlas.css";

export default function AtlasPane() {
  const current = useStudy();
  if (!current || current.study.trials.length === 0) {
    return <NoStudy what="Each design that a study tried, as a picture of it at rest." />;
  }
  return <Atlas current={current} />;
}

/** Frames that are drawn; each costs the page time whenever a trial arrives. */
const MOST = 1000;
const SIZES = { least: 44, small: 60, usual: 88, most: 180 };
/** Designs of which pictures of the usual size cover each other. */
const MANY = 60;

type Arrangement = "map" | "grid";

function Atlas(props: { current: CurrentStudy }) {
  const { id, study, axes, front } = props.current;
  const { hovered, pinned, selected, brushes } = useSelection();
  const [arrangement, arrange] = useState<Arrangement>("map");
  const [xKey, setX] = useState<string | null>(null);
  const [yKey, setY] = useState<string | null>(null);
  const [wanted, setSize] = useState<number | null>(null);
  const [scaled, setScaled] = useState(true);
  const [asking, ask] = useState(true);
  const pictures = usePictures();
  useEffect(() => {
    attendPictures(id);
  }, [id]);

  const best = useMemo(() => bestFirst(study, front), [study, front]);
  const trials = useMemo(() => best.slice(0, MOST), [best]);
  const usual = useMemo(() => mostImportant(study.trials, axes), [study, axes]);
  const crowded = arrangement === "map" && study.trials.length > MANY;
  const size = wanted ?? (crowded ? SIZES.small : SIZES.usual);
  const objective = axes.find((axis) => axis.role === "objective");
  const x = axes.find((axis) => axis.key === xKey) ?? usual ?? axes[0];
  const y = axes.find((axis) => axis.key === yKey) ?? objective ?? axes[0];
  const colors = useMemo(() => coloring(study, axes), [study, axes]);
  const longest = scaled ? longestSide(Object.values(pictures)) : 0;
  const unloaded = Object.values(pictures).filter((one) => one.url && !one.atRest).length;
  const left = remaining(study.trials, axes, brushes);
  const brushed = Object.keys(brushes).length > 0;
  const failed = study.trials.filter((trial) => !isDone(trial)).length;

  const onOpen = useCallback((trial: number) => choose(id, trial, false), [id]);
  const first = selected ?? trials[0]?.index;
  const frameOf = (trial: CurrentStudy["study"]["trials"][number]): TrialFrameProps => ({
    job: id,
    trial,
    size,
    longest,
    value: objective && isDone(trial) ? textOn(valueOn(trial, objective), objective, 3) : "",
    color: colors.color(trial),
    best: trial.index === best[0]?.index && isDone(trial),
    dimmed:
      (isDone(trial) && !trial.feasible) ||
      (brushed && !(isDone(trial) && within(trial, axes, brushes))),
    selected: trial.index === selected,
    pinned: pinned.includes(trial.index),
    hovered: trial.index === hovered,
    captioned: arrangement === "grid",
    tabIndex: trial.index === first ? 0 : -1,
    onSelect: select,
    onOpen,
  });
  const options = axes.map((axis) => ({ value: axis.key, label: axis.name }));
  return (
    <div className="plot-pane atlas" data-testid="atlas">
      <div className="plot-bar">
        <Select
          bare
          label="Arrangement"
          value={arrangement}
          options={[
            { value: "map", label: "Map" },
            { value: "grid", label: "Best first" },
          ]}
          onChange={(next) => arrange(next as Arrangement)}
        />
        {arrangement === "map" && x && y && (
          <>
            <Select bare label="Map up" value={y.key} options={options} onChange={setY} />
            <span className="muted">over</span>
            <Select bare label="Map across" value={x.key} options={options} onChange={setX} />
          </>
        )}
        <input
          className="atlas-size"
          type="range"
          aria-label="Size of the pictures"
          title="Size of the pictures"
          min={SIZES.least}
          max={SIZES.most}
          value={size}
          onChange={(event) => setSize(Number(event.target.value))}
        />
        <Toggle
          label="one scale"
          title="Draw all designs to one scale, so that larger ones are larger"
          checked={scaled}
          onChange={setScaled}
        />
        <strong data-testid="remaining" role="status">
          {brushed
            ? `${left} of ${study.trials.length} remain`
            : `${study.trials.length} designs${failed > 0 ? `, ${failed} without result` : ""}`}
        </strong>
        {brushed && (
          <Button kind="quiet" testId="clear-requirements" onClick={clearBrushes}>
            Show all
          </Button>
        )}
        {best.length > MOST && <span className="muted">the best {MOST} are drawn</span>}
        {unloaded > 0 && (
          <span className="muted" title="Of these the equilibrium is not stored.">
            {unloaded === 1 ? "1 picture shows" : `${unloaded} pictures show`} the unloaded shape
          </span>
        )}
        {!asking && (
          <span className="atlas-push">
            <Button testId="requirements-open" onClick={() => ask(true)}>
              Requirements
            </Button>
          </span>
        )}
      </div>
      <div className="atlas-body">
        {arrangement === "map" && x && y ? (
          <TrialMap trials={trials} x={x} y={y} size={size} axes={axes} frameOf={frameOf} />
        ) : (
          // biome-ignore lint/a11y/noStaticElementInteractions: arrow keys move among its buttons
          <div className="atlas-grid" data-testid="atlas-grid" onKeyDown={moveFocus}>
            {trials.map((trial) => (
              <TrialFrame key={nameOf(id, trial.index)} {...frameOf(trial)} />
            ))}
          </div>
        )}
        {asking && <Requirements trials={study.trials} axes={axes} onClose={() => ask(false)} />}
      </div>
      <TrialCard current={props.current} />
    </div>
  );
}

interface TrialMapProps {
  trials: CurrentStudy["study"]["trials"];
  x: Axis;
  y: Axis;
  size: number;
  axes: readonly Axis[];
  frameOf(trial: CurrentStudy["study"]["trials"][number]): TrialFrameProps;
}

function TrialMap(props: TrialMapProps) {
  const { trials, x, y, size, axes } = props;
  const [box, { width, height }] = useSize<HTMLDivElement>();
  const hovered = useSelection((selection) => selection.hovered);
  const [inside, setInside] = useState(false);
  const half = size / 2;
  const map = useMemo(
    () =>
      placed(trials, x, y, {
        left: MARGINS.left + half,
        right: Math.max(MARGINS.left + half + 1, width - MARGINS.right - half),
        top: MARGINS.top + half,
        bottom: Math.max(MARGINS.top + half + 1, height - MARGINS.bottom - half),
        rail: size,
      }),
    [trials, x, y, width, height, half, size],
  );
  const tipped = map.places.find((place) => place.trial.index === hovered);
  const ready = width > 120 && height > 120;
  return (
    // biome-ignore lint/a11y/noStaticElementInteractions: arrow keys move among its buttons
    <div
      className="chart atlas-map"
      ref={box}
      data-testid="atlas-map"
      onKeyDown={moveFocus}
      onPointerEnter={() => setInside(true)}
      onPointerLeave={() => setInside(false)}
    >
      {ready && (
        <svg width={width} height={height} role="img" aria-label={`${y.name} over ${x.name}`}>
          <Frame
            x={{ label: x.name, kind: x.kind, range: [0, 1] }}
            y={{ label: y.name, kind: y.kind, range: [0, 1] }}
            limits={map.limits}
            size={[width, height]}
            toX={map.toX}
            toY={map.toY}
          />
          {map.places
            .filter((place) => place.x !== place.atX)
            .map(({ trial, x, y, atX }) => (
              <g key={trial.index} className="atlas-leader">
                <line x1={atX} y1={y} x2={x} y2={y} />
                <circle cx={atX} cy={y} r={2.5} />
              </g>
            ))}
        </svg>
      )}
      {ready &&
        map.places.map((place, i) => {
          const frame = props.frameOf(place.trial);
          // The best lie over the others.
          const at = { left: place.x - half, top: place.y - half, rank: map.places.length - i };
          return <TrialFrame key={nameOf(frame.job, place.trial.index)} {...frame} {...at} />;
        })}
      {tipped && inside && (
        <Tip x={tipped.x} y={tipped.y} width={width} height={height}>
          <TrialTip trial={tipped.trial} axes={axes} />
        </Tip>
      )}
    </div>
  );
}

/** Arrow keys go from one picture to the next. */
function moveFocus(event: KeyboardEvent<HTMLElement>): void {
  const by = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
  if (by === undefined || !(event.target instanceof HTMLElement)) return;
  const frames = [...event.currentTarget.querySelectorAll<HTMLElement>(".trial-frame")];
  const next = frames[frames.indexOf(event.target) + by];
  if (!next) return;
  next.focus();
  event.preventDefault();
}
