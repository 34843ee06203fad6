import { useEffect, useState } from "react";
import { Button } from "../controls/Choice";
import type { DifferentLine, VersionRow } from "../protocol";
import { openSheet } from "../store/page";
import { send } from "../store/session";
import { toast, useStudio } from "../store/studio";
import { whenWords } from "../store/when";
import { Icon } from "./icons";

/** Texts of the document as they were saved or left: the changes since, and a way back. */
export function VersionsSheet() {
  const found = useStudio((state) => state.versions);
  const document = useStudio((state) => state.document);
  const [chosen, choose] = useState<string | null>(null);
  useEffect(() => {
    useStudio.setState({ versions: null, versionDifference: null });
    send({ t: "versions" });
  }, []);
  const rows = found?.versions ?? [];
  const id = chosen ?? rows[0]?.id ?? null;
  useEffect(() => {
    if (id !== null) send({ t: "version_show", id });
  }, [id]);
  return (
    <div className="versions">
      <div className="sheet-head">
        <h2>Versions of {found?.name ?? document?.name ?? "the document"}</h2>
        <Button icon kind="quiet" label="Close" onClick={() => openSheet(null)}>
          <Icon name="close" />
        </Button>
      </div>
      {found && rows.length === 0 && (
        <p className="versions-none muted" data-testid="versions-none">
          None yet. A version is kept whenever the design is saved, and whenever something else is
          opened while it has changes.
        </p>
      )}
      {rows.length > 0 && (
        <div className="versions-body">
          <ul className="versions-list" aria-label="Versions, the newest first">
            {rows.map((row) => (
              <li key={row.id}>
                <Row row={row} chosen={row.id === id} onChoose={() => choose(row.id)} />
              </li>
            ))}
            {rows.length === found?.most && (
              <li className="muted versions-most">the newest {found.most} are kept</li>
            )}
          </ul>
          <Difference id={id} />
        </div>
      )}
    </div>
  );
}

function Row(props: { row: VersionRow; chosen: boolean; onChoose(): void }) {
  const { row } = props;
  return (
    <button
      type="button"
      className="version"
      aria-pressed={props.chosen}
      data-testid="version"
      onClick={props.onChoose}
    >
      <BodyPicture url={row.picture} />
      <span>
        <strong title={new Date(row.when).toLocaleString()}>{whenWords(row.when)}</strong>
        <span className="muted">
          {row.reason}, {new Date(row.when).toLocaleTimeString()}
        </span>
      </span>
    </button>
  );
}

/** The body of a design, where it can be drawn. */
export function BodyPicture(props: { url: string }) {
  const [failed, fail] = useState(false);
  return (
    <span className="body-picture">
      {props.url && !failed && (
        <img src={props.url} alt="" loading="lazy" onError={() => fail(true)} />
      )}
    </span>
  );
}

/** Changes since a version, and a way back to it. */
function Difference(props: { id: string | null }) {
  const difference = useStudio((state) => state.versionDifference);
  if (difference === null || difference.id !== props.id) return <div className="difference" />;
  const { id, lines } = difference;
  const same = lines?.length === 0;
  const restore = () => {
    if (send({ t: "version_restore", id }) === 0) return;
    openSheet(null);
    const hint = "Undo takes it back; the text before it is a version too.";
    toast({ level: "good", what: "The version is restored", hint });
  };
  return (
    <section className="difference" aria-label="Changes since this version">
      <div className="difference-lines" data-testid="version-difference">
        {lines === null && <p className="muted">The texts are too long to be compared.</p>}
        {same && <p className="muted">The design is as it was in this version.</p>}
        {lines?.map((line) => (
          <Line key={`${line.mark} ${line.before ?? ""} ${line.after ?? ""}`} line={line} />
        ))}
      </div>
      <div className="sheet-buttons">
        <span className="muted versions-key">
          <ins>in the design now</ins> <del>in this version</del>
        </span>
        <Button kind="primary" testId="version-restore" disabled={same} onClick={restore}>
          Restore this version
        </Button>
      </div>
    </section>
  );
}

const SIGNS: Readonly<Record<DifferentLine["mark"], string>> = {
  same: "",
  gone: "−",
  new: "+",
  gap: "⋯",
};

function Line(props: { line: DifferentLine }) {
  const { mark, text, before, after } = props.line;
  return (
    <div className={`difference-line is-${mark}`} data-mark={mark}>
      <span className="muted">{mark === "gap" ? "" : before}</span>
      <span className="muted">{after}</span>
      <span>{SIGNS[mark]}</span>
      <code>{text}</code>
    </div>
  );
}
