import { Empty } from "../../controls/Choice";
import { editAll } from "../../panes/design/edits";
import { ShapeIcon } from "../../panes/design/shapes/ShapeIcon";
import { type Addable, FIRST_KINDS, isFeature } from "../../panes/design/shapes/shapeKinds";
import { shapeStarter } from "../../panes/design/shapes/shapeStarters";
import { FIRST_SPOT, withShape } from "../../panes/design/shapes/shapeVerbs";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";
import { setView } from "../../store/view";

/** Shapes and features with which most robots begin, in the middle of a view that holds nothing yet. */
export function EmptyStage() {
  const begin = (kind: Addable) => {
    if (isFeature(kind)) {
      send({ t: "add_feature", name: kind, at: null });
      return;
    }
    const source = useStudio.getState().document?.source ?? {};
    const { name, changes } = withShape(shapeStarter(kind, FIRST_SPOT), source);
    editAll(changes);
    setView({ shape: name });
  };
  return (
    <div className="no-body" data-testid="empty-stage">
      <Empty title="Begin with a shape">
        <div className="stage-starts">
          {FIRST_KINDS.map((kind) => (
            <button
              key={kind}
              type="button"
              className="welcome-card stage-start"
              data-testid={`stage-${kind}`}
              onClick={() => begin(kind)}
            >
              <ShapeIcon kind={kind} />
              <strong>{kind}</strong>
            </button>
          ))}
        </div>
        <p>The form at the left has all other kinds; a mesh or a design can be dropped anywhere.</p>
      </Empty>
    </div>
  );
}
