// Goals of a study and its bounds: metrics at probes.
import { Select } from "../../controls/Choice";
import { formatKind, readWritten } from "../../controls/kinds";
import { TextField } from "../../controls/TextField";
import type { Metric } from "../../protocol";
import { useStudio } from "../../store/studio";
import { bodyNames } from "./bodies/several";
import { changesOf, edit, editAll, type Path } from "./edits";
import { FIRST_OBJECTIVE, firstConstraint } from "./fields/begun";
import { CavityField } from "./fields/CavityField";
import { EntryMap, type Table } from "./fields/Entries";
import { inside, labelOf } from "./fields/schema";
import { useForm } from "./form";
import { PromoteTool } from "./parameters/PromoteTool";
import { isNumber, promoted } from "./parameters/promote";

const AXES = [
  { value: "", label: "magnitude" },
  { value: "x", label: "x" },
  { value: "y", label: "y" },
  { value: "z", label: "z" },
];

/** The fields that every metric has: its name, its place, its axis. */
function MetricFields(props: {
  metric: string;
  value: Table;
  onMetric(name: string): void;
  onKey(key: string, value: unknown): void;
}) {
  const metrics = useStudio((state) => state.hello?.metrics);
  const { source, amounts } = useForm();
  const probes = Object.keys((source.probes as object | undefined) ?? {});
  const metric = metrics?.find((one) => one.name === props.metric);
  const probe = String(props.value.probe ?? "");
  const base = String(props.value.base ?? "");
  const object = String(props.value.object ?? "");
  return (
    <>
      <Select
        label="Metric"
        value={props.metric}
        options={withCurrent(
          (metrics ?? []).map((one) => ({ value: one.name, label: labelOf(one.name) })),
          props.metric,
        )}
        onChange={props.onMetric}
      />
      {metric?.needs_probe && (
        <Select
          label="Probe"
          value={probe}
          options={withCurrent(
            probes.map((name) => ({ value: name, label: name })),
            probe,
          )}
          onChange={(next) => props.onKey("probe", next)}
        />
      )}
      {metric?.needs_base && (
        <Select
          label="From"
          value={base}
          options={withCurrent(
            probes.filter((name) => name !== probe).map((name) => ({ value: name, label: name })),
            base,
          )}
          onChange={(next) => props.onKey("base", next)}
        />
      )}
      {metric?.needs_probe && (
        <Select
          label="Along"
          value={String(props.value.axis ?? "")}
          options={AXES}
          onChange={(next) => props.onKey("axis", next || null)}
        />
      )}
      {metric?.needs_object && (
        <Select
          label="Object"
          value={object}
          options={withCurrent(
            objectsOf(source).map((name) => ({ value: name, label: name })),
            object,
          )}
          onChange={(next) => props.onKey("object", next)}
        />
      )}
      {metric?.needs_cavity && (
        <CavityField
          label="Cavity"
          value={props.value.cavity}
          onChange={(next) => props.onKey("cavity", next)}
        />
      )}
      {metric?.takes_percentile && (
        <TextField
          label="Percentile"
          title="What so many percent of the volume stay below, such as 99; empty for the largest value of all."
          value={String(props.value.percentile ?? "")}
          onCommit={(text) => {
            const read = readPercentile(text, amounts);
            if ("problem" in read) return read.problem;
            props.onKey("percentile", read.value);
            return null;
          }}
        />
      )}
    </>
  );
}

/** Things in contact: objects by their names, and bodies. */
function objectsOf(source: Table): string[] {
  const objects = Array.isArray(source.objects) ? source.objects : [];
  return [...objects.map((one) => String((one as Table).name ?? "")), ...bodyNames(source)];
}

/** A percentile as a user types it, or its formula; null for none, which is the largest value. */
export function readPercentile(
  text: string,
  amounts: Parameters<typeof readWritten>[3] = {},
): { readonly value: unknown } | { readonly problem: string } {
  const typed = text.trim().replace(/\s*%$/, "");
  if (typed === "") return { value: null };
  const read = readWritten(typed, "number", [], amounts);
  if ("problem" in read || typeof read.value !== "number") return read;
  const possible = read.value > 0 && read.value <= 100;
  return possible ? read : { problem: "expected a number above 0, at most 100" };
}

function withCurrent(options: { value: string; label: string }[], current: string) {
  return options.some((one) => one.value === current)
    ? options
    : [{ value: current, label: current || "choose…" }, ...options];
}

/** Keys of a goal when its metric changes: a probe where there must be one, and no keys that the
 * metric would refuse. */
export function fittingKeys(
  metric: Metric | undefined,
  value: Table,
  probes: readonly string[],
  objects: readonly string[] = [],
): Record<string, unknown> {
  const { probe: _p, base: _b, axis: _a, cavity: _c, percentile, object, ...kept } = value;
  if (metric?.needs_probe) {
    const probe = value.probe ?? probes[0] ?? "";
    const base = value.base ?? probes.find((name) => name !== probe) ?? "";
    return {
      ...kept,
      probe,
      ...(metric.needs_base ? { base } : {}),
      ...(value.axis ? { axis: value.axis } : {}),
    };
  }
  if (metric?.needs_cavity && value.cavity !== undefined) return { ...kept, cavity: value.cavity };
  if (metric?.needs_object) {
    // In a design without objects the body is meant, which needs no name.
    const named = object ?? objects[0];
    return named === undefined ? kept : { ...kept, object: named };
  }
  return metric?.takes_percentile && percentile !== undefined ? { ...kept, percentile } : kept;
}

const BOUNDS = [
  ["min", "At least"],
  ["max", "At most"],
] as const;

/** A bound of a metric: a number of its kind, a formula, or nothing. */
function Bound(props: { label: string; path: Path; value: unknown; kind: string }) {
  const { source, design, amounts } = useForm();
  const { label, path, value, kind } = props;
  const formula = typeof value === "string" && value.trimStart().startsWith("=");
  const worth = formula ? path.reduce<unknown>(inside, design) : undefined;
  return (
    <TextField
      label={label}
      right
      value={String(value ?? "")}
      aside={typeof worth === "number" ? formatKind(worth, kind) : undefined}
      tool={
        !formula &&
        isNumber(value) && <PromoteTool label={label} changes={promoted(path, value, source)} />
      }
      onCommit={(text) => {
        if (text.trim() === "") {
          edit(path, null);
          return null;
        }
        const read = readWritten(text, kind, [], amounts);
        if ("problem" in read) return read.problem;
        edit(path, read.value);
        return null;
      }}
    />
  );
}

export function Goals() {
  const metrics = useStudio((state) => state.hello?.metrics);
  const { source } = useForm();
  const probes = Object.keys((source.probes as object | undefined) ?? {});
  const objects = (Array.isArray(source.objects) ? source.objects : []).map((one) =>
    String((one as Table).name ?? ""),
  );
  const metricOf = (name: string) => metrics?.find((one) => one.name === name);
  return (
    <>
      <EntryMap
        section="objectives"
        title="Objectives"
        what="an objective"
        first="goal"
        begin={() => FIRST_OBJECTIVE}
        empty="None yet. A study needs one: what to make as large or as small as possible."
      >
        {(name, value) => {
          const direction = "maximize" in value ? "maximize" : "minimize";
          const path = ["objectives", name];
          return (
            <>
              <Select
                label="Goal"
                value={direction}
                options={["maximize", "minimize"]}
                onChange={(next) => {
                  const { maximize, minimize, ...others } = value;
                  const turned = { [next]: maximize ?? minimize ?? "mass", ...others };
                  editAll(changesOf(path, value, turned));
                }}
              />
              <MetricFields
                metric={String(value[direction] ?? "")}
                value={value}
                onMetric={(next) =>
                  editAll(
                    changesOf(path, value, {
                      ...fittingKeys(metricOf(next), value, probes, objects),
                      [direction]: next,
                    }),
                  )
                }
                onKey={(key, next) => edit([...path, key], next)}
              />
            </>
          );
        }}
      </EntryMap>
      <EntryMap
        section="constraints"
        title="Constraints"
        what="a constraint"
        first="limit"
        begin={() => firstConstraint(useStudio.getState().body)}
        opens
        empty="None. A constraint keeps a metric within bounds."
      >
        {(name, value) => {
          const path = ["constraints", name];
          const metric = metricOf(String(value.metric ?? ""));
          return (
            <>
              <MetricFields
                metric={String(value.metric ?? "")}
                value={value}
                onMetric={(next) => {
                  const kept = fittingKeys(metricOf(next), value, probes, objects);
                  // Bounds in the unit of another metric would be wrong.
                  if (metricOf(next)?.kind !== metric?.kind) {
                    delete kept.min;
                    delete kept.max;
                  }
                  editAll(changesOf(path, value, { ...kept, metric: next }));
                }}
                onKey={(key, next) => edit([...path, key], next)}
              />
              {BOUNDS.map(([key, label]) => (
                <Bound
                  key={key}
                  label={label}
                  path={[...path, key]}
                  value={value[key]}
                  kind={metric?.kind ?? "number"}
                />
              ))}
            </>
          );
        }}
      </EntryMap>
    </>
  );
}
