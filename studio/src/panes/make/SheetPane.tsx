// The sheet of the molds that were made last: parts, grams, steps with pictures, proofs.
import { Empty } from "../../controls/Choice";
import { useStudio } from "../../store/studio";
import { useMaking } from "./made";
import "./make.css";

export default function SheetPane() {
  const id = useStudio((state) => state.document?.id);
  const rev = useStudio((state) => state.document?.rev);
  const { made, of } = useMaking();
  if (!made?.sheet || of !== id) {
    return (
      <Empty title="No sheet yet">
        <p>Make molds: their sheet says how to print, mix, pour and bond.</p>
      </Empty>
    );
  }
  return (
    <div className="sheet-pane" data-testid="sheet-pane">
      {made.rev !== rev && (
        <p className="warn">This sheet is of the design before its last change.</p>
      )}
      {/* Nothing in it may run or lead elsewhere: it is a picture of a file. */}
      <iframe title="Sheet of the molds" sandbox="" srcDoc={made.sheet} />
    </div>
  );
}
