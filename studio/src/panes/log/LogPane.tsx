import { useEffect, useRef } from "react";
import { Empty } from "../../controls/Choice";
import { useStudio } from "../../store/studio";
import "./log.css";

/** Messages of the server and of this page, newest last. */
export default function LogPane() {
  const log = useStudio((state) => state.log);
  const end = useRef<HTMLDivElement>(null);
  useEffect(() => {
    end.current?.scrollIntoView({ block: "nearest" });
  }, [log]);
  if (log.length === 0) {
    return (
      <Empty title="Nothing to report">
        <p>Messages of the simulation, of jobs and of files appear here.</p>
      </Empty>
    );
  }
  return (
    <div className="pane log" role="log">
      {log.map((line) => (
        <div key={line.id} className={`log-line ${line.level}`}>
          <time>{new Date(line.at).toLocaleTimeString()}</time>
          <span>{line.text}</span>
        </div>
      ))}
      <div ref={end} />
    </div>
  );
}
