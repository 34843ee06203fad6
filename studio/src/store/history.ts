// Plotted values over time: columns that grow, outside of React. Beyond the longest length
// every second row is dropped, so that a long run stays whole at a coarser spacing.
import type { PlotEvent } from "../protocol";

export class PlotHistory {
  names: readonly string[] = [];
  units: readonly string[] = [];
  columns: number[][] = [];

  constructor(private readonly longest = 6000) {}

  get length(): number {
    return this.columns[0]?.length ?? 0;
  }

  clear(): void {
    this.columns = this.names.map(() => []);
  }

  append(event: PlotEvent): void {
    const same =
      event.names.length === this.names.length &&
      event.names.every((name, i) => name === this.names[i]);
    if (!same) this.rename(event.names);
    this.units = event.units;
    if (event.clear) this.clear();
    for (const row of event.rows) {
      // Time that starts over, as after a reset, starts the plot over.
      const time = row[0] ?? Number.NaN;
      const last = this.columns[0]?.at(-1);
      if (last !== undefined && time < last) this.clear();
      for (const [i, column] of this.columns.entries()) column.push(row[i] ?? Number.NaN);
    }
    if (this.length > this.longest) {
      this.columns = this.columns.map((column) => column.filter((_, i) => i % 2 === 0));
    }
  }

  // A probe that is added keeps the earlier values of the others.
  private rename(names: readonly string[]): void {
    const rows = this.length;
    const old = new Map(this.names.map((name, i) => [name, this.columns[i] ?? []]));
    this.columns = names.map((name) => old.get(name) ?? new Array<number>(rows).fill(Number.NaN));
    this.names = names;
  }
}
