// A choice among things to add at a place: it goes back to its first line once one is chosen.
import type { Option } from "../../controls/Choice";

export function HereSelect(props: {
  label: string;
  title: string;
  first: string;
  testId: string;
  options: readonly Option[];
  onChoose(value: string): void;
}) {
  return (
    <select
      className="select"
      aria-label={props.label}
      title={props.title}
      data-testid={props.testId}
      value=""
      onKeyDown={(event) => {
        // An arrow key opens the list, where it would take the first line at once.
        if (event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
        event.preventDefault();
        event.currentTarget.showPicker();
      }}
      onChange={(event) => props.onChoose(event.target.value)}
    >
      <option value="">{props.first}</option>
      {props.options.map(({ value, label, disabled }) => (
        <option key={value} value={value} disabled={disabled}>
          {label}
        </option>
      ))}
    </select>
  );
}
