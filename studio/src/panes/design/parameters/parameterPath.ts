/** Path of the value of a parameter: a table has it inside. */
export function valuePath(
  source: Readonly<Record<string, unknown>>,
  name: string,
): (string | number)[] {
  const all = source.parameters as Record<string, unknown> | undefined;
  const written = all?.[name];
  return typeof written === "object" && written !== null
    ? ["parameters", name, "value"]
    : ["parameters", name];
}
