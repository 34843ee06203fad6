// Numbers in place of a plot: of a body that was solved at rest there is no course over time.

/** Moments from which on a plot shows more than a vertical line. */
const FEW = 3;

export function isStill(times: readonly number[]): boolean {
  return new Set(times).size < FEW;
}

export function LastValues(props: {
  testId: string;
  rows: readonly (readonly [name: string, value: string])[];
}) {
  return (
    <div className="pane" data-testid={props.testId}>
      <dl className="facts">
        {props.rows.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
      <p className="muted">Let time run to plot them over time.</p>
    </div>
  );
}
