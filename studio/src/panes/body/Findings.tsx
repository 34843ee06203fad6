import { useState } from "react";
import type { Finding } from "../../protocol";
import { showPane } from "../../shell/actions";
import { viewport } from "../../view/instance";
import { subjectOf } from "./subject";
import "./body.css";

const SIGNS = { error: "✕", warning: "!", note: "i" } as const;

// A place named in a sentence does not make another sentence of it.
const PLACE = /\bnear \([^)]*\) mm/;

/** Findings that say the same, with all their places. */
function grouped(findings: readonly Finding[]): Finding[][] {
  const groups = new Map<string, Finding[]>();
  for (const finding of findings) {
    const key = subjectOf(finding.where) + finding.what.replace(PLACE, "");
    groups.set(key, [...(groups.get(key) ?? []), finding]);
  }
  return [...groups.values()];
}

/** Findings of a check, the subject first; a click goes to the place where it is. */
export function Findings(props: { findings: readonly Finding[] }) {
  return (
    <div data-testid="findings">
      {grouped(props.findings).map((group) => (
        <Row key={group[0]!.where + group[0]!.what} group={group} />
      ))}
    </div>
  );
}

function Row(props: { group: Finding[] }) {
  const { group } = props;
  const [next, setNext] = useState(0);
  const finding = group[0] as Finding;
  const places = group.filter((one) => one.at !== null);
  const subject = subjectOf(finding.where);
  const content = (
    <>
      <b>{SIGNS[finding.severity]}</b>
      <span>
        {subject && <strong>{subject}: </strong>}
        {finding.what}
        {group.length > 1 && <b> × {group.length}</b>}
        {finding.hint && <span className="muted"> Try: {finding.hint}.</span>}
      </span>
    </>
  );
  if (places.length === 0) return <p className={`finding ${finding.severity}`}>{content}</p>;
  const go = () => {
    const { at, what } = places[next % places.length] as Finding;
    setNext(next + 1);
    showPane("view");
    viewport().showPlace(at as [number, number, number], subject || what);
  };
  return (
    <button
      type="button"
      className={`finding ${finding.severity}`}
      title={places.length > 1 ? "Show the next of these places" : "Show this place"}
      onClick={go}
    >
      {content}
    </button>
  );
}
