import { useRef, useState } from "react";
import { useAway } from "../../controls/away";
import { Button, Select, Toggle } from "../../controls/Choice";
import { NumberField } from "../../controls/NumberField";
import { Icon } from "../../shell/icons";
import { type Appearance, appearanceOf } from "../../store/appearance";
import { useStudio } from "../../store/studio";
import { type SectionAxis, setView, useShown, useView } from "../../store/view";
import { COLORMAPS, type ColormapName } from "../body/colormaps";
import { SCHEMES, type Scheme } from "../hands/schemes";
import { recordGif, recordWebm, savePicture } from "../recorder";
import type { Viewport } from "../viewport";

const APPEARANCES: { value: Appearance; label: string }[] = [
  { value: "smooth", label: "Smooth shape" },
  { value: "voxels", label: "Voxels" },
  { value: "tets", label: "Tetrahedra" },
  { value: "wireframe", label: "Wireframe" },
];

/** The tools over the picture. */
export function ViewBar(props: { view: Viewport }) {
  const view = useView();
  // A new list in the selector would be another state each time, for ever, while the server has not said hello.
  const known = useStudio((state) => state.hello?.fields) ?? [];
  const touches = useStudio((state) => state.body?.touches ?? false);
  const fields = known.filter((field) => touches || !field.contact);
  const smooth = useStudio((state) => state.body?.smooth ?? false);
  const drawn = useStudio((state) => appearanceOf(view, state.body));
  const recording = useShown((shown) => shown.recording);
  const [open, setOpen] = useState<"more" | "film" | null>(null);
  const menus = useRef<HTMLDivElement>(null);
  useAway(menus, open !== null, (by) => {
    // While a film is made one plays with the body; the button that stops it stays at hand.
    if (by === "escape" || !recording) setOpen(null);
  });
  const appearances = APPEARANCES.map((one) => ({
    ...one,
    disabled: one.value === "smooth" && !smooth,
  }));
  const colors = [
    ...fields.map((field) => ({ value: String(field.id), label: field.title })),
    { value: "parts", label: "Materials" },
  ];
  return (
    <div className="view-bar" role="toolbar" aria-label="View">
      <Select
        bare
        label="Show as"
        value={drawn}
        options={appearances}
        onChange={(value) =>
          setView(
            value === "smooth"
              ? { appearance: value, cavities: false }
              : { appearance: value as Appearance },
          )
        }
      />
      <Select
        bare
        label="Color by"
        value={view.coloring === "parts" ? "parts" : String(view.field)}
        options={colors}
        onChange={(value) =>
          setView(
            value === "parts"
              ? { coloring: "parts" }
              : { coloring: "field", field: Number(value), range: "auto" },
          )
        }
      />
      <Button icon kind="quiet" label="Fit (F)" testId="fit" onClick={() => props.view.fit()}>
        <Icon name="fit" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Section plane (X)"
        pressed={view.section !== "off"}
        testId="section"
        onClick={() => props.view.toggleSection()}
      >
        <Icon name="section" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Cavities (C)"
        pressed={view.cavities}
        testId="cavities"
        onClick={() => setView({ cavities: !view.cavities })}
      >
        <Icon name="layers" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Undeformed ghost (G)"
        pressed={view.ghost}
        testId="ghost"
        onClick={() => setView({ ghost: !view.ghost })}
      >
        <Icon name="ghost" />
      </Button>
      <Button
        icon
        kind="quiet"
        label="Measuring tape (M)"
        pressed={view.tape}
        testId="tape"
        onClick={() => setView({ tape: !view.tape })}
      >
        <Icon name="tape" />
      </Button>
      <div className="view-menus" ref={menus}>
        <Button
          icon
          kind="quiet"
          label="More of the view"
          pressed={open === "more"}
          testId="view-more"
          onClick={() => setOpen(open === "more" ? null : "more")}
        >
          <Icon name="settings" />
        </Button>
        <Button
          icon
          kind="quiet"
          label="Picture and film"
          pressed={open === "film"}
          testId="view-film"
          onClick={() => setOpen(open === "film" ? null : "film")}
        >
          <Icon name="camera" />
        </Button>
        {open === "more" && <More />}
        {open === "film" && <Film view={props.view} close={() => setOpen(null)} />}
      </div>
      {view.section !== "off" && <SectionTools view={props.view} />}
    </div>
  );
}

function More() {
  const view = useView();
  return (
    <div className="view-menu" data-testid="view-menu">
      <Select
        label="Colors"
        value={view.colormap}
        options={COLORMAPS}
        onChange={(value) => setView({ colormap: value as ColormapName })}
      />
      <Select
        label="Steps"
        value={String(view.bands)}
        options={[{ value: "0", label: "smooth" }, "6", "8", "10", "16"]}
        onChange={(value) => setView({ bands: Number(value) })}
      />
      <NumberField
        label="Exaggerate"
        value={view.exaggeration}
        min={0}
        max={20}
        step={0.5}
        slider
        fallback={1}
        onChange={(value) => setView({ exaggeration: value })}
      />
      <Select
        label="Mouse as in"
        value={view.scheme}
        options={SCHEMES}
        onChange={(value) => setView({ scheme: value as Scheme })}
      />
      <div className="view-checks">
        <Toggle label="Voxel edges" checked={view.edges} onChange={(edges) => setView({ edges })} />
        <Toggle
          label="Symbols"
          checked={view.symbols}
          onChange={(symbols) => setView({ symbols })}
        />
        <Toggle
          label="Contact forces"
          checked={view.forces}
          onChange={(forces) => setView({ forces })}
        />
        <Toggle
          label="Mark min and max"
          checked={view.extremes}
          onChange={(extremes) => setView({ extremes })}
        />
        <Toggle label="Ground grid" checked={view.grid} onChange={(grid) => setView({ grid })} />
        <Toggle
          label="Orthographic"
          checked={view.orthographic}
          onChange={(orthographic) => setView({ orthographic })}
        />
      </div>
    </div>
  );
}

const AXES: { value: SectionAxis; label: string }[] = [
  { value: "x", label: "across x" },
  { value: "y", label: "across y" },
  { value: "z", label: "across z" },
];

function SectionTools(props: { view: Viewport }) {
  const { section, sectionAt, sectionFlipped } = useView();
  const axes = section === "free" ? [...AXES, { value: "free", label: "turned" }] : AXES;
  return (
    <div className="view-tools" data-testid="section-tools">
      <Select
        bare
        label="Section axis"
        value={section}
        options={axes}
        onChange={(value) => {
          if (value === "x" || value === "y" || value === "z") props.view.cutAcross(value);
        }}
      />
      <input
        className="slider"
        type="range"
        aria-label="Section position"
        min={0}
        max={1}
        step={0.005}
        value={sectionAt}
        onChange={(event) => setView({ sectionAt: Number(event.target.value) })}
      />
      <Button
        kind="quiet"
        pressed={sectionFlipped}
        onClick={() => setView({ sectionFlipped: !sectionFlipped })}
      >
        Other side
      </Button>
    </div>
  );
}

// Outlives the menu, which may be shut while a film is recorded.
let stopRecording: (() => void) | null = null;

function Film(props: { view: Viewport; close(): void }) {
  const recording = useShown((shown) => shown.recording);
  if (recording) {
    return (
      <div className="view-menu">
        <Button kind="primary" testId="stop-recording" onClick={() => stopRecording?.()}>
          Stop and save the {recording === "gif" ? "GIF" : "WebM"}
        </Button>
      </div>
    );
  }
  return (
    <div className="view-menu" data-testid="film-menu">
      {[1, 2, 4].map((scale) => (
        <Button
          key={scale}
          kind="quiet"
          testId={`picture-${scale}`}
          onClick={() => {
            void savePicture(props.view, scale);
            props.close();
          }}
        >
          Picture (PNG){scale > 1 ? `, ${scale} times the size` : ""}
        </Button>
      ))}
      <Button
        kind="quiet"
        testId="record-webm"
        onClick={() => {
          stopRecording = recordWebm(props.view);
        }}
      >
        Record a film (WebM)
      </Button>
      <Button
        kind="quiet"
        testId="record-gif"
        onClick={async () => {
          stopRecording = await recordGif(props.view);
        }}
      >
        Record an animation (GIF)
      </Button>
    </div>
  );
}
