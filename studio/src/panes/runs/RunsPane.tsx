// Every run, study and calibration on disk: search, open, rename, compare, delete and take back.

import { useDeferredValue, useEffect, useMemo, useState } from "react";
import { Button, Empty } from "../../controls/Choice";
import { type Column, Table } from "../../controls/Table";
import { formatSpan } from "../../controls/units";
import type { RunRow } from "../../protocol";
import { showPane } from "../../shell/actions";
import { type Mode, setJob, setMode } from "../../store/page";
import { onReady, send } from "../../store/session";
import { toast, useStudio } from "../../store/studio";
import { openHere } from "../design/edits";
import { Glyph } from "../design/fields/Glyph";
import { Reproduce } from "../jobs/Recipe";
import { ago, inTrash, matchesSearch } from "./rows";
import "../jobs/jobs.css";
import "./runs.css";

const MODES: Readonly<Record<RunRow["kind"], Mode>> = {
  run: "simulate",
  study: "optimize",
  calibrate: "calibrate",
  unknown: "design",
};

const KINDS: Readonly<Record<RunRow["kind"], string>> = {
  run: "simulation",
  study: "study",
  calibrate: "calibration",
  unknown: "folder",
};

const TONES: Readonly<Record<string, string>> = {
  ok: "good",
  done: "good",
  running: "good",
  failed: "bad",
  broken: "bad",
  diverged: "bad",
};

/** Show the content of a folder: its design in the view, its study or calibration in the plots. */
function open(row: RunRow, go: boolean): void {
  openHere("run", row.id);
  if (row.kind === "study" || row.kind === "calibrate") setJob(row.id);
  if (go) setMode(MODES[row.kind]);
}

function remove(row: RunRow): void {
  send({ t: "run_delete", id: row.id });
  toast({
    level: "info",
    what: `${row.name} is in the trash`,
    hint: "",
    action: {
      label: "Undo",
      run: () => {
        const trash = useStudio.getState().runs?.trash ?? [];
        send({ t: "run_restore", id: inTrash(trash, row.id) });
      },
    },
  });
}

export default function RunsPane() {
  const runs = useStudio((state) => state.runs);
  const open_ = useStudio((state) => state.link.state === "open");
  const [search, setSearch] = useState("");
  const [renamed, rename] = useState<string | null>(null);
  const [chosen, choose] = useState<readonly string[]>([]);
  const [shown, show] = useState<string | null>(null);
  const [trash, showTrash] = useState(false);
  const words = useDeferredValue(search);

  useEffect(() => {
    const ask = () => void send({ t: "runs" });
    if (open_) ask();
    return onReady(ask);
  }, [open_]);

  const rows = useMemo(
    () => (runs?.rows ?? []).filter((row) => matchesSearch(row, words)),
    [runs, words],
  );
  const columns = useMemo((): Column<RunRow>[] => {
    const toggle = (id: string) =>
      choose((ids) =>
        ids.includes(id) ? ids.filter((one) => one !== id) : [...ids, id].slice(-2),
      );
    return [
      {
        key: "compare",
        title: <span className="visually-hidden">Compare</span>,
        cell: (row) => (
          <input
            type="checkbox"
            aria-label={`Compare ${row.name}`}
            checked={chosen.includes(row.id)}
            onClick={(event) => event.stopPropagation()}
            onChange={() => toggle(row.id)}
          />
        ),
      },
      {
        key: "picture",
        title: <span className="visually-hidden">Picture</span>,
        cell: (row) =>
          row.thumbnail ? (
            <img className="thumbnail" src={row.thumbnail} alt="" loading="lazy" />
          ) : (
            <span className="thumbnail" />
          ),
      },
      {
        key: "name",
        title: "Name",
        cell: (row) =>
          renamed === row.id ? (
            <Rename row={row} onDone={() => rename(null)} />
          ) : (
            <span className="run-name" title={row.folder}>
              <strong>{row.name}</strong>
              <Button icon kind="quiet" label={`Rename ${row.name}`} onClick={() => rename(row.id)}>
                <Glyph name="pencil" />
              </Button>
            </span>
          ),
        sort: (row) => row.name.toLowerCase(),
      },
      {
        key: "kind",
        title: "Kind",
        cell: (row) => (
          <>
            {KINDS[row.kind]}
            {row.kind === "study" && row.trials !== null && (
              <span className="muted">, {row.trials} designs</span>
            )}
          </>
        ),
        sort: (row) => row.kind,
      },
      {
        key: "status",
        title: "Status",
        cell: (row) => (
          <span className={`badge ${TONES[row.status] ?? "warn"}`} title={row.message}>
            {row.status}
          </span>
        ),
        sort: (row) => row.status,
      },
      {
        key: "best",
        title: "Best",
        cell: (row) => row.best || <span className="muted">–</span>,
        sort: (row) => row.best || null,
      },
      {
        key: "when",
        title: "When",
        cell: (row) => (
          <time
            dateTime={row.when}
            title={`${new Date(row.when).toLocaleString()}${
              row.seconds === null ? "" : `, took ${formatSpan(row.seconds)}`
            }`}
          >
            {ago(row.when, Date.now())}
          </time>
        ),
        sort: (row) => row.when,
      },
      {
        key: "actions",
        title: <span className="visually-hidden">Actions</span>,
        right: true,
        cell: (row) => (
          // biome-ignore lint/a11y/noStaticElementInteractions: it only keeps clicks off the row
          // biome-ignore lint/a11y/useKeyWithClickEvents: it only keeps clicks off the row
          <span className="run-actions" onClick={(event) => event.stopPropagation()}>
            <Button label={`Work on with ${row.name}`} onClick={() => open(row, true)}>
              Open
            </Button>
            <Button icon kind="quiet" label={`Delete ${row.name}`} onClick={() => remove(row)}>
              <Glyph name="trash" />
            </Button>
          </span>
        ),
      },
    ];
  }, [chosen, renamed]);

  if (!runs) {
    return (
      <Empty title="Looking for runs">
        <p>They are listed as soon as VoxSoft has answered.</p>
      </Empty>
    );
  }
  if (runs.rows.length === 0 && runs.trash.length === 0) {
    return (
      <Empty title="No runs yet">
        <p>
          Solve a design, start a study or a calibration: each is kept in <code>{runs.folder}</code>{" "}
          and listed here. A zipped run folder can be dropped on the page.
        </p>
        <Button kind="primary" onClick={() => setMode("optimize")}>
          Set up a study
        </Button>
      </Empty>
    );
  }
  const again = trash ? null : runs.rows.find((row) => row.id === shown && row.again);
  const list = trash ? runs.trash : rows;
  return (
    <div className="runs">
      <div className="runs-bar">
        <input
          className="input filter"
          type="search"
          aria-label="Search the runs"
          placeholder="Search by name, kind or status"
          value={search}
          onChange={(event) => setSearch(event.target.value)}
        />
        <span className="muted" data-testid="run-count">
          {rows.length === 1 ? "1 run" : `${rows.length} runs`}
        </span>
        <Button
          disabled={chosen.length < 2}
          testId="compare-runs"
          onClick={() => {
            const [a, b] = chosen;
            if (!a || !b) return;
            send({ t: "compare", a, b });
            showPane("compare");
          }}
        >
          Compare two
        </Button>
        {runs.trash.length > 0 && (
          <Button pressed={trash} onClick={() => showTrash(!trash)}>
            Trash ({runs.trash.length})
          </Button>
        )}
      </div>
      <div className="runs-list">
        {trash ? (
          <Trash rows={runs.trash} />
        ) : (
          <Table
            label="Runs on disk"
            testId="runs-table"
            columns={columns}
            rows={list}
            rowKey={(row) => row.id}
            selected={new Set(shown === null ? [] : [shown])}
            onChoose={(row) => {
              if (renamed !== null) return;
              show(row.id);
              open(row, false);
            }}
            empty={<p className="section muted">No run is meant by this search.</p>}
          />
        )}
      </div>
      {again && <Reproduce key={again.id} job={again.id} />}
    </div>
  );
}

function Rename(props: { row: RunRow; onDone(): void }) {
  const { row } = props;
  const [name, setName] = useState(row.name);
  const commit = () => {
    const next = name.trim();
    if (next && next !== row.name) send({ t: "run_rename", id: row.id, name: next });
    props.onDone();
  };
  return (
    <input
      className="input words"
      aria-label={`New name of ${row.name}`}
      // biome-ignore lint/a11y/noAutofocus: the field was asked for, to type into it
      autoFocus
      value={name}
      onClick={(event) => event.stopPropagation()}
      onChange={(event) => setName(event.target.value)}
      onBlur={commit}
      onKeyDown={(event) => {
        event.stopPropagation();
        if (event.key === "Enter") commit();
        else if (event.key === "Escape") props.onDone();
      }}
    />
  );
}

function Trash(props: { rows: readonly RunRow[] }) {
  const columns: Column<RunRow>[] = [
    { key: "name", title: "Deleted", cell: (row) => row.name, sort: (row) => row.name },
    { key: "kind", title: "Kind", cell: (row) => KINDS[row.kind] },
    { key: "when", title: "When", cell: (row) => ago(row.when, Date.now()), sort: (r) => r.when },
    {
      key: "restore",
      title: <span className="visually-hidden">Actions</span>,
      right: true,
      cell: (row) => (
        <Button
          label={`Restore ${row.name}`}
          onClick={() => send({ t: "run_restore", id: row.id })}
        >
          Restore
        </Button>
      ),
    },
  ];
  return (
    <Table
      label="Deleted runs"
      testId="trash-table"
      columns={columns}
      rows={props.rows}
      rowKey={(row) => row.id}
      empty={<p className="section muted">The trash is empty.</p>}
    />
  );
}
