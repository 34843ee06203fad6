import { Button } from "../../controls/Choice";
import { send } from "../../store/session";
import { useStudio } from "../../store/studio";

/** Says in the picture that time does not run for a body that may touch something, until it is solved. */
export function ContactBanner() {
  const why = useStudio((state) => state.body?.not_live ?? "");
  const state = useStudio(({ stat }) => stat?.state);
  const solved = useStudio(({ moments }) => moments.size > 0);
  if (!why || solved || state === "solving" || state === "diverged") return null;
  return (
    <div className="view-banner note" role="status" data-testid="not-live">
      <p>{why}</p>
      <Button kind="primary" testId="not-live-solve" onClick={() => send({ t: "rest" })}>
        Solve
      </Button>
    </div>
  );
}
