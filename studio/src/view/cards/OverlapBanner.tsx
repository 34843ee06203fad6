import { Button } from "../../controls/Choice";
import { viewport } from "../instance";
import { useOverlap } from "../marks/overlap";

/** Says in the picture that walls of the body are in each other. */
export function OverlapBanner() {
  const overlap = useOverlap();
  const [deepest] = overlap?.places ?? [];
  if (!overlap || !deepest) return null;
  return (
    <div className="view-banner warn" role="status" data-testid="overlap">
      <p>{overlap.sentence}</p>
      <Button testId="overlap-show" onClick={() => viewport().showOverlap(deepest)}>
        Show
      </Button>
    </div>
  );
}
