// A trial as a picture in a frame; one that failed is an empty frame with its reason.
import { type CSSProperties, memo, useEffect, useRef } from "react";
import type { TrialEvent } from "../../../protocol";
import { hover } from "../selection";
import { isDone } from "../trials";
import { nameOf, sizeIn, unwant, usePictures, want } from "./pictures";

/** Around a picture, pixels; as atlas.css has it. */
const PADDING = 4;

export interface TrialFrameProps {
  job: string;
  trial: TrialEvent;
  /** Side of the frame, pixels. */
  size: number;
  /** The longest side of all pictured bodies, m; 0 to fill each frame. */
  longest: number;
  /** Value of the first objective, in words. */
  value: string;
  /** Color of the line below the picture. */
  color: string;
  best: boolean;
  dimmed: boolean;
  selected: boolean;
  pinned: boolean;
  hovered: boolean;
  /** True if the caption is shown, and not only spoken. */
  captioned: boolean;
  /** Place on a map, pixels, and the order of overlapping ones. */
  left?: number;
  top?: number;
  rank?: number;
  tabIndex: number;
  onSelect(trial: number, mark: boolean): void;
  onOpen(trial: number): void;
}

export const TrialFrame = memo((props: TrialFrameProps) => {
  const { job, trial, size, captioned } = props;
  const frame = useRef<HTMLButtonElement>(null);
  const name = nameOf(job, trial.index);
  const picture = usePictures((all) => all[name]);
  const done = isDone(trial);
  useEffect(() => {
    const element = frame.current;
    if (!element || !done) return;
    const leave = watch(element, (seen) => (seen ? want(name) : unwant(name)));
    return () => {
      leave();
      unwant(name);
    };
  }, [name, done]);
  const unloaded = picture?.url !== undefined && picture.url !== "" && !picture.atRest;
  // The content of the caption is read from there.
  const unseen = captioned ? "" : ` ${trial.index}, ${done ? props.value : trial.status}`;
  const notes = [props.best ? "best" : "", unloaded && !captioned ? "unloaded" : ""];
  const words = [`Design${unseen}`, ...notes].filter(Boolean).join(", ");
  const { left, top, rank } = props;
  const place = { left, top, width: size, "--rank": rank } as CSSProperties;
  const classes = [
    "trial-frame",
    captioned ? "is-captioned" : "",
    done ? "" : "is-failed",
    props.dimmed ? "is-dimmed" : "",
    props.selected ? "is-selected" : "",
    props.pinned ? "is-pinned" : "",
    props.hovered ? "is-hovered" : "",
    props.best ? "is-best" : "",
  ];
  const height = Math.round(size * 0.86);
  return (
    <button
      ref={frame}
      type="button"
      className={classes.filter(Boolean).join(" ")}
      data-trial={trial.index}
      tabIndex={props.tabIndex}
      aria-pressed={props.selected}
      style={place}
      onPointerEnter={() => hover(trial.index)}
      onPointerLeave={() => hover(null)}
      onFocus={() => hover(trial.index)}
      onBlur={() => hover(null)}
      onClick={(event) => props.onSelect(trial.index, event.shiftKey)}
      onDoubleClick={() => done && props.onOpen(trial.index)}
    >
      <span className="visually-hidden">{words} </span>
      <span className="trial-picture" style={{ height }}>
        {picture?.url ? (
          <img
            src={picture.url}
            alt=""
            style={sizeIn(height - 2 * PADDING, picture, props.longest)}
            draggable={false}
          />
        ) : (
          <span className="trial-reason">{done ? (picture?.failure ?? "") : reasonOf(trial)}</span>
        )}
      </span>
      <i className="trial-line" style={{ background: props.color }} />
      {captioned && (
        <span className="trial-caption">
          <span className="muted">{trial.index}</span>
          <span>{done ? props.value : trial.status}</span>
          {unloaded && <span className="muted trial-unloaded">unloaded</span>}
        </span>
      )}
    </button>
  );
});

/** Why a trial has no result, shortly. */
export function reasonOf(trial: TrialEvent): string {
  return trial.message || trial.status;
}

// One observer for all frames: pictures are asked for while their frames are seen.
const seen = new Map<Element, (seen: boolean) => void>();
let observer: IntersectionObserver | null = null;

function watch(element: Element, tell: (seen: boolean) => void): () => void {
  observer ??= new IntersectionObserver((entries) => {
    for (const entry of entries) seen.get(entry.target)?.(entry.isIntersecting);
  });
  seen.set(element, tell);
  observer.observe(element);
  return () => {
    seen.delete(element);
    observer?.unobserve(element);
  };
}
