// What can be done at the face that was pressed.
import { useState } from "react";
import { Button, Select } from "../controls/Choice";
import { formatNumber } from "../controls/units";
import { editAll } from "../panes/design/edits";
import { regionAround, regionOfFace, type Verb, verbsAt, verbsIn } from "../panes/design/here";
import { chooseFace, useFace } from "../store/face";
import { toast, useStudio } from "../store/studio";
import type { Face } from "./face";

export function FaceCard() {
  const face = useFace((state) => state.face);
  const document = useStudio((state) => state.document);
  const body = useStudio((state) => state.body);
  const [around, setAround] = useState(false);
  const source = document?.source;
  if (!face || !source || body?.topology !== face.topology) return null;
  if (face.cavity !== null) {
    const name = body.cavities[face.cavity]?.name ?? "";
    return <Verbs title={`Chamber ${name}`} verbs={verbsIn(face, name, source)} />;
  }
  const plane = regionOfFace(face, document.parameters);
  const region = plane === null || around ? regionAround(face) : plane;
  return (
    <>
      {plane && (
        <Select
          bare
          label="Where"
          value={around ? "around" : "face"}
          options={[
            { value: "face", label: `This face, ${wordsOf(face)}` },
            {
              value: "around",
              label: `Around this point, ${formatNumber(1500 * face.voxelSize, 3)} mm`,
            },
          ]}
          onChange={(value) => setAround(value === "around")}
        />
      )}
      <Verbs title="Here" verbs={verbsAt(region, face.normal, source)} />
    </>
  );
}

function Verbs(props: { title: string; verbs: readonly Verb[] }) {
  return (
    <div className="face-verbs" role="group" aria-label={props.title} data-testid="face-verbs">
      {props.verbs.map((verb) => (
        <Button
          key={verb.id}
          testId={`here-${verb.id}`}
          title={verb.title}
          onClick={() => run(verb)}
        >
          {verb.label}
        </Button>
      ))}
    </div>
  );
}

function run(verb: Verb): void {
  editAll(verb.changes);
  chooseFace(null);
  useStudio.setState({ picked: null });
  toast({
    level: "good",
    what: `${verb.label}: added to the design`,
    hint: "Ctrl+Z takes it back.",
  });
}

function wordsOf(face: Face): string {
  const axis = face.axis ?? 0;
  return `${"xyz"[axis]} = ${formatNumber(1000 * face.low[axis]!, 4)} mm`;
}
