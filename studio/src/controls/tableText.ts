// Tables as spreadsheets take them from the clipboard.
type Cell = string | number | null | undefined;

/** Rows with tabs between their cells; numbers in full, missing ones left empty. */
export function tableText(head: readonly string[], rows: readonly (readonly Cell[])[]): string {
  const text = (cell: Cell) =>
    cell == null || (typeof cell === "number" && !Number.isFinite(cell))
      ? ""
      : String(cell).replaceAll(/[\t\r\n]+/g, " ");
  return [head, ...rows].map((row) => `${row.map(text).join("\t")}\n`).join("");
}
