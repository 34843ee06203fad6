import { send } from "../store/session";
import { useStudio } from "../store/studio";

/** Show the stored frame nearest to a time; frames are stored at even spacing. */
export function seekTo(time: number): void {
  const { stat, history } = useStudio.getState();
  if (!stat || stat.last_frame <= stat.first_frame) return;
  const times = history.columns[0] ?? [];
  const [start, end] = [times[0] ?? 0, times.at(-1) ?? 0];
  if (!(end > start)) return;
  const share = Math.min(1, Math.max(0, (time - start) / (end - start)));
  const frame = Math.round(stat.first_frame + share * (stat.last_frame - stat.first_frame));
  send({ t: "seek", frame });
}
