import { useEffect, useRef, useState } from "react";
import { Button } from "../controls/Choice";
import icon from "../icon.svg";
import type { RecentFile, Robot } from "../protocol";
import { TAKEN, upload } from "../shell/DropZone";
import { TABLES } from "../shell/dropTable";
import { Icon } from "../shell/icons";
import { BodyPicture } from "../shell/VersionsSheet";
import { openSheet } from "../store/page";
import { useStudio } from "../store/studio";
import { whenWords } from "../store/when";
import { openFromStart, openRobot } from "./begin";
import { NewRobot } from "./NewRobot";
import { addressOf, TUTORIALS } from "./tutorials";
import "./start.css";

const NO_ROBOTS: readonly Robot[] = [];
const NO_FILES: readonly RecentFile[] = [];
const NOT_SAVED = "not saved yet";

function openRecent(file: RecentFile): void {
  if (file.unsaved) openFromStart("unsaved", file.unsaved);
  else openFromStart("file", file.path);
}

/** The first screen: go on, begin anew, open, or look at a finished robot. */
export function Start() {
  const start = useStudio((state) => state.start);
  const document = useStudio((state) => state.document);
  const [asking, ask] = useState(false);
  const picker = useRef<HTMLInputElement>(null);
  const screen = useRef<HTMLDivElement>(null);
  const robots = start?.robots ?? NO_ROBOTS;
  const recent = start?.recent ?? NO_FILES;
  const last = start?.fresh ? recent[0] : undefined;
  useEffect(() => {
    const before = globalThis.document.activeElement;
    screen.current?.querySelector<HTMLElement>("[data-first]")?.focus();
    return () => {
      if (before instanceof HTMLElement && before.isConnected) before.focus();
    };
  }, []);
  return (
    <div
      ref={screen}
      className="start-screen"
      role="dialog"
      aria-modal="true"
      aria-label="Start"
      data-testid="start"
    >
      <div className="start-page">
        <header className="start-head">
          <Hero robot={robots.find((one) => one.moving)} />
          <div className="start-words">
            <h1>
              <img src={icon} alt="" width="30" height="30" />
              VoxSoft
            </h1>
            <p className="start-lead">Describe a soft robot, see it move, let it be improved.</p>
            <div className="start-buttons">
              {last ? (
                <button
                  type="button"
                  className="start-main"
                  data-first
                  data-testid="start-go-on"
                  onClick={() => openRecent(last)}
                >
                  <strong>Go on with {last.name}</strong>
                  <span>{last.folder || NOT_SAVED}</span>
                </button>
              ) : (
                document &&
                start &&
                !start.fresh && (
                  <button
                    type="button"
                    className="start-main"
                    data-first
                    data-testid="start-go-on"
                    onClick={() => openSheet(null)}
                  >
                    <strong>Go on with {document.name || "the open design"}</strong>
                    <span>{document.dirty ? "with changes that were not saved" : "as it is"}</span>
                  </button>
                )
              )}
              <span className="start-row">
                <button
                  type="button"
                  className="button primary"
                  data-first={last === undefined && start?.fresh ? true : undefined}
                  aria-expanded={asking}
                  data-testid="start-new"
                  onClick={() => ask(!asking)}
                >
                  New…
                </button>
                <Button testId="start-open" onClick={() => picker.current?.click()}>
                  Open a file…
                </Button>
                <Button
                  testId="start-empty"
                  onClick={() => openFromStart("template", "empty")}
                  title="A design without shapes"
                >
                  Empty stage
                </Button>
                <Button kind="quiet" testId="start-tour" onClick={() => openSheet("tour")}>
                  Take the tour
                </Button>
              </span>
            </div>
            <input
              ref={picker}
              className="visually-hidden"
              type="file"
              tabIndex={-1}
              aria-label="Open from the start screen"
              accept={[...TAKEN, ...TABLES].join(",")}
              onChange={(event) => {
                const files = [...(event.target.files ?? [])];
                event.target.value = "";
                if (files.length > 0) openSheet(null);
                for (const file of files) void upload(file);
              }}
            />
          </div>
          <span className="start-close">
            <Button
              icon
              kind="quiet"
              label="Close the start screen (Escape)"
              testId="start-close"
              onClick={() => openSheet(null)}
            >
              <Icon name="close" />
            </Button>
          </span>
        </header>
        {asking && <NewRobot ways={start?.ways ?? []} robots={robots} />}
        <section aria-label="Finished robots">
          <h2>Finished robots</h2>
          <ul className="robots">
            {robots.map((robot) => (
              <li key={robot.name}>
                <RobotCard robot={robot} />
              </li>
            ))}
          </ul>
        </section>
        <div className="start-columns">
          <section aria-label="Recent">
            <h2>Recent</h2>
            {recent.length === 0 ? (
              <p className="muted">What you save, open or begin is listed here.</p>
            ) : (
              <ul className="start-list is-pictured" data-testid="start-recent">
                {recent.map((file) => (
                  <li key={file.path || file.unsaved}>
                    <button
                      type="button"
                      title={file.path || `${file.name}, ${NOT_SAVED}`}
                      onClick={() => openRecent(file)}
                    >
                      <BodyPicture url={file.picture} />
                      <strong>{file.name}</strong>
                      <span className="muted">{whenWords(file.when)}</span>
                      <span className="muted folder">{file.folder || NOT_SAVED}</span>
                    </button>
                  </li>
                ))}
              </ul>
            )}
          </section>
          <section aria-label="Tutorials">
            <h2>Tutorials</h2>
            <ul className="start-list">
              {TUTORIALS.map((tutorial) => (
                <li key={tutorial.page}>
                  <a href={addressOf(tutorial)} target="_blank" rel="noreferrer">
                    <strong>{tutorial.title}</strong>
                    <span className="muted">{tutorial.about}</span>
                    <span className="visually-hidden">, opens in a new tab</span>
                  </a>
                </li>
              ))}
            </ul>
          </section>
        </div>
      </div>
    </div>
  );
}

/** The first robot on its way under pressure and back; at rest for whom movement disturbs. */
function Hero(props: { robot: Robot | undefined }) {
  const { robot } = props;
  if (!robot) return <span className="start-hero" />;
  return (
    <picture className="start-hero">
      <source srcSet={robot.picture} media="(prefers-reduced-motion: reduce)" />
      <img src={robot.moving} alt={`${robot.title} under pressure`} width="480" height="320" />
    </picture>
  );
}

function RobotCard(props: { robot: Robot }) {
  const { robot } = props;
  return (
    <button
      type="button"
      className="robot"
      data-testid={`robot-${robot.name}`}
      onClick={() => openRobot("robot", robot.name)}
    >
      <img src={robot.picture} alt="" width="480" height="320" loading="lazy" />
      <strong>{robot.title}</strong>
      <span className="muted">{robot.sentence}</span>
    </button>
  );
}
