import { useMemo } from "react";
import { Button, Empty } from "../../controls/Choice";
import { copy } from "../../controls/clipboard";
import { formatKind } from "../../controls/kinds";
import { type Column, Table } from "../../controls/Table";
import { formatNumber } from "../../controls/units";
import type { StationError } from "../../protocol";
import { useCalibration } from "./current";
import { errorsText } from "./text";
import "../study/study.css";

/** The error at each station in mm and in percent, with the measured and the simulated value. */
export default function ErrorsPane() {
  const current = useCalibration();
  const result = current?.result;
  const overlay = current?.overlay;
  const rows = useMemo((): readonly StationError[] => {
    if (result) return result.table;
    return (overlay?.experiments ?? []).flatMap((experiment) =>
      experiment.error.map((error, i) => ({
        experiment: experiment.name,
        station: String(i + 1),
        measured: [...(experiment.measured[i] ?? [])],
        simulated: [...(experiment.simulated[i] ?? [])],
        error,
        percent: experiment.percent[i] ?? Number.NaN,
      })),
    );
  }, [result, overlay]);
  const quantities = result?.quantities ?? ["x", "y", "z"];
  const columns = useMemo((): Column<StationError>[] => {
    const length = (value: number | undefined) => formatKind(value, "length", 4);
    const many = new Set(rows.map((row) => row.experiment)).size > 1;
    return [
      ...(many
        ? [
            {
              key: "experiment",
              title: "Table",
              cell: (row: StationError) => row.experiment,
              sort: (row: StationError) => row.experiment,
            },
          ]
        : []),
      { key: "station", title: "Station", cell: (row) => row.station },
      ...quantities.flatMap((name, i): Column<StationError>[] => [
        {
          key: `measured-${name}`,
          title: `${name} measured`,
          right: true,
          cell: (row) => length(row.measured[i]),
          sort: (row) => row.measured[i] ?? null,
        },
        {
          key: `simulated-${name}`,
          title: `${name} simulated`,
          right: true,
          cell: (row) => length(row.simulated[i]),
          sort: (row) => row.simulated[i] ?? null,
        },
      ]),
      {
        key: "error",
        title: <b>Error</b>,
        right: true,
        cell: (row) => formatKind(row.error, "length", 3),
        sort: (row) => row.error,
      },
      {
        key: "percent",
        title: <b>of the sag</b>,
        right: true,
        cell: (row) => `${formatNumber(row.percent, 3)} %`,
        sort: (row) => row.percent,
      },
    ];
  }, [rows, quantities]);
  if (rows.length === 0) {
    return (
      <Empty title="No errors yet">
        <p>Once a calibration runs, the error at each station stands here in mm and percent.</p>
      </Empty>
    );
  }
  return (
    <div className="plot-pane">
      <div className="plot-bar">
        <span className="muted">{rows.length} stations</span>
        <Button
          kind="quiet"
          testId="copy-errors"
          label="Copy the errors as a table, in SI units"
          onClick={() => void copy(errorsText(rows, quantities), "the errors")}
        >
          Copy data
        </Button>
      </div>
      <div className="plot-rest">
        <Table
          label="Errors at the stations"
          testId="errors-table"
          columns={columns}
          rows={rows}
          rowKey={(row) => `${row.experiment} ${row.station}`}
        />
      </div>
    </div>
  );
}
