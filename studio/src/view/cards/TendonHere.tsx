// A tendon through places that are pressed one after the other.
import { Button } from "../../controls/Choice";
import type { Change } from "../../panes/design/edits";
import {
  canHaveTendons,
  placeIn,
  tendonBetween,
  tendonOn,
} from "../../panes/design/here/tendonHere";
import type { DocumentEvent } from "../../protocol";
import { beginTendon, chooseFace, useFace } from "../../store/face";
import { toast, useStudio } from "../../store/studio";
import type { Face } from "../hands/face";

export function TendonHere(props: {
  face: Face;
  document: DocumentEvent;
  run(label: string, changes: readonly Change[]): void;
}) {
  const { face, document, run } = props;
  const begun = useFace((state) => state.tendon);
  const { source, name } = document;
  if (!source || !canHaveTendons(source)) return null;
  const place = placeIn(face);
  // A place in one design is none in another.
  const from = begun?.design === name ? begun.place : null;
  const on = from ? null : tendonOn(place, face.voxelSize, source);
  const begin = () => {
    beginTendon({ place, design: name });
    chooseFace(null);
    useStudio.setState({ picked: null });
    toast({
      level: "info",
      what: "Press where the tendon goes",
      hint: "It is pulled where it begins. Then press Tendon to here.",
      about: "design",
    });
  };
  return (
    <>
      {from ? (
        <Button
          testId="here-tendon-to"
          title="A line from the place before to this one, pulled by 100 mN"
          onClick={() => {
            beginTendon(null);
            run("Tendon", [tendonBetween(from, place, face.voxelSize, source)]);
          }}
        >
          Tendon to here
        </Button>
      ) : (
        <Button
          testId="here-tendon"
          title="A line that is pulled here; the next place that is pressed is its anchor"
          onClick={begin}
        >
          Tendon from here
        </Button>
      )}
      {on && (
        <Button
          testId="here-tendon-on"
          title="The last tendon goes on to this place, and is anchored here"
          onClick={() => run("Tendon", on)}
        >
          Tendon on to here
        </Button>
      )}
    </>
  );
}
