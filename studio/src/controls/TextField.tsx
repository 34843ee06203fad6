import { type ReactNode, useId, useState } from "react";
import { keysToPicture } from "./keys";

export interface TextFieldProps {
  label: string;
  value: string;
  title?: string | undefined;
  problem?: string | undefined;
  /** Shown in gray behind the value, such as the result of a formula. */
  aside?: string | undefined;
  /** Shown in gray while the field is empty. */
  placeholder?: string;
  /** Names to offer while typing. */
  offers?: readonly string[];
  changed?: boolean;
  /** Numbers stand at the right, names and sentences at the left. */
  right?: boolean;
  disabled?: boolean;
  /** The input alone; its owner shows the text of `onRefusal`. */
  bare?: boolean;
  onRefusal?: ((problem: string | null) => void) | undefined;
  /** Gives the problem of the text, or null after taking it. */
  onCommit(text: string): string | null;
  onDefault?: (() => void) | undefined;
  /** Up and down arrows. */
  onNudge?: ((count: number) => void) | undefined;
  /** Button within the field for the value, shown while the pointer or the keyboard is there. */
  tool?: ReactNode;
}

/** A field that takes its text with Enter or on leaving it; Escape gives the old one back. */
export function TextField(props: TextFieldProps) {
  const id = useId();
  const [draft, setDraft] = useState<string | null>(null);
  const [refusal, refuse] = useState<string | null>(null);
  const setRefusal = (next: string | null) => {
    refuse(next);
    if (next !== refusal) props.onRefusal?.(next);
  };
  const note = refusal ?? props.problem;

  /** Take the text; true unless it is refused. */
  const commit = (): boolean => {
    if (draft === null) return true;
    if (draft.trim() === props.value.trim()) {
      setDraft(null);
      setRefusal(null);
      return true;
    }
    const wrong = props.onCommit(draft);
    setRefusal(wrong);
    if (wrong === null) setDraft(null);
    return wrong === null;
  };

  const input = (
    <span className="number">
      <input
        id={id}
        className={`input${props.right ? "" : " words"}`}
        aria-label={props.label}
        aria-invalid={note ? true : undefined}
        autoComplete="off"
        spellCheck={false}
        disabled={props.disabled}
        placeholder={props.placeholder}
        list={props.offers ? `${id}-offers` : undefined}
        title={note ?? props.title}
        value={draft ?? props.value}
        onChange={(event) => setDraft(event.target.value)}
        onBlur={commit}
        onKeyDown={(event) => {
          if (event.key === "Enter") {
            if (commit()) keysToPicture(event.currentTarget);
          } else if (event.key === "Escape") {
            setDraft(null);
            setRefusal(null);
          } else if (props.onNudge && draft === null && event.key === "ArrowUp") {
            props.onNudge(event.shiftKey ? 10 : 1);
          } else if (props.onNudge && draft === null && event.key === "ArrowDown") {
            props.onNudge(event.shiftKey ? -10 : -1);
          } else return;
          event.preventDefault();
          event.stopPropagation();
        }}
      />
      {props.offers && (
        <datalist id={`${id}-offers`}>
          {props.offers.map((offer) => (
            <option key={offer} value={offer} />
          ))}
        </datalist>
      )}
      {props.tool}
    </span>
  );
  if (props.bare) return input;
  return (
    <div className="field" title={props.title}>
      <label
        className={`field-label${props.changed ? " changed" : ""}`}
        htmlFor={id}
        onDoubleClick={props.onDefault}
      >
        {props.label}
      </label>
      <div className="field-value">
        {input}
        {props.aside && <span className="aside">{props.aside}</span>}
      </div>
      {note && <span className="field-note">{note}</span>}
    </div>
  );
}
