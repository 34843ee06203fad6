import { Button, Empty } from "../../controls/Choice";
import { showPane } from "../../shell/actions";
import { setMode } from "../../store/page";

/** Text in the plots of a study while there is none. */
export function NoStudy(props: { what: string }) {
  return (
    <Empty title="No study yet">
      <p>{props.what}</p>
      <span className="row">
        <Button
          onClick={() => {
            setMode("optimize");
            showPane("study");
          }}
        >
          Set one up
        </Button>
        <Button kind="quiet" onClick={() => setMode("runs")}>
          Open a past one
        </Button>
      </span>
    </Empty>
  );
}
