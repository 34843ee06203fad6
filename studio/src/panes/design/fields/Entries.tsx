// Sections of a design that hold several things: parts, loads, clamps, probes, materials, layers.
import { type DragEvent, type ReactNode, useEffect, useRef, useState } from "react";
import { Button, Section } from "../../../controls/Choice";
import { describeValue } from "../../../controls/kinds";
import { TextField } from "../../../controls/TextField";
import { send } from "../../../store/session";
import { useStudio } from "../../../store/studio";
import { setView, useView } from "../../../store/view";
import { takeDropped } from "../../materials/give";
import { DRAGGED } from "../../materials/use";
import { edit, type Named, problemOfName, problemsAt, rename, swap } from "../edits";
import { useForm } from "../form";
import { remove } from "../removing/remove";
import { Glyph } from "./Glyph";
import type { MenuPlace } from "./Menu";
import { TableFields } from "./SchemaField";
import { controlOf, resolve, type Schema, single, summary } from "./schema";
import { freeName, starter } from "./starters";

export type Table = Readonly<Record<string, unknown>>;

interface EntryProps {
  title: string;
  about?: string | undefined;
  wrong: boolean;
  testId?: string;
  depth?: number;
  /** True if the picture marks it. */
  chosen?: boolean;
  /** True if it is open at first. */
  begun?: boolean;
  /** True if it is open, where another place decides that too. */
  open?: { readonly is: boolean; set(open: boolean): void };
  /** Target of a drop: the kind of data, and the function that takes it. */
  drop?: { readonly kind: string; take(data: string): void };
  /** Dragging of it onto others, and of others onto it. */
  drag?: HeadDrag;
  actions: readonly {
    readonly glyph: "up" | "down" | "trash" | "more";
    label: string;
    run(at: MenuPlace): void;
  }[];
  children: ReactNode;
}

/** Handlers of the line of an entry when it is dragged, or something is dragged over it. */
export interface HeadDrag {
  /** True if the dragged entry can be dropped here now. */
  readonly takes: boolean;
  begin(): void;
  end(): void;
  drop(at: MenuPlace): void;
}

function dragged(drag: HeadDrag | undefined, over: boolean, setOver: (over: boolean) => void) {
  if (!drag) return {};
  return {
    draggable: true,
    onDragStart: (event: DragEvent) => {
      event.dataTransfer.effectAllowed = "move";
      event.dataTransfer.setData("text/plain", "");
      drag.begin();
    },
    onDragEnd: () => drag.end(),
    onDragOver: (event: DragEvent) => {
      if (!drag.takes) return;
      event.preventDefault(); // it may be dropped here
      if (!over) setOver(true);
    },
    onDragLeave: (event: DragEvent) => {
      if (!event.currentTarget.contains(event.relatedTarget as Node | null)) setOver(false);
    },
    onDrop: (event: DragEvent) => {
      event.preventDefault();
      setOver(false);
      drag.drop({ x: event.clientX, y: event.clientY });
    },
  };
}

/** A line that opens to the fields behind it. */
export function Entry(props: EntryProps) {
  const own = useState(props.begun ?? false);
  const [open, setOpen] = props.open ? [props.open.is, props.open.set] : own;
  const [over, setOver] = useState(false);
  const { drop } = props;
  const box = useRef<HTMLDivElement>(null);
  // It may have been added, or chosen in the picture.
  useEffect(() => {
    if (props.chosen) box.current?.scrollIntoView({ block: "nearest" });
  }, [props.chosen]);
  const marks = [open && "is-open", props.chosen && "is-chosen", drop && over && "takes-drop"];
  return (
    <div
      ref={box}
      className={["entry", ...marks].filter(Boolean).join(" ")}
      data-testid={props.testId}
      {...(drop && dropping(drop, setOver))}
      style={{ marginLeft: (props.depth ?? 0) * 14 }}
    >
      <div
        className={`entry-head${props.drag && over ? " is-over" : ""}`}
        {...dragged(props.drag, over, setOver)}
      >
        <button
          type="button"
          aria-expanded={open}
          aria-current={props.chosen || undefined}
          onClick={() => setOpen(!open)}
        >
          <i className="chevron">
            <Glyph name="open" />
          </i>
          <span className="entry-title">{props.title}</span>
          {props.wrong && (
            <b className="bad" role="img" aria-label="has an error">
              !
            </b>
          )}
          <span className="muted entry-about">{props.about}</span>
        </button>
        <span className="entry-actions">
          {props.actions.map((action) => (
            <Button
              key={action.label}
              icon
              kind="quiet"
              label={action.label}
              onClick={(event) => action.run({ x: event.clientX, y: event.clientY })}
            >
              <Glyph name={action.glyph} />
            </Button>
          ))}
        </span>
      </div>
      {open && <div className="entry-body">{props.children}</div>}
    </div>
  );
}

/** Handlers of an entry on which something can be dropped. */
function dropping(drop: NonNullable<EntryProps["drop"]>, setOver: (over: boolean) => void) {
  return {
    onDragOver: (event: DragEvent) => {
      if (!event.dataTransfer.types.includes(drop.kind)) return;
      event.preventDefault();
      setOver(true);
    },
    onDragLeave: () => setOver(false),
    onDrop: (event: DragEvent) => {
      setOver(false);
      const data = event.dataTransfer.getData(drop.kind);
      if (data) drop.take(data);
    },
  };
}

/** A choice of variants that adds one; a plain button where there is one kind only. */
export function Adder(props: {
  what: string;
  schema: Schema;
  /** Why none can be added. */
  obstacle?: string | null;
  onAdd(value: unknown): void;
}) {
  const { root, names } = useForm();
  const control = controlOf(root, props.schema);
  if (control.is !== "variant") {
    return (
      <Button
        icon
        kind="quiet"
        label={`Add ${props.what}`}
        {...(props.obstacle && { title: props.obstacle, disabled: true })}
        onClick={() => props.onAdd(starter(root, props.schema, names))}
      >
        <Glyph name="plus" />
      </Button>
    );
  }
  return (
    <select
      className="select add-kind"
      aria-label={`Add ${props.what}`}
      title={props.obstacle || `Add ${props.what}`}
      disabled={Boolean(props.obstacle)}
      value=""
      onChange={(event) => {
        const kind = event.target.value;
        const variant = control.variants[kind];
        if (!variant) return;
        const table = starter(root, variant, names) as Table;
        props.onAdd({ [control.tag]: kind, ...table });
      }}
    >
      <option value="">+</option>
      {Object.entries(control.variants).map(([kind, variant]) => (
        <option key={kind} value={kind} title={summary(variant)}>
          {kind}
        </option>
      ))}
    </select>
  );
}

/** The short word for an entry of a list, such as `pressure 4 kPa`. */
function aboutEntry(section: string, value: Table): string {
  const region = value.region as Table | undefined;
  const place = region ? describeValue(region) : "";
  switch (section) {
    case "parts":
      return `${describeShort(value.shape)} of ${describeShort(value.material)}`;
    case "loads":
      return `${describeValue(value.value ?? "")} ${place && `at ${place}`}`.trim();
    case "clamps":
      return `${place}${value.axes && value.axes !== "xyz" ? `, along ${value.axes}` : ""}`;
    case "layers":
      return `${describeValue(value.thickness)}, ${describeValue(value.young)}`;
    case "materials":
      return String(value.model ?? "");
    default: {
      const { name: _, ...rest } = value;
      return describeValue(rest);
    }
  }
}

function describeShort(value: unknown): string {
  if (typeof value === "object" && value !== null) {
    const table = value as Table;
    return String(table.kind ?? table.model ?? "");
  }
  return String(value ?? "");
}

function titleOf(section: string, value: Table, index: number): string {
  if (typeof value.name === "string") return value.name;
  if (section === "loads") return String(value.kind ?? "load");
  return `${single(section)} ${index + 1}`;
}

/** Sections without which no robot is solved: they say so where they are empty. */
const NEEDED: ReadonlySet<string> = new Set(["parts", "clamps", "loads"]);

/** A list of tables, such as the loads; the order counts and can be changed. */
export function EntryList(props: {
  section: string;
  title: string;
  what: string;
  empty: string;
  note?: string;
  /** Why none can be added. */
  obstacle?: string | null;
  /** Fits the first value of a new entry to the body. */
  begin?(value: Table): Table;
}) {
  const { root, source, diagnostics } = useForm();
  const { section, begin = (value: Table) => value } = props;
  const schema = root.properties?.[section]?.items;
  if (!schema) return null;
  const values = (source[section] as Table[] | undefined) ?? [];
  const isEmpty = values.length === 0;
  return (
    <Section
      title={props.title}
      empty={isEmpty && !props.obstacle && !NEEDED.has(section) && props.empty}
      action={
        <Adder
          what={props.what}
          schema={schema}
          obstacle={props.obstacle ?? null}
          onAdd={(value) => edit([section, values.length], begin(value as Table))}
        />
      }
    >
      {isEmpty && (props.obstacle || NEEDED.has(section)) && (
        <p className="muted">{[props.empty, props.obstacle].filter(Boolean).join(" ")}</p>
      )}
      {values.length > 1 && props.note && <p className="muted">{props.note}</p>}
      {values.map((value, i) => {
        const title = titleOf(section, value, i);
        const trash = { glyph: "trash", label: `Remove ${title}` } as const;
        return (
          <Entry
            // biome-ignore lint/suspicious/noArrayIndexKey: entries may have no other name
            key={i}
            title={title}
            about={aboutEntry(section, value)}
            wrong={problemsAt(diagnostics, [section, i]).length > 0}
            testId={`${section}-${i}`}
            {...(section === "parts" ? { drop: takesMaterial(i) } : {})}
            actions={[
              ...(i > 0
                ? [
                    {
                      glyph: "up" as const,
                      label: `Move ${title} up`,
                      run: () => swap([section], i, i - 1),
                    },
                  ]
                : []),
              { ...trash, run: () => remove([section, i], title) },
            ]}
          >
            <TableFields path={[section, i]} schema={schema} value={value} />
          </Entry>
        );
      })}
    </Section>
  );
}

/** A part takes a material that is dragged on it from the list of them. */
function takesMaterial(part: number) {
  return { kind: DRAGGED, take: (name: string) => takeDropped(name, part) };
}

/** A body or an object in the list of them: the one whose fields are open is marked in the picture. */
export function ThingEntry(props: {
  section: "bodies" | "objects";
  index: number;
  value: Table;
  about: string;
  children: ReactNode;
}) {
  const { diagnostics } = useForm();
  const { section, index } = props;
  const named = typeof props.value.name === "string";
  const name = named ? String(props.value.name) : `${single(section)} ${index + 1}`;
  const valid = useStudio((state) => state.document?.valid ?? false);
  const chosen = useView((view) => view.chosen === name);
  return (
    <Entry
      title={name}
      about={props.about}
      wrong={problemsAt(diagnostics, [section, index]).length > 0}
      testId={`${section}-${index}`}
      chosen={chosen}
      open={{ is: chosen, set: (open) => setView({ chosen: open ? name : null }) }}
      actions={[
        {
          glyph: "trash",
          label: `Remove ${name}`,
          // With the pairs of contact that name it, unless the text is not good as it is.
          run: () => (named && valid ? send({ t: "remove", name }) : edit([section, index], null)),
        },
      ]}
    >
      {props.children}
    </Entry>
  );
}

/** A table of named things, such as the probes; they can be renamed. */
export function EntryMap(props: {
  section: Named;
  title: string;
  what: string;
  empty: string;
  /** Name of the first one, where it is new; it may depend on the added value. */
  first: string | ((value: Table) => string);
  /** Gives the first value of a new entry, where the schema alone gives none. */
  begin?(): Table;
  /** True if a new entry opens, as its value is still to be chosen. */
  opens?: boolean;
  /** Stands before the button that adds one. */
  action?: ReactNode;
  children?: (name: string, value: Table) => ReactNode;
}) {
  const { root, source, diagnostics } = useForm();
  const [added, setAdded] = useState<string | null>(null);
  const { section } = props;
  const map = resolve(root, root.properties?.[section] ?? {}).additionalProperties;
  if (typeof map !== "object") return null;
  const values = (source[section] as Record<string, Table> | undefined) ?? {};
  return (
    <Section
      title={props.title}
      empty={Object.keys(values).length === 0 && props.empty}
      action={
        <span className="row">
          {props.action}
          <Adder
            what={props.what}
            schema={map}
            onAdd={(value) => {
              const requested =
                typeof props.first === "string" ? props.first : props.first(value as Table);
              const name = freeName(requested, Object.keys(values));
              if (props.opens) setAdded(name);
              edit([section, name], props.begin?.() ?? value);
            }}
          />
        </span>
      }
    >
      {Object.entries(values).map(([name, value]) => (
        <Entry
          key={name}
          title={name}
          about={aboutEntry(section, value)}
          wrong={problemsAt(diagnostics, [section, name]).length > 0}
          testId={`${section}-${name}`}
          begun={name === added}
          actions={[
            { glyph: "trash", label: `Remove ${name}`, run: () => remove([section, name], name) },
          ]}
        >
          <NameField section={section} name={name} taken={Object.keys(values)} />
          {props.children?.(name, value) ?? (
            <TableFields path={[section, name]} schema={map} value={value} />
          )}
        </Entry>
      ))}
    </Section>
  );
}

export function NameField(props: {
  section: Named;
  name: string;
  taken: readonly string[];
  onRenamed?(name: string): void;
}) {
  return (
    <TextField
      label="Name"
      value={props.name}
      onCommit={(name) => {
        const problem = problemOfName(name, props.section, props.taken);
        if (problem) return problem;
        rename(props.section, props.name, name);
        props.onRenamed?.(name);
        return null;
      }}
    />
  );
}
