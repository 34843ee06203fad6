import { useEffect, useState } from "react";
import { Button } from "../controls/Choice";
import { useStudio } from "../store/studio";

/** State of the engine's link, in words: color alone is not enough. */
export function LinkLamp() {
  const link = useStudio((state) => state.link);
  const [, tick] = useState(0);
  useEffect(() => {
    if (link.retryAt === null) return;
    const timer = setInterval(() => tick((n) => n + 1), 500);
    return () => clearInterval(timer);
  }, [link.retryAt]);
  const text = {
    open: "connected",
    connecting: link.attempt > 1 ? "disconnected, retrying" : "connecting",
    lost: "disconnected, retrying",
    refused: "refused",
  }[link.state];
  const seconds = link.retryAt === null ? 0 : Math.ceil((link.retryAt - Date.now()) / 1000);
  return (
    <span
      className={`lamp ${link.state}`}
      role="status"
      data-testid="link"
      title={link.reason || text}
    >
      <i />
      <span className="lamp-word">{text}</span>
      {link.state === "lost" && seconds > 1 && ` in ${seconds} s`}
    </span>
  );
}

/** A band across the page while there is no connection; nothing is blocked by it. */
export function LinkBand() {
  const link = useStudio((state) => state.link);
  const seen = useStudio((state) => state.hello !== null);
  if (link.state === "open" || (link.state === "connecting" && !seen && link.attempt < 2))
    return null;
  return (
    <div className="band" role="alert" data-testid="disconnected">
      {link.state === "refused" ? (
        <>
          <b>VoxSoft refused this page:</b> {link.reason || "its address has no valid token"}.{" "}
          {link.reload ? (
            <Button onClick={() => location.reload()}>Reload the page</Button>
          ) : (
            <>
              Open the address that <code>voxsoft studio</code> printed last: this page then goes on
              by itself.
            </>
          )}
        </>
      ) : (
        <>
          <b>Disconnected, retrying.</b> What you edit is kept and sent when VoxSoft answers again.
          If it was stopped, start it with <code>voxsoft studio</code>.
        </>
      )}
    </div>
  );
}
