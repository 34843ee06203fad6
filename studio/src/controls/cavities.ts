// Names of cavities, and the choice of one.

/** Name of a cavity in words: its name, or its number as designs count. */
export function cavityName(cavity: { readonly name: string }, index: number): string {
  return cavity.name || `cavity ${index}`;
}

/** All chambers by name, and by number those that have none; the written one is always there. */
export function cavityOptions(
  names: readonly string[],
  cavities: readonly { readonly name: string }[],
  current: string,
): { value: string; label: string }[] {
  const numbers = [...cavities.entries()]
    .filter(([, cavity]) => !cavity.name)
    .map(([index]) => String(index));
  const known = [
    { value: "all", label: "all" },
    ...names.map((name) => ({ value: name, label: name })),
    ...numbers.map((number) => ({ value: number, label: `cavity ${number}` })),
  ];
  return known.some((one) => one.value === current)
    ? known
    : [...known, { value: current, label: /^\d+$/.test(current) ? `cavity ${current}` : current }];
}
