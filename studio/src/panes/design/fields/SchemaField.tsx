// One place of a design as a control, chosen by the schema; tables and lists nest.
import { type ReactNode, useState } from "react";
import { Button, Select, Toggle } from "../../../controls/Choice";
import { describeValue, formatKind, readWritten } from "../../../controls/kinds";
import { TextField } from "../../../controls/TextField";
import { formatNumber } from "../../../controls/units";
import { browseMaterials } from "../../materials/browse";
import { edit, type Path, problemsAt, problemText, swap } from "../edits";
import { useForm } from "../form";
import { PromoteTool } from "../parameters/PromoteTool";
import { isNumber, promoted } from "../parameters/promote";
import { CavityField } from "./CavityField";
import { Glyph } from "./Glyph";
import { numberNames, profileAt } from "./pairs";
import {
  type Control,
  controlOf,
  entryLabel,
  helpOfKeys,
  inside,
  labelOf,
  optionFor,
  resolve,
  type Schema,
  summary,
} from "./schema";
import { changeVariant, starter, variantStarter } from "./starters";

export interface SchemaFieldProps {
  path: Path;
  schema: Schema;
  value: unknown;
  label: string;
  help?: string | undefined;
  /** The kind of the table that the place is in. */
  within?: string | undefined;
  /** Offered as a button; missing where the place must be there. */
  onRemove?: (() => void) | undefined;
}

export function SchemaField(props: SchemaFieldProps) {
  const { root } = useForm();
  return <ControlField {...props} control={controlOf(root, props.schema)} />;
}

function ControlField(props: SchemaFieldProps & { control: Control }) {
  const { root, names, materialTitles, diagnostics } = useForm();
  const { control, path, value, label } = props;
  const schema = resolve(root, props.schema);
  const problem = problemText(problemsAt(diagnostics, path));
  switch (control.is) {
    case "quantity":
    case "text":
      return (
        <Removable onRemove={props.onRemove} label={label}>
          <QuantityField {...props} control={control} problem={problem} />
        </Removable>
      );
    case "choice":
      return (
        <Removable onRemove={props.onRemove} label={label}>
          <Select
            label={label}
            title={props.help}
            value={String(value ?? schema.default ?? "")}
            options={control.values}
            onChange={(next) => edit(path, next)}
          />
        </Removable>
      );
    case "switch":
      return (
        <Removable onRemove={props.onRemove} label={label}>
          <div className="field">
            <span className="field-label" />
            <Toggle
              label={label}
              title={props.help ?? ""}
              checked={value === true}
              onChange={(next) => edit(path, next)}
            />
          </div>
        </Removable>
      );
    case "cavity":
      return (
        <Removable onRemove={props.onRemove} label={label}>
          <CavityField
            label={label}
            value={value ?? schema.default}
            help={props.help}
            onChange={(next) => edit(path, next)}
          />
          {problem && <span className="field-note">{problem}</span>}
        </Removable>
      );
    case "tuple":
      return (
        <Removable onRemove={props.onRemove} label={label}>
          <TupleField {...props} items={control.items} problem={problem} />
        </Removable>
      );
    case "list":
      return <ListField {...props} item={control.item} />;
    case "reference": {
      if (typeof value === "object" && value !== null) {
        return (
          <ControlField
            {...props}
            schema={control.inline}
            control={controlOf(root, control.inline)}
          />
        );
      }
      const known = names[control.to];
      const options = known.map((name) => ({ value: name, label: materialTitles[name] ?? name }));
      const current = String(value ?? "");
      const part = control.to === "materials" && path[0] === "parts" ? Number(path[1]) : null;
      return (
        <Removable onRemove={props.onRemove} label={label}>
          <div className={part === null ? "" : "either"}>
            <Select
              label={label}
              title={props.help}
              value={current}
              options={
                known.includes(current)
                  ? options
                  : [{ value: current, label: current || "choose…" }, ...options]
              }
              onChange={(next) => edit(path, next)}
            />
            {part !== null && (
              <Button
                icon
                kind="quiet"
                label={`Browse materials for part ${part + 1}`}
                title="Browse materials, with their curves"
                onClick={() => browseMaterials(part)}
              >
                <Glyph name="curve" />
              </Button>
            )}
          </div>
          {problem && <span className="field-note">{problem}</span>}
        </Removable>
      );
    }
    case "table":
    case "variant":
      // Histories may be called by a name, which the text puts in their place.
      if (typeof value === "string") return <NamedHistory {...props} name={value} />;
      return (
        <Nested label={label} help={props.help} onRemove={props.onRemove}>
          <TableFields path={path} schema={props.schema} value={value} />
        </Nested>
      );
    case "map":
      return (
        <TextField
          label={label}
          value={describeValue(value)}
          title="Change it in the text."
          onCommit={() => "change it in the text"}
        />
      );
    case "either": {
      const at = optionFor(root, control.options, value);
      const chosen = control.options[at] ?? {};
      const other = control.options[(at + 1) % control.options.length] ?? {};
      const isVector = controlOf(root, chosen).is === "tuple";
      return (
        <div className="either">
          <ControlField {...props} schema={chosen} control={controlOf(root, chosen)} />
          <Button
            icon
            kind="quiet"
            label={isVector ? `${label}: one value` : `${label}: a value for each axis`}
            onClick={() => edit(path, starter(root, other, names))}
          >
            <Glyph name="swap" />
          </Button>
        </div>
      );
    }
  }
}

/** The name of a history of the design, in place of one of its own. */
function NamedHistory(props: SchemaFieldProps & { name: string }) {
  const { source, diagnostics } = useForm();
  const { name, path, label } = props;
  const known = Object.keys((source.histories as object | undefined) ?? {});
  const problem = problemText(problemsAt(diagnostics, path));
  return (
    <Removable onRemove={props.onRemove} label={label}>
      <Select
        label={label}
        title={props.help}
        value={name}
        options={known.includes(name) ? known : [name, ...known]}
        onChange={(next) => edit(path, next)}
      />
      {problem && <span className="field-note">{problem}</span>}
    </Removable>
  );
}

function Removable(props: {
  label: string;
  onRemove?: (() => void) | undefined;
  children: ReactNode;
}) {
  if (!props.onRemove) return <>{props.children}</>;
  return (
    <div className="removable">
      <div className="removable-field">{props.children}</div>
      <Button icon kind="quiet" label={`Remove ${props.label}`} onClick={props.onRemove}>
        <Glyph name="minus" />
      </Button>
    </div>
  );
}

function Nested(props: {
  label: string;
  help?: string | undefined;
  onRemove?: (() => void) | undefined;
  children: ReactNode;
}) {
  return (
    <fieldset className="nested" title={props.help}>
      <legend>{props.label}</legend>
      {props.onRemove && (
        <span className="nested-remove">
          <Button icon kind="quiet" label={`Remove ${props.label}`} onClick={props.onRemove}>
            <Glyph name="minus" />
          </Button>
        </span>
      )}
      {props.children}
    </fieldset>
  );
}

interface LeafProps extends SchemaFieldProps {
  problem?: string | undefined;
}

function QuantityField(
  props: LeafProps & {
    control: Extract<Control, { is: "quantity" | "text" }>;
    bare?: boolean;
    onRefusal?: (problem: string | null) => void;
  },
) {
  const { root, source, design, amounts } = useForm();
  const { control, path, value } = props;
  const usual = resolve(root, props.schema).default;
  const kind = control.is === "quantity" ? control.kind : null;
  const text = typeof value === "number" ? formatNumber(value, 12) : String(value ?? "");
  const formula = typeof value === "string" && value.trimStart().startsWith("=");
  const worth = formula ? path.reduce<unknown>(inside, design) : undefined;
  return (
    <TextField
      label={props.label}
      bare={props.bare ?? false}
      onRefusal={props.onRefusal}
      value={text}
      right={kind !== null}
      title={props.help}
      problem={props.problem}
      aside={typeof worth === "number" && kind ? formatKind(worth, kind) : undefined}
      changed={usual !== undefined && usual !== null && value !== undefined && value !== usual}
      onDefault={props.onRemove}
      onNudge={kind === null || formula ? undefined : (count) => nudge(path, value, count)}
      tool={
        kind !== null &&
        !formula &&
        isNumber(value) && (
          <PromoteTool label={props.label} changes={promoted(path, value, source)} />
        )
      }
      onCommit={(typed) => {
        if (control.is === "text") {
          edit(path, typed);
          return null;
        }
        const read = readWritten(typed, control.kind, control.words, amounts);
        if ("problem" in read) return read.problem;
        edit(path, read.value);
        return null;
      }}
    />
  );
}

const NUMBER_AND_UNIT = /^\s*([+-]?[\d.]+(?:e[+-]?\d+)?)\s*(.*)$/i;

/** A step of a tenth of the leading digit, in the unit that is written. */
function nudge(path: Path, value: unknown, count: number): void {
  const match = NUMBER_AND_UNIT.exec(String(value ?? ""));
  if (!match) return;
  const number = Number(match[1]);
  if (!Number.isFinite(number)) return;
  const step = number === 0 ? 1 : 10 ** Math.floor(Math.log10(Math.abs(number) / 5));
  const whole = Number.isInteger(number) && !match[2] ? Math.max(1, step) : step;
  const next = Number((Math.round(number / whole) * whole + count * whole).toPrecision(12));
  edit(path, match[2] ? `${next} ${match[2]}` : next);
}

function TupleField(props: LeafProps & { items: readonly Schema[] }) {
  const { root, source, diagnostics } = useForm();
  const [refusals, setRefusals] = useState<Readonly<Record<number, string | null>>>({});
  const values = Array.isArray(props.value) ? props.value : [];
  const note = Object.values(refusals).find((one) => one) ?? props.problem;
  const axes = numberNames(source, props.path, props.items.length);
  return (
    <div className="field tuple" title={props.help}>
      <span className="field-label">{props.label}</span>
      <div className="field-value">
        {props.items.map((item, i) => {
          const control = controlOf(root, item);
          const path = [...props.path, i];
          const name = `${props.label} ${axes[i] ?? i + 1}`;
          if (control.is !== "quantity" && control.is !== "text") {
            return (
              // biome-ignore lint/suspicious/noArrayIndexKey: a tuple has its order for a name
              <SchemaField key={i} path={path} schema={item} value={values[i]} label={name} />
            );
          }
          return (
            <QuantityField
              // biome-ignore lint/suspicious/noArrayIndexKey: a tuple has its order for a name
              key={i}
              bare
              path={path}
              schema={item}
              value={values[i]}
              label={name}
              control={control}
              problem={problemText(problemsAt(diagnostics, path))}
              onRefusal={(problem) => setRefusals((all) => ({ ...all, [i]: problem }))}
            />
          );
        })}
      </div>
      {note && <span className="field-note">{note}</span>}
    </div>
  );
}

function ListField(props: SchemaFieldProps & { item: Schema }) {
  const { root, names, source } = useForm();
  const values = Array.isArray(props.value) ? props.value : [];
  const profile = profileAt(source, props.path);
  return (
    <Nested label={props.label} help={props.help} onRemove={props.onRemove}>
      {profile && (
        <div className="field tuple profile-head" aria-hidden="true">
          <span />
          <div className="field-value">
            {profile.map((name) => (
              <span key={name}>{name}</span>
            ))}
          </div>
        </div>
      )}
      {values.map((value, i) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: entries have no other name than their place
        <div className="list-entry" key={i}>
          <SchemaField
            path={[...props.path, i]}
            schema={props.item}
            value={value}
            label={entryLabel(props.within, i)}
            onRemove={values.length > 1 ? () => edit([...props.path, i], null) : undefined}
          />
          <Button
            icon
            kind="quiet"
            label={`Move ${props.label} ${i + 1} up`}
            disabled={i === 0}
            onClick={() => swap(props.path, i, i - 1)}
          >
            <Glyph name="up" />
          </Button>
        </div>
      ))}
      <Button
        kind="quiet"
        onClick={() => edit([...props.path, values.length], starter(root, props.item, names))}
      >
        <Glyph name="plus" /> Add
      </Button>
    </Nested>
  );
}

/** The fields of a table that are there or must be, and a list of those that could be added. */
export function TableFields(props: {
  path: Path;
  schema: Schema;
  value: unknown;
  /** Keys that are shown elsewhere. */
  without?: readonly string[];
}) {
  const { root, names } = useForm();
  const control = controlOf(root, props.schema);
  const table = (typeof props.value === "object" && props.value ? props.value : {}) as Record<
    string,
    unknown
  >;
  let schema = control.is === "table" ? control.schema : resolve(root, props.schema);
  let tagField: ReactNode = null;
  let kind: string | undefined;
  if (control.is === "variant") {
    const { tag, variants } = control;
    const chosen = String(table[tag] ?? "");
    kind = chosen;
    schema = variants[chosen] ?? {};
    tagField = (
      <Select
        label={labelOf(tag)}
        value={chosen}
        title={summary(schema)}
        options={[
          ...(chosen in variants ? [] : [{ value: chosen, label: chosen || "choose…" }]),
          ...Object.keys(variants),
        ]}
        onChange={(next) => {
          const variant = variants[next] ?? {};
          const fresh = variantStarter(root, tag, next, variant, names);
          edit(props.path, changeVariant(fresh, variant, table, tag));
        }}
      />
    );
  }
  const help = helpOfKeys(schema);
  const hidden = new Set(props.without ?? []);
  if (control.is === "variant") hidden.add(control.tag);
  const required = new Set(schema.required ?? []);
  const fields = Object.entries(schema.properties ?? {}).filter(([key]) => !hidden.has(key));
  const shown = fields.filter(([key]) => required.has(key) || key in table);
  const missing = fields.filter(([key]) => !required.has(key) && !(key in table));
  return (
    <>
      {tagField}
      {shown.map(([key, inner]) => (
        <SchemaField
          key={key}
          path={[...props.path, key]}
          schema={inner}
          value={table[key]}
          label={labelOf(key)}
          help={help[key]}
          within={kind}
          onRemove={required.has(key) ? undefined : () => edit([...props.path, key], null)}
        />
      ))}
      {missing.length > 0 && (
        <select
          className="select add-field"
          aria-label={`Add to ${props.path.join(" ")}`}
          value=""
          onChange={(event) => {
            const key = event.target.value;
            const inner = schema.properties?.[key];
            if (inner) edit([...props.path, key], starter(root, inner, names));
          }}
        >
          <option value="">Add…</option>
          {missing.map(([key]) => (
            <option key={key} value={key} title={help[key]}>
              {labelOf(key)}
            </option>
          ))}
        </select>
      )}
    </>
  );
}
