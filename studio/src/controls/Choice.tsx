import { type MouseEvent, type ReactNode, useId } from "react";

export interface Option {
  readonly value: string;
  readonly label: string;
  readonly disabled?: boolean;
}

export interface SelectProps {
  label: string;
  value: string;
  options: readonly (Option | string)[];
  /** Without a visible label the name still reaches screen readers. */
  bare?: boolean;
  disabled?: boolean;
  title?: string;
  onChange(value: string): void;
}

export function Select(props: SelectProps) {
  const id = useId();
  const list = (
    <select
      id={id}
      className="select"
      aria-label={props.label}
      title={props.title}
      value={props.value}
      disabled={props.disabled}
      onChange={(event) => props.onChange(event.target.value)}
    >
      {props.options.map((option) => {
        const { value, label, disabled } =
          typeof option === "string" ? { value: option, label: option, disabled: false } : option;
        return (
          <option key={value} value={value} disabled={disabled}>
            {label}
          </option>
        );
      })}
    </select>
  );
  if (props.bare) return list;
  return (
    <div className="field">
      <label className="field-label" htmlFor={id}>
        {props.label}
      </label>
      <div className="field-value">{list}</div>
    </div>
  );
}

export interface ToggleProps {
  label: string;
  checked: boolean;
  disabled?: boolean;
  title?: string;
  onChange(checked: boolean): void;
}

export function Toggle(props: ToggleProps) {
  return (
    <label className="check" title={props.title}>
      <input
        type="checkbox"
        checked={props.checked}
        disabled={props.disabled}
        onChange={(event) => props.onChange(event.target.checked)}
      />
      {props.label}
    </label>
  );
}

export interface ButtonProps {
  children: ReactNode;
  /** Read by screen readers and shown as a tip; needed for icon buttons. */
  label?: string;
  /** Tip with its effect, where the words on it are short. */
  title?: string;
  kind?: "plain" | "primary" | "quiet" | "danger";
  icon?: boolean;
  pressed?: boolean;
  /** For a button that opens something: true while that is open. */
  expanded?: boolean;
  disabled?: boolean;
  testId?: string;
  onClick(event: MouseEvent): void;
}

export function Button(props: ButtonProps) {
  const kind = props.kind && props.kind !== "plain" ? ` ${props.kind}` : "";
  return (
    <button
      type="button"
      className={`button${kind}${props.icon ? " icon" : ""}`}
      aria-label={props.label}
      aria-pressed={props.pressed}
      aria-expanded={props.expanded}
      title={props.title ?? props.label}
      disabled={props.disabled}
      data-testid={props.testId}
      onClick={props.onClick}
    >
      {props.children}
    </button>
  );
}

/** Content of an empty pane: the missing thing, and the next step. */
export function Empty(props: { title: string; children?: ReactNode }) {
  return (
    <div className="empty">
      <strong>{props.title}</strong>
      {props.children}
    </div>
  );
}

export function Section(props: {
  title: string;
  action?: ReactNode;
  /** Purpose of a section that holds nothing yet, which is then one line. */
  empty?: string | false;
  children?: ReactNode;
}) {
  return (
    <section className={props.empty ? "section is-empty" : "section"}>
      <h3 title={props.empty || undefined}>
        <span>{props.title}</span>
        {props.action}
      </h3>
      {props.children}
    </section>
  );
}

export function Progress(props: { label: string; done: number; total: number }) {
  const share = props.total > 0 ? Math.min(1, props.done / props.total) : 0;
  return (
    <div
      className="progress"
      role="progressbar"
      aria-label={props.label}
      aria-valuemin={0}
      aria-valuemax={props.total}
      aria-valuenow={props.done}
    >
      <i style={{ width: `${share * 100}%` }} />
    </div>
  );
}
