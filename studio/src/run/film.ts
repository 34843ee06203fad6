// The stored frames of a solution over time, shown one after the other as fast as its time went.
import { create } from "zustand";
import type { Moment } from "../protocol";
import { send } from "../store/session";
import { useStudio } from "../store/studio";

/** Time between two frames of a film that are asked for, ms: each makes a way to the server and back. */
const EVERY = 40;

export const useFilm = create<{ readonly on: boolean }>(() => ({ on: false }));

let timer: ReturnType<typeof setInterval> | null = null;

/** The moments of the newest solution: those at the end whose time goes on. */
export function newestFilm(moments: ReadonlyMap<number, Moment>): readonly Moment[] {
  const all = [...moments.values()].sort((a, b) => a.frame - b.frame);
  let first = all.length - 1;
  while (first > 0 && (all[first - 1] as Moment).time < (all[first] as Moment).time) first -= 1;
  return all.slice(Math.max(first, 0));
}

/** The last moment up to a time. */
export function momentAt(film: readonly Moment[], time: number): Moment | undefined {
  return film.findLast((moment) => moment.time <= time) ?? film[0];
}

/** Check if there is a film to show of the body. */
export function useHasFilm(): boolean {
  return useStudio((state) => newestFilm(state.moments).length > 1);
}

export function stopFilm(): void {
  if (timer !== null) clearInterval(timer);
  timer = null;
  if (useFilm.getState().on) useFilm.setState({ on: false });
}

/** Show the newest film, from where it is looked at or from its beginning; or stop it. */
export function toggleFilm(): void {
  if (useFilm.getState().on) {
    stopFilm();
    return;
  }
  const { moments, stat } = useStudio.getState();
  const film = newestFilm(moments);
  const [first, last] = [film[0], film.at(-1)];
  if (!first || !last || film.length < 2) return;
  const from = film.find((moment) => moment.frame === stat?.frame);
  let time = from && from !== last ? from.time : first.time;
  let before = performance.now();
  useFilm.setState({ on: true });
  timer = setInterval(() => {
    // Another body, or a solution that goes on: this film is over.
    const now = useStudio.getState();
    if (now.moments !== moments || now.stat?.state === "solving") {
      stopFilm();
      return;
    }
    const passed = (performance.now() - before) / 1000;
    before = performance.now();
    time = Math.min(last.time, time + passed * (now.stat?.pace_chosen ?? 1));
    const moment = momentAt(film, time);
    if (moment) send({ t: "seek", frame: moment.frame });
    if (time >= last.time) stopFilm();
  }, EVERY);
}
