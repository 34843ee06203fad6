// All materials that a part can have: their data, and a button that makes a part of one.
import { useDeferredValue, useEffect, useMemo, useState } from "react";
import { Button, Empty, Select } from "../../controls/Choice";
import type { MaterialFacts } from "../../protocol";
import { showPane } from "../../shell/actions";
import { onReady, send } from "../../store/session";
import { toast, useStudio } from "../../store/studio";
import { edit } from "../design/edits";
import type { Form } from "../design/form";
import { useFormOfDocument } from "../design/useForm";
import { useWanted } from "./browse";
import { giveMaterial } from "./give";
import { listed, modelsOf, SORTS, type Sort } from "./list";
import { MaterialItem } from "./MaterialItem";
import { copied, type PartChoice, partsOf } from "./use";
import "./materials.css";

export default function MaterialsPane() {
  const form = useFormOfDocument();
  const known = useMaterials(form);
  const wanted = useWanted((state) => state.part);
  const [search, setSearch] = useState("");
  const [model, setModel] = useState("");
  const [sort, setSort] = useState<Sort>("name");
  const [open, setOpen] = useState<string | null>(null);
  const words = useDeferredValue(search);
  const source = form?.source ?? null;
  const parts = useMemo(() => (source ? partsOf(source) : []), [source]);
  const part = parts.find(({ index }) => index === wanted) ?? parts[0] ?? null;
  const found = useMemo(
    () => listed(known?.materials ?? [], words, model, sort),
    [known, words, model, sort],
  );
  if (!known || !source) {
    return (
      <Empty title="No materials yet">
        <p>They appear when the server has answered and the text can be read.</p>
      </Empty>
    );
  }
  const copy = (one: MaterialFacts) => {
    const cards = known.materials.map(({ name }) => name);
    const { name, change } = copied(one, source, cards);
    edit(change.path, change.value);
    toast({
      level: "good",
      what: `${name} is a material of the design`,
      hint: "Its constants stand under Materials in the form. No part uses it yet.",
      about: "material",
    });
  };
  return (
    <div className="pane materials" data-testid="materials-pane">
      <div className="section materials-bar">
        <input
          className="input"
          type="search"
          aria-label="Search materials"
          placeholder="Search: name, source, Shore"
          value={search}
          onChange={(event) => setSearch(event.target.value)}
        />
        <Select
          bare
          label="Model"
          value={model}
          options={[
            { value: "", label: "All models" },
            ...modelsOf(known.materials).map((one) => ({ value: one, label: one })),
          ]}
          onChange={setModel}
        />
        <Select
          bare
          label="Sort by"
          value={sort}
          options={Object.entries(SORTS).map(([value, label]) => ({ value, label }))}
          onChange={(next) => setSort(next as Sort)}
        />
        <Button
          title="Fit a material to a tensile test (.csv), and make a part of it"
          onClick={() => showPane("coupon", "calibrate")}
        >
          From a tensile test…
        </Button>
        <ForPart parts={parts} part={part} />
        {known.mixed && (
          <p className="materials-mixed" role="status" data-testid="materials-mixed">
            {known.mixed}
          </p>
        )}
      </div>
      {found.length === 0 && (
        <p className="section muted">
          No material has all of that.{" "}
          <Button
            kind="quiet"
            onClick={() => {
              setSearch("");
              setModel("");
            }}
          >
            Show all
          </Button>
        </p>
      )}
      <ul className="material-list">
        {found.map((one) => (
          <MaterialItem
            key={`${one.origin} ${one.name}`}
            of={one}
            part={part}
            parts={parts}
            materials={known.materials}
            open={open === one.name}
            onOpen={(is) => setOpen(is ? one.name : null)}
            onUse={() => part && giveMaterial(one, part.index)}
            onCopy={one.origin === "design" ? undefined : () => copy(one)}
          />
        ))}
      </ul>
    </div>
  );
}

/** Which part the buttons are for. */
function ForPart(props: { parts: readonly PartChoice[]; part: PartChoice | null }) {
  const { parts, part } = props;
  if (part === null) {
    return <p className="muted">The design has no part of its own that a material could be for.</p>;
  }
  if (parts.length === 1) return null;
  return (
    <Select
      label="For part"
      value={String(part.index)}
      options={parts.map(({ index, name }) => ({ value: String(index), label: name }))}
      onChange={(index) => useWanted.setState({ part: Number(index) })}
    />
  );
}

/** The materials; asked for anew where those of the design change. */
function useMaterials(form: Form | null) {
  const materials = useStudio((state) => state.materials);
  const open = useStudio((state) => state.link.state === "open");
  const parts = (form?.design?.parts as readonly { material?: unknown }[] | undefined) ?? [];
  const own = JSON.stringify([form?.design?.materials, parts.map((part) => part.material)]);
  useEffect(() => {
    const ask = () => void send({ t: "materials" });
    if (open) ask();
    return onReady(ask);
  }, [open, own]);
  return materials;
}
