import { useMemo } from "react";
import { Button } from "../../../controls/Choice";
import { formatQuantity } from "../../../controls/units";
import type { Parameter } from "../../../protocol";
import { useStudio } from "../../../store/studio";
import { written } from "../bodies/placing";
import { edit } from "../edits";
import { useForm } from "../form";
import { brokenCount, commonVoxel, namesOfShapes } from "./onGrid";

const shown = (meters: number) => formatQuantity(Number(meters.toPrecision(6)), "m");

/** Length of a parameter that whole voxels round, with voxels that hold it. */
export function GridNote(props: { parameter: Parameter }) {
  const { parameter } = props;
  const body = useStudio((state) => state.body);
  const parameters = useStudio((state) => state.document?.parameters);
  const { source } = useForm();
  const names = useMemo(() => namesOfShapes(source), [source]);
  // A way, or a place of a load, needs no voxels of its own.
  if (
    parameter.kind !== "length" ||
    !names.has(parameter.name) ||
    !body ||
    body.cut ||
    !(body.voxel_size > 0)
  )
    return null;
  const voxel = body.voxel_size;
  const count = brokenCount(parameter.value, voxel);
  if (count === null) return null;
  const lengths = (parameters ?? []).filter((one) => one.kind === "length" && names.has(one.name));
  const finer = commonVoxel(
    lengths.map((one) => one.value),
    voxel,
  );
  const [low, high] = [Math.floor(count) * voxel, Math.ceil(count) * voxel];
  return (
    <p className="grid-note" data-testid={`grid-note-${parameter.name}`}>
      {shown(parameter.value)} is {Number(count.toPrecision(3))} voxels: whole ones hold{" "}
      {low > 0 ? `${shown(low)} or ` : ""}
      {shown(high)}.
      {finer !== null && (
        <Button kind="quiet" onClick={() => edit(["voxel_size"], written(finer))}>
          Voxels of {shown(finer)}
        </Button>
      )}
    </p>
  );
}
