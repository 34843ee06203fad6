// A quantity that a study or a calibration may vary: a switch, and its range with units.
import { Toggle } from "./Choice";
import { formatKind, siUnit } from "./kinds";
import "./range.css";
import { TextField } from "./TextField";
import { parseQuantity } from "./units";

export interface RangeChange {
  readonly on?: boolean;
  readonly low?: number;
  readonly high?: number;
  readonly step?: number | null;
  readonly log?: boolean;
}

export interface RangeRowProps {
  name: string;
  kind: string;
  /** Unit of a bare number. */
  unit: string;
  on: boolean;
  /** Said at the right, such as how many values there are, or the one that stays. */
  note: string;
  title?: string;
  /** SI. */
  low: number;
  high: number;
  /** SI; null for any value in between; left out where there are no steps. */
  step?: number | null;
  /** True if values are spread over powers of ten; left out where that is no question. */
  log?: boolean;
  problem?: string | undefined;
  onChange(change: RangeChange): void;
}

const ANY = "–";
/** Digits that are shown of an end of a range. */
const DIGITS = 8;

export function RangeRow(props: RangeRowProps) {
  const { name, kind, on, problem } = props;
  const taking = (take: (value: number) => RangeChange) => (text: string) => {
    const read = parseQuantity(text, props.unit);
    if ("problem" in read) return read.problem;
    props.onChange(take(read.value));
    return null;
  };
  const takeStep = (text: string) => {
    if (text.trim() !== "" && text.trim() !== ANY) return taking((step) => ({ step }))(text);
    props.onChange({ step: null });
    return null;
  };
  return (
    <div className={`vary${on ? " is-on" : ""}`} data-testid={`vary-${name}`}>
      <Toggle
        label={name}
        {...(props.title ? { title: props.title } : {})}
        checked={on}
        onChange={(next) => props.onChange({ on: next })}
      />
      <span className="vary-note muted">{props.note}</span>
      {on && (
        <div className="vary-range">
          <TextField
            bare
            right
            label={`${name} from`}
            value={formatKind(props.low, kind, DIGITS)}
            problem={problem}
            onCommit={taking((low) => ({ low }))}
          />
          <span className="muted">to</span>
          <TextField
            bare
            right
            label={`${name} to`}
            value={formatKind(props.high, kind, DIGITS)}
            problem={problem}
            onCommit={taking((high) => ({ high }))}
          />
          {props.step !== undefined && (
            <>
              <span className="muted">by</span>
              <TextField
                bare
                right
                label={`${name} step`}
                title="Empty it for any value in between."
                value={props.step === null ? ANY : formatKind(props.step, kind, DIGITS)}
                onCommit={takeStep}
              />
            </>
          )}
        </div>
      )}
      {on && props.log !== undefined && siUnit(kind) !== "1" && (
        <Toggle
          label="in decades"
          title="For moduli and other quantities that span powers of ten."
          checked={props.log}
          onChange={(log) => props.onChange({ log })}
        />
      )}
      {on && problem && <p className="field-note bad">{problem}</p>}
    </div>
  );
}
