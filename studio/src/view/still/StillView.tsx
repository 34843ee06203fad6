import { type ReactNode, useEffect, useRef } from "react";
import { useView } from "../../store/view";
import type { Mark } from "./marks";
import { type StillScene, StillStage } from "./stage";
import type { StillState } from "./useStill";
import "../view.css";
import "./still.css";

const NO_MARKS: readonly Mark[] = [];

export interface StillCell {
  readonly key: string;
  readonly state: StillState;
  readonly caption: ReactNode;
  /** Text until the body is there. */
  readonly waiting: string;
}

export interface StillViewProps {
  /** Description of the picture, for those who cannot see it. */
  label: string;
  cells: readonly StillCell[];
  over?: boolean;
  field: number;
  marks?: readonly Mark[];
  /** Given the function that fits the bodies into the picture. */
  onReady?(fit: () => void): void;
}

/** Bodies at rest side by side or over each other, turned by one camera. */
export function StillView(props: StillViewProps) {
  const { cells, field, label, onReady } = props;
  const { over = false, marks = NO_MARKS } = props;
  const box = useRef<HTMLDivElement>(null);
  const stage = useRef<StillStage | null>(null);
  const view = useView();
  const names = cells.map((cell) => cell.key).join("\n");

  useEffect(() => {
    const made = new StillStage();
    stage.current = made;
    box.current?.prepend(made.element);
    onReady?.(() => made.fit());
    return () => {
      made.dispose();
      stage.current = null;
    };
  }, [onReady]);
  useEffect(() => {
    stage.current?.forget();
  }, [names]);
  useEffect(() => {
    const bodies = cells.map((cell) => cell.state.still);
    const plain: StillScene["view"] = {
      ...view,
      ghost: false,
      cavities: false,
      section: "off",
      exaggeration: 1,
    };
    stage.current?.set({ bodies, over, field, view: plain, marks });
  });
  useEffect(() => {
    stage.current?.renderer.domElement.setAttribute("aria-label", label);
  }, [label]);

  return (
    <div className={`still${over ? " is-over" : ""}`} ref={box} data-testid="still">
      <div className="still-cells">
        {cells.map((cell) => (
          <section key={cell.key} className="still-cell">
            {cell.caption && <div className="still-caption">{cell.caption}</div>}
            <Told state={cell.state} waiting={cell.waiting} />
          </section>
        ))}
      </div>
    </div>
  );
}

/** Work under way in a cell, or the reason why it stays empty. */
function Told(props: { state: StillState; waiting: string }) {
  const { still, pending, failure, again } = props.state;
  if (failure) {
    return (
      <p className="still-told bad" role="alert">
        {failure}{" "}
        <button type="button" className="button quiet" onClick={again}>
          Try again
        </button>
      </p>
    );
  }
  // A newer edition takes the place of the one that is shown when it is there.
  if (!pending || still) return null;
  return (
    <p className="still-told" role="status">
      {props.waiting}
    </p>
  );
}
