// Asks before an entry goes on which others depend.
import { Button } from "../../../controls/Choice";
import { openSheet } from "../../../store/page";
import { editAll } from "../edits";
import { useRemoving } from "./remove";
import "./removing.css";

export function RemoveSheet() {
  const { name, removal } = useRemoving();
  if (!removal) return null;
  const { along, kept, changes } = removal;
  return (
    <div className="save-sheet" role="alert">
      <h2>{name} is in use</h2>
      {along.length > 0 && (
        <>
          <p>With it goes what cannot be without it:</p>
          <Names names={along} />
        </>
      )}
      {kept.length > 0 && (
        <>
          <p>Others stay, and are changed:</p>
          <Names names={kept} />
        </>
      )}
      <p className="muted">It is one step, which Ctrl+Z takes back.</p>
      <div className="sheet-buttons">
        <Button kind="quiet" onClick={() => openSheet(null)}>
          Cancel
        </Button>
        <Button
          kind="danger"
          testId="remove-all"
          onClick={() => {
            openSheet(null);
            editAll(changes);
          }}
        >
          {along.length > 0 ? `Remove all ${along.length + 1}` : "Remove"}
        </Button>
      </div>
    </div>
  );
}

function Names(props: { names: readonly string[] }) {
  return (
    <ul className="removed-names">
      {props.names.map((name) => (
        <li key={name}>{name}</li>
      ))}
    </ul>
  );
}
