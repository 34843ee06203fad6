// One material in the list: its curve and first numbers, and behind them all that is known of it.
import { Button } from "../../controls/Choice";
import { formatKind } from "../../controls/kinds";
import { Plot } from "../../controls/Plot";
import { formatNumber } from "../../controls/units";
import type { MaterialFacts } from "../../protocol";
import { testedAndBeyond } from "./list";
import { Spark } from "./Spark";
import { DRAGGED, isUsed, mixes, type PartChoice, refusal } from "./use";

const NOT_STATED = "not stated";

const LIVE: Readonly<Record<MaterialFacts["live"], string>> = {
  explicit: "runs live in quick explicit steps (spring lattice)",
  implicit: "needs statics or implicit steps (rubber); live motion is slower",
  none: "does not deform",
};

const ORIGINS: Readonly<Record<MaterialFacts["origin"], string>> = {
  card: "",
  design: "of this design",
  file: "card of your own",
};

export interface MaterialItemProps {
  of: MaterialFacts;
  part: PartChoice | null;
  parts: readonly PartChoice[];
  materials: readonly MaterialFacts[];
  open: boolean;
  onOpen(open: boolean): void;
  onUse(): void;
  onCopy?: (() => void) | undefined;
}

export function MaterialItem(props: MaterialItemProps) {
  const { of: one, part, open } = props;
  const refused = part ? refusal(one, part) : "The design has no part of its own.";
  const used = props.parts.filter((each) => isUsed(one, each));
  const mixed = part && !refused ? mixes(one, part, props.parts, props.materials) : "";
  return (
    <li
      className={`material${open ? " is-open" : ""}`}
      data-testid={`material-${one.name}`}
      draggable
      onDragStart={(event) => {
        event.dataTransfer.setData(DRAGGED, one.name);
        event.dataTransfer.effectAllowed = "copy";
      }}
    >
      <div className="material-head">
        <button
          type="button"
          aria-expanded={open}
          title="What is known of it"
          onClick={() => props.onOpen(!open)}
        >
          <Spark of={one} />
          <span className="material-words">
            <span className="material-name">
              {shortName(one)}
              {used.length > 0 && <span className="badge good">in use</span>}
            </span>
            <span className="muted">
              {one.model}
              {one.shore && `, Shore ${one.shore}`}
              {one.young !== null && `, E ${formatKind(one.young, "modulus", 3)}`}
            </span>
            <span className="muted">{ORIGINS[one.origin] || testedWords(one)}</span>
          </span>
        </button>
        {part && (
          <Button
            label={`Use ${one.name} for ${part.name}`}
            title={refused ?? (mixed || `Make ${part.name} of it`)}
            disabled={refused !== null || isUsed(one, part)}
            onClick={props.onUse}
          >
            Use
          </Button>
        )}
      </div>
      {open && <Details {...props} refused={refused} mixed={mixed} used={used} />}
    </li>
  );
}

function Details(
  props: MaterialItemProps & {
    refused: string | null;
    mixed: string;
    used: readonly PartChoice[];
  },
) {
  const { of: one, part } = props;
  const facts: [string, string][] = [
    ["Model", one.model],
    ["Shore hardness", one.shore || NOT_STATED],
    ["Young's modulus", stated(one.young, "modulus")],
    ["Stress at 100 %", stated(one.stress_at_double, "pressure")],
    ["Tested stretch", testedRange(one)],
    [
      "Strain at break",
      one.elongation_at_break === null
        ? NOT_STATED
        : `${formatNumber(100 * one.elongation_at_break, 3)} %`,
    ],
    ["Density", stated(one.density, "density")],
    ["Live", LIVE[one.live]],
  ];
  if (props.used.length > 0) facts.push(["Used by", props.used.map(({ name }) => name).join(", ")]);
  return (
    <div className="material-body">
      {one.title && <strong>{one.title}</strong>}
      {one.same_as && (
        <p className="muted">
          Stands for {one.same_as}. {one.choice}
        </p>
      )}
      {one.stretches.length > 0 ? <Curve of={one} /> : <p className="muted">{noCurve(one)}</p>}
      <dl className="facts">
        {facts.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd className={value === NOT_STATED ? "muted" : undefined}>{value}</dd>
          </div>
        ))}
      </dl>
      {props.refused && part && <p className="bad">{props.refused}</p>}
      {props.mixed && <p className="materials-mixed">{props.mixed}</p>}
      {one.caution && (
        <p>
          <b>Beware.</b> {one.caution}
        </p>
      )}
      {one.source && <p className="muted">{one.source}</p>}
      {one.license && <p className="muted">{one.license}</p>}
      <div className="material-buttons">
        {part && (
          <Button
            kind="primary"
            disabled={props.refused !== null || isUsed(one, part)}
            onClick={props.onUse}
          >
            Use for {part.name}
          </Button>
        )}
        {props.onCopy && (
          <Button
            title="Write its constants into the design, where they can be changed"
            onClick={props.onCopy}
          >
            Copy into the design
          </Button>
        )}
      </div>
    </div>
  );
}

function Curve(props: { of: MaterialFacts }) {
  const one = props.of;
  const [stretches, stresses, tested] = testedAndBeyond(one);
  const strains = stretches.map((stretch) => 100 * (stretch - 1));
  const kilopascal = stresses.map((stress) => (stress === null ? Number.NaN : stress / 1e3));
  const part = (from: number, to: number) =>
    kilopascal.map((stress, i) => (i >= from && i < to ? stress : Number.NaN));
  const beyond = { label: "not tested", color: "--series-1", dashed: true };
  const series = [{ label: "tested", color: "--series-1" }, beyond];
  const all = kilopascal.length;
  return (
    <div className="material-curve">
      <Plot
        label={`Stress of ${one.name} over strain in uniaxial tension, as its model has it`}
        x={{ label: "strain [%]" }}
        y={{ label: "stress [kPa]" }}
        series={tested > 1 ? series : [beyond]}
        data={
          tested > 1 ? [strains, part(0, tested), part(tested - 1, all)] : [strains, kilopascal]
        }
      />
    </div>
  );
}

function noCurve(one: MaterialFacts): string {
  return one.live === "none"
    ? "It does not deform, so that it has no curve."
    : "Compliances belong to one voxel size: no curve is drawn.";
}

function stated(value: number | null, kind: string): string {
  return value === null ? NOT_STATED : formatKind(value, kind, 3);
}

function testedRange(one: MaterialFacts): string {
  if (one.tested_to === null) return NOT_STATED;
  return `${formatNumber(one.tested_from ?? 1, 3)} to ${formatNumber(one.tested_to, 3)}`;
}

function testedWords(one: MaterialFacts): string {
  if (one.tested_to === null) return "tested stretch not stated";
  return `tested to ${formatNumber(100 * (one.tested_to - 1), 3)} % strain`;
}

function shortName(one: MaterialFacts): string {
  return one.origin === "file" ? (one.name.split("/").at(-1) ?? one.name) : one.name;
}
