// Says that the job that is shown is not of the design as it stands.
import { Button } from "../../controls/Choice";
import { setJob } from "../../store/page";
import { useStudio } from "../../store/studio";
import { openHere } from "../design/edits";
import { standing } from "./standing";
import "./jobs.css";

interface Props {
  readonly job: string;
  /** True where the numbers are of one state of the design, and not of all that it may become. */
  readonly ofState?: boolean;
}

/** True if a job is of another design than the open one, or with `ofState` of an earlier state of it. */
export function useIsPast({ job, ofState }: Props): boolean {
  const subject = useStudio((state) => state.subjects[job]);
  const document = useStudio((state) => state.document);
  const found = standing(subject, document);
  return found === "other" || (ofState === true && found === "earlier");
}

export function PastNote(props: Props) {
  const subject = useStudio((state) => state.subjects[props.job]);
  const document = useStudio((state) => state.document);
  if (!useIsPast(props) || !subject) return null;
  if (standing(subject, document) === "earlier") {
    return (
      <p className="warn past-note" role="status" data-testid="past-note">
        These numbers are of the design before its last change.
      </p>
    );
  }
  return (
    <p className="warn past-note" role="status" data-testid="past-note">
      This is of {subject.design}, another design than the open one.{" "}
      <Button
        kind="quiet"
        label={`Open the design of ${props.job}`}
        onClick={() => {
          openHere("run", props.job);
          setJob(props.job);
        }}
      >
        Open that
      </Button>
    </p>
  );
}
