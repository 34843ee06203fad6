// The curve of a material in a few pixels: solid where it was tested, dashed beyond.
import type { MaterialFacts } from "../../protocol";
import { testedAndBeyond } from "./list";

const [WIDTH, HEIGHT] = [72, 34];

export function Spark(props: { of: MaterialFacts }) {
  const [stretches, stresses, tested] = testedAndBeyond(props.of);
  const known = stresses.map((stress) => stress ?? Number.NaN);
  const high = Math.max(...known.filter(Number.isFinite), Number.MIN_VALUE);
  const [start, end] = [stretches[0] ?? 1, stretches.at(-1) ?? 2];
  const points = stretches.map((stretch, i) => {
    const x = 1 + ((WIDTH - 2) * (stretch - start)) / (end - start);
    return `${x.toFixed(1)},${(HEIGHT - 1 - ((HEIGHT - 3) * known[i]!) / high).toFixed(1)}`;
  });
  const line = (some: readonly string[]) => some.filter((one) => !one.includes("NaN")).join(" ");
  return (
    <svg className="spark" viewBox={`0 0 ${WIDTH} ${HEIGHT}`} aria-hidden="true">
      <path d={`M0.500 0.500V${HEIGHT - 0.5}H${WIDTH}`} className="spark-axes" />
      {tested > 1 && <polyline points={line(points.slice(0, tested))} />}
      <polyline className="is-beyond" points={line(points.slice(Math.max(tested - 1, 0)))} />
    </svg>
  );
}
