import { send } from "../store/session";
import { useStudio } from "../store/studio";

/** Show the stored frame nearest to a time. */
export function seekTo(time: number): void {
  const { stat } = useStudio.getState();
  if (!stat || stat.last_frame <= stat.first_frame) return;
  send({ t: "seek", time });
}
