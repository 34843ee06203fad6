import { useEffect, useState } from "react";
import { Button } from "../controls/Choice";
import { openSheet, usePage } from "../store/page";
import { send } from "../store/session";
import { useStudio } from "../store/studio";
import { openNow } from "./actions";

/** The name of a file, with the ending that design files have, once. */
function fileName(typed: string): string {
  const name = typed.trim();
  return /\.toml$/i.test(name) ? name : `${name}.toml`;
}

/** Asks for a name to save under; a file that is there already is named before it is replaced. */
export function SaveSheet() {
  const document = useStudio((state) => state.document);
  const taken = useStudio((state) => state.fileExists);
  const saved = useStudio((state) => state.saved);
  const then = usePage((page) => page.pending);
  const [name, setName] = useState(document?.path ? lastOf(document.path) : (document?.name ?? ""));
  const [before] = useState(saved);
  useEffect(() => {
    useStudio.setState({ fileExists: null });
  }, []);
  useEffect(() => {
    if (saved === before) return;
    openSheet(null);
    if (then) openNow(then);
  }, [saved, before, then]);
  if (!document) return null;
  const replaces = taken !== null && lastOf(taken) === lastOf(fileName(name));
  const save = () => {
    if (name.trim()) send({ t: "save", path: fileName(name), overwrite: replaces });
  };
  return (
    <form
      className="save-sheet"
      onSubmit={(event) => {
        event.preventDefault();
        save();
      }}
    >
      <h2>Save the design as</h2>
      <label className="field-label" htmlFor="save-name">
        File
      </label>
      <input
        id="save-name"
        className="input"
        // biome-ignore lint/a11y/noAutofocus: the sheet was asked for, to type into it
        autoFocus
        value={name}
        spellCheck={false}
        onFocus={(event) => event.target.setSelectionRange(0, name.replace(/\.toml$/i, "").length)}
        onChange={(event) => setName(event.target.value)}
      />
      <p className="muted" data-testid="save-folder">
        in {document.folder}
      </p>
      {replaces && (
        <p className="warn" role="alert" data-testid="save-replaces">
          {taken} is there already. To save here replaces what it holds.
        </p>
      )}
      <div className="sheet-buttons">
        <span className="sheet-push">
          <Button kind="quiet" testId="save-versions" onClick={() => openSheet("versions")}>
            Versions…
          </Button>
        </span>
        <Button kind="quiet" onClick={() => openSheet(null)}>
          Cancel
        </Button>
        <Button kind={replaces ? "danger" : "primary"} testId="save-now" onClick={save}>
          {replaces ? "Replace" : "Save"}
        </Button>
      </div>
    </form>
  );
}

/** Asks before another design takes the place of one with changes that were not saved. */
export function DiscardSheet() {
  const document = useStudio((state) => state.document);
  const pending = usePage((page) => page.pending);
  if (!document || !pending) return null;
  return (
    <div className="save-sheet" role="alert">
      <h2>{document.name} has changes that were not saved</h2>
      <p className="muted">
        {document.path
          ? "Undo offers the way back to them as long as the studio runs."
          : "Recent, on the start screen, keeps them."}
      </p>
      <div className="sheet-buttons">
        <Button kind="quiet" onClick={() => openSheet(null)}>
          Cancel
        </Button>
        <Button
          testId="discard"
          onClick={() => {
            openSheet(null);
            openNow(pending);
          }}
        >
          Open without saving
        </Button>
        <Button kind="primary" testId="save-first" onClick={() => openSheet("save", pending)}>
          Save first…
        </Button>
      </div>
    </div>
  );
}

function lastOf(path: string): string {
  return path.split(/[\\/]/).at(-1) ?? path;
}
