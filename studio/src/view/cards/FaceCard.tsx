// Actions at the face that was pressed.
import { type ReactNode, useState } from "react";
import { Button, Select } from "../../controls/Choice";
import { formatNumber } from "../../controls/units";
import { PRIMITIVES, type Primitive } from "../../panes/design/bodies/gripped";
import { canMirror, mirrored } from "../../panes/design/bodies/mirrored";
import { sideFor, surroundingsOf } from "../../panes/design/bodies/placing";
import { editAll } from "../../panes/design/edits";
import { gripHere, nameOf } from "../../panes/design/here/gripHere";
import {
  regionAround,
  regionOfFace,
  type Verb,
  verbsAt,
  verbsIn,
} from "../../panes/design/here/here";
import type { BodyEvent, DocumentEvent } from "../../protocol";
import { chooseFace, useFace } from "../../store/face";
import { toast, useStudio } from "../../store/studio";
import { setView } from "../../store/view";
import type { Face } from "../hands/face";
import { viewport } from "../instance";
import { ContactHere } from "./ContactHere";
import { HereSelect } from "./HereSelect";
import { TendonHere } from "./TendonHere";

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
  const plane = regionOfFace(face, document.parameters, source);
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
      <Verbs
        title="Here"
        verbs={[...verbsAt(region, face.normal, source), ...mirrorVerb(face, document, body)]}
      >
        <TendonHere
          face={face}
          document={document}
          run={(label, changes) => run({ label, changes })}
        />
        <Gripping face={face} document={document} body={body} />
        <ContactHere
          face={face}
          document={document}
          body={body}
          run={({ done, changes }) => run({ label: done, changes })}
        />
      </Verbs>
    </>
  );
}

/** The mirror image of all, where there is room for it in front of the face. */
function mirrorVerb(face: Face, document: DocumentEvent, body: BodyEvent): Verb[] {
  const { source, parameters } = document;
  if (!source || face.axis === null || face.opposite !== null || !canMirror(source)) return [];
  const [low, high] = body.bounds;
  const size = [0, 1, 2].map((i) => high[i]! - low[i]!) as [number, number, number];
  return [
    {
      id: "mirror",
      label: "Mirror",
      title: "Another one opposite this face: shapes, clamps, layers, chambers, loads and probes",
      grows: true,
      changes: mirrored(face, size, body.cavities.length, source, parameters),
    },
  ];
}

/** Something to grip, in the middle between the face and the opposite one, or in front of it. */
function Gripping(props: { face: Face; document: DocumentEvent; body: BodyEvent }) {
  const { face, document, body } = props;
  const { source, design } = document;
  if (!source) return null;
  const add = (kind: Primitive) => {
    const alone = sideFor(surroundingsOf(body, null));
    const { name, changes } = gripHere(kind, face, alone, source, design);
    run({ label: name, changes });
    setView({ chosen: name });
  };
  return (
    <HereSelect
      label="An object to grip here"
      title="An object to grip: free, between this face and what is opposite"
      first="To grip…"
      testId="here-grip"
      options={PRIMITIVES.map((kind) => ({ value: kind, label: nameOf(kind) }))}
      onChoose={(kind) => add(kind as Primitive)}
    />
  );
}

function Verbs(props: { title: string; verbs: readonly Verb[]; children?: ReactNode }) {
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
      {props.children}
    </div>
  );
}

function run(verb: Pick<Verb, "label" | "changes" | "grows">): void {
  if (verb.grows) viewport().fitSoon();
  editAll(verb.changes);
  chooseFace(null);
  useStudio.setState({ picked: null });
  // The card is gone: keys go on in the picture.
  viewport().renderer.domElement.focus({ preventScroll: true });
  toast({
    level: "good",
    what: `${verb.label}: added to the design`,
    hint: "Ctrl+Z takes it back.",
    about: "design",
  });
}

function wordsOf(face: Face): string {
  const axis = face.axis ?? 0;
  return `${"xyz"[axis]} = ${formatNumber(1000 * face.low[axis]!, 4)} mm`;
}
