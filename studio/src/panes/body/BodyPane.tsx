import { Empty, Section } from "../../controls/Choice";
import { cavityName } from "../../controls/cavities";
import { formatKind } from "../../controls/kinds";
import { formatQuantity, formatSpan } from "../../controls/units";
import { useStudio } from "../../store/studio";
import { Findings } from "./Findings";
import "./body.css";

/** Data of the mesh: counts, mass, cavities, and the findings of the check. */
export default function BodyPane() {
  const body = useStudio((state) => state.body);
  if (!body) {
    return (
      <Empty title="No body yet">
        <p>Open a template or a design file; its voxels, cavities and mass are listed here.</p>
      </Empty>
    );
  }
  const size = body.bounds[1].map((high, axis) => high - (body.bounds[0][axis] ?? 0));
  const facts: [string, string][] = [
    ["Size", size.map((length) => formatQuantity(length, "m", 3)).join(" × ")],
    ["Voxel size", formatQuantity(body.voxel_size, "m")],
    ["Voxels", body.voxels.toLocaleString("en")],
    ["Vertices", body.vertices.toLocaleString("en")],
    ["Tetrahedra", body.tets.toLocaleString("en")],
    ["Mass", formatKind(body.mass, "mass")],
    ["Volume", formatQuantity(body.volume, "m^3")],
    ["Meshed in", formatSpan(body.seconds)],
  ];
  return (
    <div className="pane">
      <Section title="Mesh">
        <dl className="facts">
          {facts.map(([name, value]) => (
            <div key={name}>
              <dt>{name}</dt>
              <dd>{value}</dd>
            </div>
          ))}
        </dl>
      </Section>
      <Section title="Parts">
        {body.parts.map((part) => (
          <div key={part.name} className="facts-row">
            <span>
              <i className="swatch" style={{ background: part.color }} />
              {part.name}
            </span>
            <span className="muted">{part.material}</span>
          </div>
        ))}
      </Section>
      <Section title="Cavities">
        {body.cavities.length === 0 && <p className="muted">None: no air is enclosed.</p>}
        {body.cavities.map((cavity, index) => (
          <div key={cavity.center.join()} className="facts-row">
            <span>
              <i className={`swatch cavity-${index % 6}`} />
              {cavityName(cavity, index)}
            </span>
            <span>{formatQuantity(cavity.volume, "m^3")}</span>
          </div>
        ))}
        {body.leaks.map((leak) => (
          <p key={leak.point.join()} className="finding warning">
            <b>!</b>A chamber of {formatQuantity(leak.volume, "m^3")} is open near{" "}
            {leak.point.map((x) => formatQuantity(x, "m", 3)).join(", ")}.
          </p>
        ))}
      </Section>
      {body.findings.length > 0 && (
        <Section title="Check">
          <Findings findings={body.findings} />
        </Section>
      )}
    </div>
  );
}
