// Check that the mesh is fine enough for the numbers of the result, and the cost of finer voxels.
import { type ReactNode, useEffect, useState } from "react";
import { Button, Select } from "../controls/Choice";
import { formatNumber, formatQuantity, formatSpan } from "../controls/units";
import { edit, editAll } from "../panes/design/edits";
import type { EquilibriumEvent, FinenessEvent } from "../protocol";
import { currentEngine, send } from "../store/session";
import { toast, useStudio } from "../store/studio";
import { inWords, rated, verdict } from "./fineness";
import "./fineness.css";

export function FinenessCheck(props: { of: EquilibriumEvent }) {
  const [open, setOpen] = useState(false);
  if (currentEngine()?.kind !== "server") return null;
  return (
    <div className="fineness">
      <button
        type="button"
        className="button"
        aria-expanded={open}
        data-testid="fineness-open"
        onClick={() => setOpen(!open)}
      >
        Is the mesh fine enough?
      </button>
      {open && <Answer of={props.of} />}
    </div>
  );
}

function Answer({ of: found }: { of: EquilibriumEvent }) {
  const cost = useCost(found);
  const rating = rated(found);
  const answer = verdict(rating);
  const groups: [string, string][] = [
    ["Within 2 %", inWords(rating.small)],
    ["Within 5 %", inWords(rating.fair)],
    ["Beyond 5 %", inWords(rating.beyond)],
  ];
  return (
    <div data-testid="fineness">
      {answer ? (
        <>
          <p className={`fineness-verdict ${answer.tone}`} role="status">
            {answer.words}
          </p>
          <dl className="fineness-groups">
            {groups
              .filter(([, words]) => words !== "")
              .map(([title, words]) => (
                <div key={title}>
                  <dt>{title}</dt>
                  <dd>{words}</dd>
                </div>
              ))}
            <div>
              <dt>No error bar</dt>
              <dd className="muted">{rating.unknown.join(", ")}</dd>
            </div>
          </dl>
        </>
      ) : (
        <Missing of={found} cost={cost} />
      )}
      {cost && <Finer cost={cost} />}
    </div>
  );
}

/** Cost of voxels half as large; asked for anew with each body and each solution. */
function useCost(found: EquilibriumEvent): FinenessEvent | null {
  const { topology, frame } = found;
  const cost = useStudio((state) => state.fineness);
  // While a changed design waits for its body there is nothing to be said of it.
  const same = useStudio(({ document, body }) => document?.rev === body?.rev);
  useEffect(() => {
    if (same) send({ t: "fineness" });
  }, [topology, frame, same]);
  return cost?.topology === topology ? cost : null;
}

function Missing(props: { of: EquilibriumEvent; cost: FinenessEvent | null }) {
  const { of: found, cost } = props;
  if (found.looking) return <p role="status">The error bars are being computed on other voxels.</p>;
  return (
    <>
      <p role="status">
        Not known. {found.error_bars || "The design's solver says that no error is looked for."}
      </p>
      {found.askable && (
        <Button testId="fineness-estimate" onClick={() => send({ t: "estimate" })}>
          Find the errors on finer voxels{duration(cost)}
        </Button>
      )}
    </>
  );
}

function duration(cost: FinenessEvent | null): string {
  return cost?.half_seconds == null ? "" : `, about ${formatSpan(cost.half_seconds)}`;
}

function Finer({ cost }: { cost: FinenessEvent }) {
  const rows: [string, ReactNode, ReactNode][] = [
    ["Edge", formatQuantity(cost.voxel_size, "m", 3), formatQuantity(cost.voxel_size / 2, "m", 3)],
    ["Voxels", cost.voxels.toLocaleString("en"), `about ${cost.half_voxels.toLocaleString("en")}`],
    ["Memory", megabytes(cost.memory), `about ${megabytes(cost.half_memory)}`],
    ["Time of Solve", time(cost.seconds, ""), time(cost.half_seconds, "about ")],
  ];
  const tooMuch = cost.half_memory > cost.free_memory;
  return (
    <>
      <table className="fineness-cost">
        <thead>
          <tr>
            <th scope="col">
              <span className="visually-hidden">What it costs</span>
            </th>
            <th scope="col">now</th>
            <th scope="col">half the edge</th>
          </tr>
        </thead>
        <tbody>
          {rows.map(([name, now, half]) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              <td>{now}</td>
              <td>{half}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {tooMuch && <p className="bad">Only {megabytes(cost.free_memory)} of memory are free.</p>}
      <div className="run-buttons">
        <Button
          testId="halve"
          disabled={cost.halving.length === 0}
          title={cost.not_halved || "One change of the design, which Ctrl+Z takes back"}
          onClick={() => halve(cost)}
        >
          Halve the voxels
        </Button>
        {cost.refining.length > 0 && (
          <Button
            testId="refine-worst"
            title="Half the edge for the voxels that hold 90 % of the estimated error; Ctrl+Z takes it back"
            onClick={() => {
              editAll(cost.refining);
              tell("The voxels with most of the error are half as large");
            }}
          >
            Refine where the error is
          </Button>
        )}
        {cost.refinable.length > 0 && (
          <Select
            bare
            label="Refine a part"
            value=""
            options={[
              { value: "", label: "Refine a part…" },
              ...cost.refinable.map((part) => ({ value: part, label: part })),
            ]}
            onChange={(part) => part && refine(part, cost.refinements)}
          />
        )}
      </div>
      {cost.not_halved && <p className="muted">{cost.not_halved}</p>}
      {cost.not_refined && <p className="muted">{cost.not_refined}</p>}
    </>
  );
}

function halve(cost: FinenessEvent): void {
  editAll(cost.halving);
  const edge = formatQuantity(cost.voxel_size / 2, "m", 3);
  tell(`Voxels of ${edge}`);
}

function refine(part: string, count: number): void {
  edit(["refine", count], { part });
  tell(`The voxels of ${part} are half as large`);
}

function tell(what: string): void {
  const hint = "Press Solve for the new equilibrium; Ctrl+Z takes it back.";
  toast({ level: "good", what, hint, about: "fineness" });
}

function megabytes(bytes: number): string {
  return bytes >= 1e9 ? `${formatNumber(bytes / 1e9, 2)} GB` : `${formatNumber(bytes / 1e6, 2)} MB`;
}

function time(seconds: number | null, about: string): string {
  return seconds === null ? "not known" : `${about}${formatSpan(seconds)}`;
}
