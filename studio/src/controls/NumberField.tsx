import {
  type ReactNode,
  type PointerEvent as ReactPointerEvent,
  useEffect,
  useId,
  useRef,
  useState,
} from "react";
import { PLAIN } from "./dimension";
import { type Amounts, writtenFormula } from "./formula";
import { keysToPicture } from "./keys";
import { isOnStep, stepToward } from "./slide";
import { factorOf, formatNumber, parseQuantity, shownUnit, unitText } from "./units";
import { unitOf } from "./unitTable";

export interface NumberFieldProps {
  label: string;
  /** SI value. */
  value: number;
  /** SI unit, such as "m"; the field shows millimeters by itself. */
  unit?: string;
  min?: number | null | undefined;
  max?: number | null | undefined;
  step?: number | null | undefined;
  /** The former value; where it differs, a mark behind the label shows it and gives it back. */
  fallback?: number;
  /** Takes typed text as a formula, where the place may hold one. */
  formulas?: { readonly parameters: Amounts; take(formula: string): void };
  /** Adds a slider where `min` and `max` are known. */
  slider?: boolean;
  /** Puts the label on a line of its own, for long ones. */
  stacked?: boolean;
  disabled?: boolean;
  problem?: string | undefined;
  title?: string;
  /** Button within the field for the value, shown while the pointer or the keyboard is there. */
  tool?: ReactNode;
  /** Called with SI values; `settled` is false while a slider or label is being dragged. */
  onChange(value: number, settled: boolean): void;
}

/** A number with its unit: type "5 mm" or "2*0.5 cm", arrow keys, drag the label, or slide. */
export function NumberField(props: NumberFieldProps) {
  const { label, min, max } = props;
  const { value, change, settle } = useRequested(props.value, props.onChange);
  const id = useId();
  const unit = shownUnit(props.unit ?? "1");
  const factor = factorOf(unit);
  const say = (x: number) =>
    `${formatNumber(x / factor, 6)}${unit === "1" ? "" : ` ${unitText(unit)}`}`;
  const shown = say(value);
  const [draft, setDraft] = useState<string | null>(null);
  const [problem, setProblem] = useState<string | null>(null);
  const drag = useRef<{ x: number; start: number } | null>(null);
  const step = props.step ?? stepFor(value, min, max, factor);

  useEffect(() => {
    if (draft === null) setProblem(null);
  }, [draft]);

  const clamp = (x: number) => Math.min(max ?? Infinity, Math.max(min ?? -Infinity, x));
  const round = (x: number) => Number((Math.round(x / step) * step).toPrecision(12));

  /** Take a text; true unless it is refused. */
  const commit = (text: string): boolean => {
    const due = unitOf(unit)?.dimension ?? PLAIN;
    const written = props.formulas && writtenFormula(text, due, props.formulas.parameters);
    const read = written ?? parseQuantity(text, unit);
    if ("problem" in read) {
      setProblem(read.problem);
      return false;
    }
    setDraft(null);
    setProblem(null);
    if ("formula" in read) props.formulas?.take(read.formula);
    else if (read.value !== value) change(read.value, true);
    return true;
  };

  const nudge = (count: number) => {
    setDraft(null);
    change(clamp(round(value + count * step)), true);
  };

  const scrub = {
    onPointerDown(event: ReactPointerEvent<HTMLElement>) {
      if (props.disabled || event.button !== 0) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      drag.current = { x: event.clientX, start: value };
    },
    onPointerMove(event: ReactPointerEvent<HTMLElement>) {
      if (!drag.current) return;
      const pixels = (event.clientX - drag.current.x) * (event.shiftKey ? 0.1 : 1);
      const next = clamp(round(drag.current.start + Math.round(pixels / 4) * step));
      if (next !== value) change(next, false);
    },
    onPointerUp() {
      drag.current = null;
      settle();
    },
  };

  const former = props.fallback !== undefined && props.fallback !== value ? props.fallback : null;
  const giveBack = () => !props.disabled && former !== null && change(former, true);
  const note = problem ?? props.problem;
  return (
    <div className={props.stacked ? "field stacked" : "field"} title={props.title}>
      <span className="field-head">
        <label
          className="field-label scrub"
          htmlFor={id}
          title={former === null ? props.title : `was ${say(former)}; double-click gives it back`}
          onDoubleClick={giveBack}
          {...scrub}
        >
          {label}
        </label>
        {former !== null && (
          <button
            type="button"
            className="former"
            aria-label={`${label}: back to ${say(former)}`}
            title={`was ${say(former)}; click to give it back`}
            disabled={props.disabled}
            onClick={giveBack}
          />
        )}
      </span>
      <div className="field-value">
        {props.slider && min != null && max != null && max > min && (
          <input
            className="slider"
            type="range"
            aria-label={`${label} slider`}
            min={min / factor}
            max={max / factor}
            // The browser would draw a value between two steps at the next one.
            step={isOnStep(value, min, step) ? step / factor : "any"}
            value={value / factor}
            disabled={props.disabled}
            onChange={(event) => {
              const next = Number((Number(event.target.value) * factor).toPrecision(12));
              change(
                clamp(isOnStep(value, min, step) ? next : stepToward(next, value, min, step)),
                false,
              );
            }}
            onPointerUp={settle}
            onKeyUp={settle}
          />
        )}
        <span className="number">
          <input
            id={id}
            className="input"
            aria-label={label}
            aria-invalid={note ? true : undefined}
            inputMode="decimal"
            autoComplete="off"
            spellCheck={false}
            disabled={props.disabled}
            value={draft ?? shown}
            onChange={(event) => setDraft(event.target.value)}
            onFocus={(event) => event.target.select()}
            onBlur={() => draft !== null && commit(draft)}
            onKeyDown={(event) => {
              if (event.key === "Enter") {
                if (commit(draft ?? shown)) keysToPicture(event.currentTarget);
              } else if (event.key === "Escape") setDraft(null);
              else if (event.key === "ArrowUp") nudge(event.shiftKey ? 10 : 1);
              else if (event.key === "ArrowDown") nudge(event.shiftKey ? -10 : -1);
              else return;
              event.preventDefault();
              event.stopPropagation();
            }}
          />
          {props.tool}
        </span>
      </div>
      {note && <span className="field-note">{note}</span>}
    </div>
  );
}

// Time that an answer may take before the field shows the value of the page instead of the requested one, ms.
const PATIENCE = 800;

/**
 * Value asked for last, until its owner has answered: the answer may take a
 * moment, and a slider that jumps back meanwhile cannot be moved by keys.
 */
function useRequested(told: number, onChange: NumberFieldProps["onChange"]) {
  const [requested, setRequested] = useState<number | null>(null);
  const unsettled = useRef<number | null>(null);
  useEffect(() => {
    if (requested === null) return;
    if (requested === told) {
      setRequested(null);
      return;
    }
    const timer = setTimeout(() => setRequested(null), PATIENCE);
    return () => clearTimeout(timer);
  }, [requested, told]);
  const change = (next: number, settled: boolean) => {
    setRequested(next);
    unsettled.current = settled ? null : next;
    onChange(next, settled);
  };
  const settle = () => {
    const last = unsettled.current;
    unsettled.current = null;
    if (last !== null) onChange(last, true);
  };
  return { value: requested ?? told, change, settle };
}

function stepFor(
  value: number,
  min: number | null | undefined,
  max: number | null | undefined,
  factor: number,
): number {
  if (min != null && max != null && max > min) {
    return 10 ** Math.floor(Math.log10((max - min) / 50));
  }
  const size = Math.abs(value) || factor;
  return 10 ** Math.floor(Math.log10(size / 10));
}
