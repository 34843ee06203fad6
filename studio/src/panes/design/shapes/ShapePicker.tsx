// Adds a shape: all kinds in groups, found by name or by arrow keys.
import { type KeyboardEvent, useEffect, useId, useRef, useState } from "react";
import { createPortal } from "react-dom";
import { useAway } from "../../../controls/away";
import { Button } from "../../../controls/Choice";
import { FEATURES } from "../../../protocol";
import { Glyph } from "../fields/Glyph";
import { type Schema, summary } from "../fields/schema";
import { ShapeIcon } from "./ShapeIcon";
import { type Addable, firstFound, foundGroups, isFeature, SHAPE_GROUPS } from "./shapeKinds";
import "./shapePicker.css";

/** Gap between the list and its button, and the edges of the page, pixels. */
const GAP = 4;
const WIDTH = 440;
const LEAST_HEIGHT = 320;

interface Props {
  /** The schema of each kind. */
  variants: Readonly<Record<string, Schema>>;
  onChoose(kind: Addable): void;
}

export function ShapePicker(props: Props) {
  const [open, setOpen] = useState(false);
  const place = useRef<HTMLSpanElement>(null);
  const close = (refocus: boolean) => {
    setOpen(false);
    if (refocus) place.current?.querySelector("button")?.focus();
  };
  return (
    <span ref={place}>
      <Button
        icon
        kind="quiet"
        label="Add a shape"
        testId="add-shape"
        expanded={open}
        onClick={() => setOpen(!open)}
      >
        <Glyph name="plus" />
      </Button>
      {open && place.current && (
        <Kinds
          {...props}
          opener={place.current}
          onClose={close}
          onChoose={(kind) => {
            close(true);
            props.onChoose(kind);
          }}
        />
      )}
    </span>
  );
}

function Kinds(props: Props & { opener: HTMLElement; onClose(refocus: boolean): void }) {
  const box = useRef<HTMLDivElement>(null);
  const list = useRef<HTMLDivElement>(null);
  const id = useId();
  const [search, setSearch] = useState("");
  const [chosen, choose] = useState<Addable>("box");
  useAway(box, true, (by) => props.onClose(by === "escape"), props.opener);
  const about = (kind: Addable) =>
    isFeature(kind) ? FEATURES[kind] : summary(props.variants[kind] ?? {});
  const groups = foundGroups(search, SHAPE_GROUPS, about);
  const kinds = groups.flatMap((group) => group.kinds);
  const active = kinds.includes(chosen) ? chosen : kinds[0];
  const optionOf = (kind: Addable) => `${id}-${kind}`;

  useEffect(() => {
    if (active) document.getElementById(optionOf(active))?.scrollIntoView({ block: "nearest" });
  }, [active]);

  const keyDown = (event: KeyboardEvent) => {
    if (event.key === "Enter" && active) props.onChoose(active);
    else if (event.key === "Tab") props.onClose(true);
    else if (event.key.startsWith("Arrow") && active) {
      const next = neighbor(list.current, optionOf(active), event.key);
      if (next) choose(next.dataset.kind as Addable);
    } else {
      event.stopPropagation(); // the page has other uses for letters
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  return createPortal(
    <div
      ref={box}
      className="shape-picker"
      role="dialog"
      aria-label="Add a shape"
      data-testid="shape-picker"
      style={placeBeside(props.opener.getBoundingClientRect())}
    >
      <input
        className="input"
        // biome-ignore lint/a11y/noAutofocus: the press asked for it
        autoFocus
        role="combobox"
        aria-expanded="true"
        aria-controls={id}
        aria-activedescendant={active ? optionOf(active) : undefined}
        aria-autocomplete="list"
        aria-label="Find a shape"
        placeholder="Find a shape"
        value={search}
        onChange={(event) => {
          const text = event.target.value;
          setSearch(text);
          const found = foundGroups(text, SHAPE_GROUPS, about).flatMap((group) => group.kinds);
          choose(found[firstFound(text, found)] ?? "box");
        }}
        onKeyDown={keyDown}
      />
      <div ref={list} id={id} className="shape-groups" role="listbox" aria-label="Kinds of shapes">
        {groups.map(({ title, kinds: own }) => (
          <div key={title} role="group" aria-label={title} className="shape-group">
            <div className="shape-group-title" aria-hidden="true">
              {title}
            </div>
            <div className="shape-tiles" role="presentation">
              {own.map((kind) => (
                // biome-ignore lint/a11y/useKeyWithClickEvents: the field above takes the keys
                <div
                  key={kind}
                  id={optionOf(kind)}
                  className="shape-tile"
                  role="option"
                  tabIndex={-1}
                  aria-selected={kind === active}
                  data-kind={kind}
                  data-testid={`kind-${kind}`}
                  title={about(kind)}
                  onPointerMove={() => kind !== active && choose(kind)}
                  onPointerDown={(event) => event.preventDefault()} // the field keeps the focus
                  onClick={() => props.onChoose(kind)}
                >
                  <ShapeIcon kind={kind} />
                  <span>{kind}</span>
                </div>
              ))}
            </div>
          </div>
        ))}
      </div>
      <p className="shape-about muted" role="status">
        {active ? about(active) : `No shape is found by “${search}”.`}
      </p>
    </div>,
    document.body,
  );
}

/** The list stands below its button, or above where there is more room, within the page. */
function placeBeside(button: DOMRect) {
  const below = innerHeight - button.bottom - 2 * GAP;
  const above = button.top - 2 * GAP;
  const left = Math.max(GAP, Math.min(button.right - WIDTH, innerWidth - WIDTH - GAP));
  const common = { left, width: WIDTH };
  return below >= LEAST_HEIGHT || below >= above
    ? { ...common, top: button.bottom + GAP, maxHeight: below }
    : { ...common, bottom: innerHeight - button.top + GAP, maxHeight: above };
}

/** The option next to another: in turn to the sides, in the line above or below by where it stands. */
function neighbor(list: HTMLElement | null, from: string, key: string): HTMLElement | null {
  const all = [...(list?.querySelectorAll<HTMLElement>("[role=option]") ?? [])];
  const at = all.findIndex((one) => one.id === from);
  if (key === "ArrowRight") return all[(at + 1) % all.length] ?? null;
  if (key === "ArrowLeft") return all[(at - 1 + all.length) % all.length] ?? null;
  const here = all[at]?.getBoundingClientRect();
  if (!here) return null;
  const sign = key === "ArrowDown" ? 1 : -1;
  const rects = all.map((one) => ({ one, at: one.getBoundingClientRect() }));
  const beyond = rects.filter((one) => sign * (one.at.top - here.top) > 1);
  const next = sign * Math.min(...beyond.map((one) => sign * one.at.top));
  const line = beyond.filter((one) => Math.abs(one.at.top - next) < 1);
  line.sort((a, b) => Math.abs(a.at.left - here.left) - Math.abs(b.at.left - here.left));
  return line[0]?.one ?? null;
}
