import { useEffect, useRef, useState } from "react";
import { fetchStill, type Still } from "./fetchStill";

interface Answer {
  /** The last body that came; it stays while a newer edition of it is under way. */
  readonly still: Still | null;
  readonly pending: boolean;
  /** Why there is none, as a sentence; empty where there is nothing to say. */
  readonly failure: string;
}

export interface StillState extends Answer {
  again(): void;
}

/**
 * The body of a name, asked for again when its edition changes: one after the other, the newest
 * last. A request under way is given up when the name changes or the pane closes, and its solver
 * stops.
 */
export function useStill(name: string, edition: unknown = null): StillState {
  const [tries, setTries] = useState(0);
  const [answer, setAnswer] = useState<Answer>({ still: null, pending: true, failure: "" });
  const newest = useRef(edition);
  const ask = useRef<() => void>(() => {});
  newest.current = edition;
  useEffect(() => {
    const leave = new AbortController();
    let asking = false;
    let asked: unknown;
    const begin = async () => {
      if (asking) return;
      asking = true;
      do {
        asked = newest.current;
        try {
          const still = await fetchStill(name, leave.signal);
          setAnswer({ still, pending: false, failure: "" });
        } catch (error) {
          if (leave.signal.aborted) return;
          setAnswer((before) => ({ ...before, pending: false, failure: sentence(error) }));
        }
      } while (asked !== newest.current);
      asking = false;
    };
    setAnswer({ still: null, pending: true, failure: "" });
    ask.current = () => void begin();
    ask.current();
    return () => leave.abort();
  }, [name, tries]);
  useEffect(() => {
    ask.current();
  }, [edition]);
  return { ...answer, again: () => setTries(tries + 1) };
}

function sentence(error: unknown): string {
  // Browsers give a TypeError where nobody answers.
  if (error instanceof TypeError) return "VoxSoft does not answer.";
  return error instanceof Error ? error.message : String(error);
}
