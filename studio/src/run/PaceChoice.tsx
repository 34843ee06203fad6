import { Select } from "../controls/Choice";
import { paceName } from "../engine/pace";
import { PACES } from "../protocol";
import { choosePace } from "../shell/actions";
import { useStudio } from "../store/studio";

const AUTO = "auto";

/** Pace of the shown time; the automatic pace shows the one it has found. */
export function PaceChoice() {
  const pace = useStudio((state) => state.stat?.pace ?? 1);
  const chosen = useStudio((state) => state.stat?.pace_chosen ?? null);
  const auto = chosen === null && pace !== 1 ? `auto · ${paceName(pace)}` : "auto speed";
  const options = [
    { value: AUTO, label: auto },
    ...PACES.map((one) => ({ value: String(one), label: paceName(one) })),
  ];
  return (
    <Select
      bare
      label="Speed of time"
      title="Speed of time: slower (,) and faster (.)"
      value={chosen === null ? AUTO : String(chosen)}
      options={options}
      onChange={(value) => choosePace(value === AUTO ? null : Number(value))}
    />
  );
}
