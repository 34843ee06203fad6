import { useEffect, useState } from "react";
import { fetchStill, type Still } from "./fetchStill";

export interface StillState {
  /** The last body that came; it stays while another edition of it is under way. */
  readonly still: Still | null;
  readonly pending: boolean;
  /** Why there is none, as a sentence; empty where there is nothing to say. */
  readonly failure: string;
  again(): void;
}

interface Answer {
  readonly name: string | null;
  readonly still: Still | null;
  readonly pending: boolean;
  readonly failure: string;
}

/**
 * The body of a name, asked for again when its edition changes. What is under way is given up when
 * the name changes or the pane closes, and its solver stops.
 */
export function useStill(name: string | null, edition: unknown = null): StillState {
  const [tries, setTries] = useState(0);
  const [answer, setAnswer] = useState<Answer>({
    name,
    still: null,
    pending: name !== null,
    failure: "",
  });
  useEffect(() => {
    if (name === null) return;
    const leave = new AbortController();
    setAnswer((before) => ({
      name,
      still: before.name === name ? before.still : null,
      pending: true,
      failure: "",
    }));
    fetchStill(name, leave.signal).then(
      (still) => setAnswer({ name, still, pending: false, failure: "" }),
      (error: unknown) => {
        if (leave.signal.aborted) return;
        const failure = error instanceof TypeError ? "VoxSoft does not answer." : String(error);
        setAnswer((before) => ({
          ...before,
          pending: false,
          failure: failure.replace(/^Error: /, ""),
        }));
      },
    );
    return () => leave.abort();
  }, [name, edition, tries]);
  return { ...answer, again: () => setTries(tries + 1) };
}
