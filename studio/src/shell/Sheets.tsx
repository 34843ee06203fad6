// Sheets over the page that go away with Escape: palette, shortcuts, tour, toasts.
import { useEffect, useMemo, useRef, useState } from "react";
import { Button } from "../controls/Choice";
import { RemoveSheet } from "../panes/design/removing/RemoveSheet";
import { openSheet, setMode, usePage } from "../store/page";
import { useView } from "../store/view";
import { SCHEMES, schemeWords } from "../view/hands/schemes";
import { type Action, actions } from "./actions";
import { ImportSheet } from "./ImportSheet";
import { Icon } from "./icons";
import { DiscardSheet, SaveSheet } from "./SaveSheet";
import { Toasts } from "./Toasts";
import { STEPS, tourSeen } from "./tour";
import { VersionsSheet } from "./VersionsSheet";

export function Sheets() {
  const sheet = usePage((page) => page.sheet);
  useEffect(() => {
    if (sheet === null) return;
    const close = (event: KeyboardEvent) => {
      if (event.key !== "Escape") return;
      event.stopPropagation();
      openSheet(null);
    };
    addEventListener("keydown", close, true);
    return () => removeEventListener("keydown", close, true);
  }, [sheet]);
  return (
    <>
      {sheet === "palette" && <Palette />}
      {sheet === "shortcuts" && <Shortcuts />}
      {sheet === "tour" && <Tour />}
      {sheet === "save" && (
        <Scrim label="Save the design as" testId="save-sheet">
          <SaveSheet />
        </Scrim>
      )}
      {sheet === "versions" && (
        <Scrim label="Versions of the document" testId="versions-sheet">
          <VersionsSheet />
        </Scrim>
      )}
      {sheet === "discard" && (
        <Scrim label="Changes that were not saved" testId="discard-sheet">
          <DiscardSheet />
        </Scrim>
      )}
      {sheet === "remove" && (
        <Scrim label="Remove what is in use" testId="remove-sheet">
          <RemoveSheet />
        </Scrim>
      )}
      {sheet === "import" && (
        <Scrim label="Import of a mesh" testId="import-sheet">
          <ImportSheet />
        </Scrim>
      )}
      <Toasts />
    </>
  );
}

function Scrim(props: { children: React.ReactNode; label: string; testId: string }) {
  return (
    <div
      className="scrim"
      role="presentation"
      onPointerDown={(event) => event.target === event.currentTarget && openSheet(null)}
    >
      <div
        className="sheet"
        role="dialog"
        aria-modal="true"
        aria-label={props.label}
        data-testid={props.testId}
      >
        {props.children}
      </div>
    </div>
  );
}

/** Score of words that are all found, above that of any letters in order. */
const WHOLE = 100;

/** Score of `query` in a title: all its letters in order, better where they begin words. */
export function matches(query: string, title: string): number {
  const text = title.toLowerCase();
  let score = 0;
  let at = -1;
  for (const letter of query.toLowerCase().replaceAll(" ", "")) {
    const next = text.indexOf(letter, at + 1);
    if (next < 0) return 0;
    score += next === at + 1 ? 3 : next === 0 || text[next - 1] === " " ? 2 : 1;
    at = next;
  }
  return score + 1 / (1 + text.length);
}

/** Score of an action: by its title, or by a word for it that begins so. */
export function scoreOf(
  query: string,
  { title, words = "" }: Pick<Action, "title" | "words">,
): number {
  const asked = query.trim().toLowerCase();
  const known = `${title}, ${words}`.toLowerCase().split(/[^a-z0-9]+/);
  const whole = asked.split(/\s+/).every((word) => known.some((one) => one.startsWith(word)));
  return matches(query, title) + (whole ? WHOLE : 0);
}

function Palette() {
  const [query, setQuery] = useState("");
  const [chosen, setChosen] = useState(0);
  const list = useRef<HTMLUListElement>(null);
  const found = useMemo(() => {
    const all = actions();
    if (!query.trim()) return all;
    return all
      .map((action) => ({ action, score: scoreOf(query, action) }))
      .filter((one) => one.score > 0)
      .sort((a, b) => b.score - a.score)
      .map((one) => one.action);
  }, [query]);
  const start = (action: Action | undefined) => {
    if (!action) return;
    openSheet(null);
    action.run();
  };
  useEffect(() => {
    list.current?.children[chosen]?.scrollIntoView({ block: "nearest" });
  }, [chosen]);
  return (
    <Scrim label="Find an action" testId="palette">
      <input
        className="palette-input"
        aria-label="Find an action"
        placeholder="What would you like to do?"
        // biome-ignore lint/a11y/noAutofocus: the palette was asked for, to type into it
        autoFocus
        value={query}
        onChange={(event) => {
          setQuery(event.target.value);
          setChosen(0);
        }}
        onKeyDown={(event) => {
          if (event.key === "ArrowDown") setChosen((i) => Math.min(found.length - 1, i + 1));
          else if (event.key === "ArrowUp") setChosen((i) => Math.max(0, i - 1));
          else if (event.key === "Enter") start(found[chosen]);
          else return;
          event.preventDefault();
        }}
      />
      <ul className="palette-list" ref={list} role="listbox" aria-label="Actions">
        {found.map((action, i) => (
          <li
            key={action.id}
            role="option"
            aria-selected={i === chosen}
            tabIndex={-1}
            onPointerMove={() => setChosen(i)}
            onClick={() => start(action)}
            onKeyDown={(event) => event.key === "Enter" && start(action)}
          >
            <span>{action.title}</span>
            <span className="muted">{action.group}</span>
            <Keys keys={action.keys} />
          </li>
        ))}
        {found.length === 0 && <li className="muted">Nothing is called that.</li>}
      </ul>
    </Scrim>
  );
}

const KEY_TEXT: Readonly<Record<string, string>> = {
  " ": "Space",
  ArrowRight: "→",
  ArrowLeft: "←",
  ArrowUp: "↑",
  ArrowDown: "↓",
};

function Keys(props: { keys?: readonly string[] | undefined }) {
  const first = props.keys?.[0];
  if (!first) return <span />;
  const parts = first === " " ? [" "] : first.split("+");
  return (
    <span className="keys">
      {parts.map((part) => (
        <kbd key={part}>{KEY_TEXT[part] ?? (part.length === 1 ? part.toUpperCase() : part)}</kbd>
      ))}
    </span>
  );
}

const BY_MOUSE: readonly [string, string][] = [
  ["Zoom to the pointer", "wheel"],
  ["Turn about a point", "double-click the body"],
  ["Pull the body", "drag on the body while time runs"],
  ["Nearer or farther while pulling", "wheel"],
  ["Leave the spring pinned", "hold Shift, let the button go"],
  ["Ask for values", "click the body"],
];

function Shortcuts() {
  const all = actions().filter((action) => action.keys);
  const scheme = useView((view) => view.scheme);
  const named = SCHEMES.find((one) => one.value === scheme)?.label;
  const groups = [...new Set(all.map((action) => action.group))];
  return (
    <Scrim label="Keyboard shortcuts" testId="shortcuts">
      <div className="sheet-head">
        <h2>Keyboard and mouse</h2>
        <Button icon kind="quiet" label="Close" onClick={() => openSheet(null)}>
          <Icon name="close" />
        </Button>
      </div>
      <div className="shortcut-columns">
        {groups.map((group) => (
          <section key={group}>
            <h3>{group}</h3>
            {all
              .filter((action) => action.group === group)
              .map((action) => (
                <div key={action.id} className="shortcut">
                  <span>{action.title}</span>
                  <Keys keys={action.keys} />
                </div>
              ))}
          </section>
        ))}
        <section>
          <h3>Mouse as in {named}</h3>
          {[...schemeWords(scheme), ...BY_MOUSE].map(([what, how]) => (
            <div key={what} className="shortcut">
              <span>{what}</span>
              <span className="muted">{how}</span>
            </div>
          ))}
        </section>
      </div>
    </Scrim>
  );
}

function Tour() {
  const [at, setAt] = useState(0);
  const step = STEPS[at];
  useEffect(tourSeen, []);
  useEffect(() => {
    if (step?.mode) setMode(step.mode);
  }, [step]);
  if (!step) return null;
  const last = at === STEPS.length - 1;
  return (
    <aside className="tour" data-testid="tour" aria-label="Tour">
      <p className="muted">
        {at + 1} of {STEPS.length}
      </p>
      <h2>{step.title}</h2>
      <p>{step.text}</p>
      <div className="tour-buttons">
        <Button kind="quiet" onClick={() => openSheet(null)}>
          {last ? "Close" : "Skip the tour"}
        </Button>
        <span>
          {at > 0 && <Button onClick={() => setAt(at - 1)}>Back</Button>}
          <Button
            kind="primary"
            testId="tour-next"
            onClick={() => (last ? openSheet(null) : setAt(at + 1))}
          >
            {last ? "Begin" : "Next"}
          </Button>
        </span>
      </div>
    </aside>
  );
}
