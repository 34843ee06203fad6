// Molds for casting the robot: the way, the printer, and the numbers to pour by.
import { Button, Empty, Section, Select } from "../../controls/Choice";
import { formatKind } from "../../controls/kinds";
import { Table } from "../../controls/Table";
import { TextField } from "../../controls/TextField";
import { formatNumber } from "../../controls/units";
import type { MoldsEvent } from "../../protocol";
import { useStudio } from "../../store/studio";
import type { Schema } from "../design/fields/schema";
import { troubleOf } from "../design/trouble";
import { choose, makeMolds, type PrinterLimits, useMaking } from "./made";
import { FIRST, WAYS } from "./ways";
import "./make.css";

interface Limit {
  readonly key: keyof PrinterLimits;
  readonly label: string;
  readonly title: string;
  readonly kind: string;
}

const LIMITS: readonly Limit[] = [
  {
    key: "wall",
    label: "Thinnest wall",
    title: "Thinnest wall that the printer prints",
    kind: "length",
  },
  {
    key: "volume",
    label: "Room",
    title: "Largest part along x, y, z; larger ones are divided",
    kind: "length",
  },
  { key: "tube", label: "Air tube", title: "Outer diameter of the air tubes", kind: "length" },
  {
    key: "draft",
    label: "Draft",
    title: "Angle by which upright walls lean; silicone needs none",
    kind: "angle",
  },
];

export default function MakePane() {
  const document = useStudio((state) => state.document);
  const usual = useUsual();
  const { options, busy, made, of } = useMaking();
  if (!document) {
    return (
      <Empty title="No design open">
        <p>Open a design: its molds are made here.</p>
      </Empty>
    );
  }
  const trouble = troubleOf(document);
  const bodies = bodyNames(document.source);
  const current = made !== null && of === document.id ? made : null;
  const past = current !== null && current.rev !== document.rev;
  return (
    <div className="pane" data-testid="make-pane">
      <Section title="Molds">
        {bodies.length > 0 && (
          <Select
            label="Body"
            value={options.body}
            options={[
              { value: "", label: "choose…", disabled: true },
              ...bodies.map((name) => ({ value: name, label: name })),
            ]}
            onChange={(body) => choose({ body })}
          />
        )}
        <Select
          label="Way"
          title="How the robot is made"
          value={options.way}
          options={[
            { value: "", label: usual.way },
            ...(usual.way === FIRST ? [] : [{ value: "first", label: FIRST }]),
            ...Object.entries(WAYS).map(([value, label]) => ({ value, label })),
          ]}
          onChange={(way) => choose({ way })}
        />
        {LIMITS.map(({ key: name, label, title }) => (
          <TextField
            key={name}
            label={label}
            title={title}
            right
            placeholder={usual.limits[name]}
            value={options.printer[name]}
            onCommit={(text) => {
              choose({ printer: { ...options.printer, [name]: text.trim() } });
              return null;
            }}
          />
        ))}
        <TextField
          label="Shrinkage"
          placeholder={usual.shrinkage}
          title="Shrinkage of all castings, such as 0.2 %; empty for that of each silicone"
          right
          value={options.shrinkage}
          onCommit={(text) => {
            choose({ shrinkage: text.trim() });
            return null;
          }}
        />
        <div className="row">
          <Button
            kind="primary"
            testId="make-molds"
            disabled={busy || trouble !== null || (bodies.length > 0 && options.body === "")}
            onClick={() => void makeMolds(document.id)}
          >
            {busy ? "Making…" : current ? "Make again" : "Make molds"}
          </Button>
          {trouble && <span className="field-note">{trouble}</span>}
        </div>
      </Section>
      {current && <Made made={current} past={past} />}
    </div>
  );
}

/** Values where a field is empty, in words: those of the design, else those of the schema. */
function useUsual() {
  const hello = useStudio((state) => state.hello);
  const molds = useStudio((state) => state.document?.design?.molds) as Asked | undefined;
  const schema = hello?.design_schema as Schema | undefined;
  const properties = schema?.$defs?.Printer?.properties ?? {};
  const shown = ({ key, kind }: Limit): string => {
    const value: unknown = molds?.printer?.[key] ?? properties[key]?.default;
    const numbers = Array.isArray(value) ? value : [value];
    return numbers.map((one) => formatKind(Number(one), kind)).join(", ");
  };
  const limits = Object.fromEntries(LIMITS.map((limit) => [limit.key, shown(limit)]));
  return {
    limits: limits as Readonly<Record<keyof PrinterLimits, string>>,
    way: molds?.way ? (WAYS[molds.way] ?? molds.way) : FIRST,
    shrinkage: molds?.shrinkage == null ? "of each silicone" : `${molds.shrinkage * 100} %`,
  };
}

/** Options of the design, resolved. */
interface Asked {
  readonly way?: string;
  readonly shrinkage?: number;
  readonly printer?: Readonly<Record<string, unknown>>;
}

function bodyNames(source: unknown): string[] {
  const { bodies } = (source ?? {}) as { bodies?: readonly { name?: unknown }[] };
  return (bodies ?? []).map((one) => String(one.name ?? ""));
}

function Made(props: { made: MoldsEvent; past: boolean }) {
  const { made } = props;
  const a = made.castings.reduce((sum, one) => sum + one.a, 0);
  const b = made.castings.reduce((sum, one) => sum + one.b, 0);
  return (
    <div className={props.past ? "made past" : "made"} data-testid="made">
      {props.past && (
        <p className="warn" role="status">
          These molds are of the design before its last change.
        </p>
      )}
      <Section title={WAYS[made.way] ?? made.way}>
        {made.why && <p className="muted">{made.why}</p>}
        {made.problems.length > 0 && (
          <ul className="mold-problems" data-testid="mold-problems">
            {made.problems.map((one) => (
              <li key={`${one.where} ${one.what}`}>
                <strong>{one.where}</strong> {one.what}
                {one.hint && <span className="muted">. Try: {one.hint}</span>}
              </li>
            ))}
          </ul>
        )}
        {made.url && (
          <div className="row">
            <a
              className="button primary"
              href={made.url}
              download={made.name}
              data-testid="molds-zip"
            >
              Parts (3MF) and sheet
            </a>
            <span className="muted">
              {made.files.length} {made.files.length === 1 ? "part" : "parts"} to print
            </span>
          </div>
        )}
      </Section>
      {made.castings.length > 0 && (
        <Section title="Castings">
          <Table
            label="Castings"
            testId="castings"
            rows={made.castings}
            rowKey={(row) => row.name}
            columns={[
              { key: "name", title: "Casting", cell: (row) => row.name },
              {
                key: "volume",
                title: "Volume, mL",
                right: true,
                cell: (row) => formatNumber(row.volume * 1e6, 4),
              },
              {
                key: "deviation",
                title: "Off, mm",
                right: true,
                cell: (row) => formatNumber(row.deviation * 1e3, 2),
              },
              {
                key: "air",
                title: "Air, mm³",
                right: true,
                cell: (row) => formatNumber(row.trapped_air * 1e9, 2),
              },
            ]}
          />
          <p data-testid="mix">
            Mix <strong>{formatNumber(a * 1e3, 3)} g</strong> of A
            {b > 0 && (
              <>
                {" "}
                and <strong>{formatNumber(b * 1e3, 3)} g</strong> of B
              </>
            )}
            , with 15 % of waste.
          </p>
          {[...new Set(made.castings.map((one) => times(one)))].map((text) => (
            <p key={text} className="muted">
              {text}
            </p>
          ))}
        </Section>
      )}
      {made.notes.length > 0 && (
        <Section title="By hand">
          <ul className="mold-notes">
            {made.notes.map((note) => (
              <li key={note}>{note}</li>
            ))}
          </ul>
        </Section>
      )}
    </div>
  );
}

function times(one: MoldsEvent["castings"][number]): string {
  if (one.pot_life === null || one.cure === null) return `${one.material}: see its bulletin.`;
  const pot = formatNumber(one.pot_life / 60, 3);
  return `${one.material}: pours for ${pot} min, cures in ${formatNumber(one.cure / 3600, 3)} h.`;
}
