import { useEffect, useRef } from "react";
import { Button, Empty } from "../controls/Choice";
import { cleaned, formatNumber, formatQuantity } from "../controls/units";
import { EMPTY } from "../panes/design/empty";
import { Transport } from "../run/Transport";
import { openDocument } from "../shell/actions";
import { chooseFace, useFace } from "../store/face";
import { usePage } from "../store/page";
import { send } from "../store/session";
import { useStudio } from "../store/studio";
import { setView, useShown, useView } from "../store/view";
import { isAsBuilt } from "./body/asBuilt";
import { ContactBanner } from "./cards/ContactBanner";
import { Cube } from "./cards/Cube";
import { EmptyStage } from "./cards/EmptyStage";
import { FaceCard } from "./cards/FaceCard";
import { ForceLegend } from "./cards/ForceLegend";
import { Legend } from "./cards/Legend";
import { OverlapBanner } from "./cards/OverlapBanner";
import { ViewBar } from "./cards/ViewBar";
import { viewport } from "./instance";
import "./view.css";
import "./hands/shapeHandle.css";

export default function ViewPane() {
  const box = useRef<HTMLDivElement>(null);
  const view = viewport();
  const body = useStudio((state) => state.body);
  useEffect(() => {
    if (!box.current) return;
    view.attach(box.current);
    return () => view.detach();
  }, [view]);
  return (
    <div className="view-pane">
      <div className="view-stage" ref={box}>
        {body ? (
          <>
            <ViewBar view={view} />
            <Legend />
            <Cube view={view} />
            <ForceLegend />
            <ScaleBar />
            <Badges />
            <Hover />
            <Picked />
            <Banner />
            <ContactBanner />
          </>
        ) : (
          <NoBody />
        )}
      </div>
      <Transport />
    </div>
  );
}

/** In place of a body: the way to a first one, or why there is none. */
function NoBody() {
  const document = useStudio((state) => state.document);
  if (!document) return <Welcome />;
  if (document.empty) return <EmptyStage />;
  if (document.valid || document.design) return null; // it is being meshed
  return (
    <div className="no-body">
      <Empty title="No body yet">
        <p>It appears once the errors of the design are fixed.</p>
      </Empty>
    </div>
  );
}

/** Before anything is open: the designs to start from. */
function Welcome() {
  const templates = useStudio((state) => state.hello?.templates);
  return (
    <div className="welcome" data-testid="welcome">
      <Empty title="Start from a design">
        <p>
          Or drop a .toml, a mesh such as .stl or .vtu, a .npy, or a run folder (.zip), anywhere on
          the page.
        </p>
        <div className="welcome-grid">
          {[EMPTY, ...(templates ?? [])].map((template) => (
            <button
              key={template.name}
              type="button"
              className="welcome-card"
              data-testid={`template-${template.name}`}
              onClick={() => openDocument({ t: "open", what: "template", name: template.name })}
            >
              <strong>{template.name}</strong>
              <span className="muted">{template.title}</span>
            </button>
          ))}
        </div>
      </Empty>
    </div>
  );
}

function ScaleBar() {
  const { barLength, barPixels } = useShown();
  if (!(barPixels > 0)) return null;
  return (
    <div className="scale-bar" style={{ width: barPixels }} aria-hidden="true">
      {formatQuantity(barLength, "m", 3)}
    </div>
  );
}

function Badges() {
  const exaggeration = useView((view) => view.exaggeration);
  const tape = useView((view) => view.tape);
  const recording = useShown((shown) => shown.recording);
  const fps = useShown((shown) => shown.fps);
  const latency = useShown((shown) => shown.latency);
  const playing = useStudio((state) => state.stat?.state === "playing");
  return (
    <div className="badges">
      {exaggeration !== 1 && (
        <button
          type="button"
          className="badge warn"
          data-testid="exaggeration-badge"
          onClick={() => setView({ exaggeration: 1 })}
        >
          deformation × {formatNumber(exaggeration, 3)}
        </button>
      )}
      {tape && <span className="badge">tape: click two points of the body, Esc ends</span>}
      <HiddenShape />
      {recording && <span className="badge bad">● recording</span>}
      {playing && fps > 0 && (
        <span className="badge" data-testid="fps">
          {fps} frames/s{latency !== null ? ` · answers in ${Math.round(latency)} ms` : ""}
        </span>
      )}
    </div>
  );
}

/** Says why the chosen shape is not seen: it is drawn over the body as it was built alone. */
function HiddenShape() {
  const shape = useView((view) => view.shape);
  const design = usePage((page) => page.mode === "design");
  const asBuilt = useStudio((state) => isAsBuilt(state.stat));
  const shapes = useStudio((state) => state.document?.source?.shapes);
  const there = shape !== null && shape in ((shapes as object | undefined) ?? {});
  if (!there || !design || asBuilt) return null;
  return (
    <button
      type="button"
      className="badge"
      data-testid="hidden-shape"
      title="Go back to the unloaded shape, where shapes are drawn and moved"
      onClick={() => send({ t: "reset" })}
    >
      {shape} is drawn over the unloaded body: reset
    </button>
  );
}

function Hover() {
  const hover = useShown((shown) => shown.hover);
  const field = useView((view) => view.field);
  const about = useStudio((state) => state.hello?.fields.find((one) => one.id === field));
  if (!hover || !about) return null;
  return (
    <div className="hover" style={{ transform: `translate(${hover.x + 14}px, ${hover.y + 16}px)` }}>
      {formatQuantity(hover.value, about.unit)}
    </div>
  );
}

function Picked() {
  const picked = useStudio((state) => state.picked);
  const fields = useStudio((state) => state.hello?.fields);
  const facts = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!picked || !useFace.getState().byKey) return;
    useFace.setState({ byKey: false });
    facts.current?.querySelector<HTMLElement>("select, button")?.focus();
  }, [picked]);
  if (!picked) return null;
  const place = (point: readonly number[]) =>
    point.map((x) => formatNumber(x * 1000, 4)).join(", ");
  return (
    <aside className="picked" data-testid="picked" aria-label="What is here">
      <header>
        <strong>This place</strong>
        <Button
          icon
          kind="quiet"
          label="Close"
          onClick={() => {
            chooseFace(null);
            useStudio.setState({ picked: null });
          }}
        >
          ×
        </Button>
      </header>
      <div className="picked-facts" ref={facts}>
        <FaceCard />
        <dl className="facts">
          <div>
            <dt>Unloaded</dt>
            <dd>{place(picked.rest)} mm</dd>
          </div>
          <div>
            <dt>Now</dt>
            <dd>{place(picked.position)} mm</dd>
          </div>
          {picked.values.map((value) => (
            <div key={value.field}>
              <dt>{fields?.find((one) => one.id === value.field)?.title ?? value.name}</dt>
              <dd>
                {value.value === null
                  ? "–"
                  : formatQuantity(cleaned(value.value, value.unit), value.unit)}
              </dd>
            </div>
          ))}
        </dl>
        <Button testId="plot-picked" onClick={() => send({ t: "probe", vertex: picked.vertex })}>
          Plot over time
        </Button>
      </div>
    </aside>
  );
}

/** Banner in the picture of a diverged state; a healthy lamp beside it would lie. */
function Banner() {
  const diverged = useShown((shown) => shown.diverged);
  const stat = useStudio((state) => state.stat);
  // Walls that a diverged body has in each other are no news.
  if (!diverged && stat?.state !== "diverged") return <OverlapBanner />;
  return (
    <div className="view-banner" role="alert" data-testid="diverged">
      <p>
        <strong>Diverged</strong>
        {stat?.state === "diverged" ? stat.sentence.replace(/^Diverged/, "") : " by this frame."}
      </p>
      <Button onClick={() => send({ t: "reset" })}>Back to the unloaded shape</Button>
    </div>
  );
}
