import { useMemo } from "react";
import { Button, Empty } from "../../controls/Choice";
import { describeValue } from "../../controls/kinds";
import type { Side } from "../../protocol";
import { useStudio } from "../../store/studio";
import { openHere } from "../design/edits";
import { ComparedBodies } from "./ComparedBodies";
import {
  type ComparedRow,
  changeTitle,
  comparedRows,
  otherDifferences,
  sideTitle,
} from "./compared";
import "../study/study.css";
import "./runs.css";

/** The kind of a quantity by its name, from all that the page knows of names. */
function useKinds(): (name: string) => string {
  const metrics = useStudio((state) => state.hello?.metrics);
  const parameters = useStudio((state) => state.document?.parameters);
  const trials = useStudio((state) => state.trials);
  return useMemo(() => {
    const kinds = new Map<string, string>();
    for (const metric of metrics ?? []) kinds.set(metric.name, metric.kind);
    for (const parameter of parameters ?? []) kinds.set(parameter.name, parameter.kind);
    for (const study of Object.values(trials)) {
      for (const [name, kind] of Object.entries(study.kinds)) kinds.set(name, kind);
    }
    return (name) => kinds.get(name) ?? "number";
  }, [metrics, parameters, trials]);
}

/** Two runs or designs side by side: their differences, and their results. */
export default function ComparePane() {
  const compared = useStudio((state) => state.compared);
  const kindOf = useKinds();
  if (!compared) {
    return (
      <Empty title="Nothing to compare yet">
        <p>Check two rows in the list of runs or in the designs of a study, then Compare.</p>
      </Empty>
    );
  }
  const { a, b } = compared;
  const parameters = comparedRows(a.parameters, b.parameters, kindOf, {
    a: a.text,
    b: b.text,
  });
  const metrics = comparedRows(a.metrics, b.metrics, kindOf);
  const others = otherDifferences(compared);
  return (
    <div className="pane compare" data-testid="compare">
      <ComparedBodies compared={compared} />
      <table className="table" aria-label={`${a.name} and ${b.name} side by side`}>
        <thead>
          <tr>
            <td />
            <Head side={a} />
            <Head side={b} />
            <th scope="col" className="muted">
              {changeTitle(a, b)}
            </th>
          </tr>
        </thead>
        <Rows title="Parameters" rows={parameters} />
        <Rows title="Results" rows={metrics} />
        {others.length > 0 && (
          <tbody>
            <tr>
              <th colSpan={4} scope="rowgroup">
                Other differences of the designs
              </th>
            </tr>
            {others.map((one) => (
              <tr key={one.where} className="differs">
                <th scope="row">{one.where}</th>
                <td>{describeValue(one.a)}</td>
                <td>{describeValue(one.b)}</td>
                <td />
              </tr>
            ))}
          </tbody>
        )}
      </table>
      {parameters.every((row) => !row.differs) && others.length === 0 && (
        <p className="section muted">The two designs are the same.</p>
      )}
    </div>
  );
}

function Head(props: { side: Side }) {
  const { side } = props;
  return (
    <th scope="col">
      <div className="compare-head">
        <strong title={side.id}>{sideTitle(side)}</strong>
        <span>
          <span className={`badge ${side.status === "ok" ? "good" : "warn"}`}>
            {side.status || "no result"}
          </span>{" "}
          <Button
            kind="quiet"
            label={`Show ${side.name} in the view`}
            onClick={() => openHere(side.id.includes("/") ? "trial" : "run", side.id)}
          >
            Show
          </Button>
        </span>
      </div>
    </th>
  );
}

function Rows(props: { title: string; rows: readonly ComparedRow[] }) {
  if (props.rows.length === 0) return null;
  return (
    <tbody>
      <tr>
        <th colSpan={4} scope="rowgroup">
          {props.title}
        </th>
      </tr>
      {props.rows.map((row) => (
        <tr key={row.name} className={row.differs ? "differs" : undefined}>
          <th scope="row">{row.name}</th>
          <td>{row.a}</td>
          <td>{row.b}</td>
          <td className="muted">{row.change}</td>
        </tr>
      ))}
    </tbody>
  );
}
