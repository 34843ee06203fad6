// Contacts of the body at the face that was pressed, and bonds there.
import { bondOffers, type Offer, touchOffers } from "../../panes/design/here/touchHere";
import type { BodyEvent, DocumentEvent } from "../../protocol";
import { setView } from "../../store/view";
import type { Face } from "../hands/face";
import { HereSelect } from "./HereSelect";

export function ContactHere(props: {
  face: Face;
  document: DocumentEvent;
  body: BodyEvent;
  run(offer: Offer): void;
}) {
  const { face, document, body } = props;
  const { source, design, parameters } = document;
  if (!source) return null;
  const around = { face, body, source, design, parameters };
  const run = (offer: Offer) => {
    props.run(offer);
    if (offer.adds !== undefined) setView({ chosen: offer.adds });
  };
  const touches = touchOffers(around);
  const bonds = bondOffers(around);
  return (
    <>
      <HereSelect
        label="Touch here"
        title="What the body touches: something new on this face, or what is there already, with friction"
        first="Touch…"
        testId="here-touch"
        options={touches.map(optionOf)}
        onChoose={(id) => take(touches, id, run)}
      />
      {bonds.length > 0 && (
        <HereSelect
          label="Bond here"
          title="What is glued to the body where the two are within half a voxel. Parts of one body are joined without a bond."
          first="Bond…"
          testId="here-bond"
          options={bonds.map(optionOf)}
          onChoose={(id) => take(bonds, id, run)}
        />
      )}
    </>
  );
}

const optionOf = ({ id, label, disabled = false }: Offer) => ({ value: id, label, disabled });

function take(offers: readonly Offer[], id: string, run: (offer: Offer) => void): void {
  const offer = offers.find((one) => one.id === id);
  if (offer) run(offer);
}
