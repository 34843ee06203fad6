import { type ReactNode, useMemo, useState } from "react";

export interface Column<Row> {
  readonly key: string;
  readonly title: ReactNode;
  readonly right?: boolean;
  /** Content of the cell. */
  cell(row: Row): ReactNode;
  /** Key of the column for sorting; without it the column does not sort. */
  sort?(row: Row): number | string | null;
}

export interface TableProps<Row> {
  label: string;
  columns: readonly Column<Row>[];
  rows: readonly Row[];
  rowKey(row: Row): string;
  selected?: ReadonlySet<string>;
  onChoose?(row: Row, extend: boolean): void;
  onHover?(row: Row | null): void;
  empty?: ReactNode;
  /** Largest number of drawn rows, after sorting. */
  most?: number;
  testId?: string;
}

/** A table that sorts by a click on its heads; rows can be chosen by mouse and keyboard. */
export function Table<Row>(props: TableProps<Row>) {
  const [order, setOrder] = useState<{ key: string; down: boolean } | null>(null);
  const sorted = useMemo(() => {
    const by = order && props.columns.find((column) => column.key === order.key)?.sort;
    if (!by || !order) return props.rows;
    return [...props.rows].sort((a, b) => compare(by(a), by(b), order.down ? -1 : 1));
  }, [props.rows, props.columns, order]);
  if (props.rows.length === 0 && props.empty) return <>{props.empty}</>;
  return (
    <div className="table-wrap" data-testid={props.testId}>
      <table className="table" aria-label={props.label}>
        <thead>
          <tr>
            {props.columns.map((column) => (
              <th
                key={column.key}
                className={column.right ? "right" : undefined}
                aria-sort={
                  order?.key === column.key ? (order.down ? "descending" : "ascending") : undefined
                }
              >
                {column.sort ? (
                  <button
                    type="button"
                    onClick={() =>
                      setOrder({
                        key: column.key,
                        down: order?.key === column.key ? !order.down : false,
                      })
                    }
                  >
                    {column.title}
                    {order?.key === column.key ? (order.down ? " ↓" : " ↑") : ""}
                  </button>
                ) : (
                  column.title
                )}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {sorted.slice(0, props.most).map((row) => {
            const key = props.rowKey(row);
            return (
              <tr
                key={key}
                className={props.onChoose ? "choosable" : undefined}
                aria-selected={props.selected?.has(key)}
                tabIndex={props.onChoose ? 0 : undefined}
                onClick={(event) => props.onChoose?.(row, event.shiftKey || event.ctrlKey)}
                onKeyDown={(event) => {
                  if (event.key === "Enter") props.onChoose?.(row, event.shiftKey);
                }}
                onMouseEnter={() => props.onHover?.(row)}
                onMouseLeave={() => props.onHover?.(null)}
              >
                {props.columns.map((column) => (
                  <td key={column.key} className={column.right ? "right" : undefined}>
                    {column.cell(row)}
                  </td>
                ))}
              </tr>
            );
          })}
        </tbody>
      </table>
      {props.most !== undefined && sorted.length > props.most && (
        <p className="table-more muted">
          {sorted.length - props.most} more rows: sort or filter to see them.
        </p>
      )}
    </div>
  );
}

/** A row without a value stands last, whichever way the others are sorted. */
export function compare(
  a: number | string | null,
  b: number | string | null,
  sign: 1 | -1,
): number {
  if (a === b) return 0;
  if (a === null) return 1;
  if (b === null) return -1;
  return a < b ? -sign : sign;
}
