import { useEffect, useRef } from "react";
import { Matrix4 } from "three";
import type { StandardView } from "../drawing/camera";
import type { Viewport } from "../viewport";

const FACES: readonly [StandardView, string, string][] = [
  ["front", "Front", "rotateX(-90deg) translateZ(26px)"],
  ["back", "Back", "rotateX(90deg) rotateZ(180deg) translateZ(26px)"],
  ["right", "Right", "rotateY(90deg) rotateZ(-90deg) translateZ(26px)"],
  ["left", "Left", "rotateY(-90deg) rotateZ(90deg) translateZ(26px)"],
  ["top", "Top", "translateZ(26px)"],
  ["bottom", "Bottom", "rotateX(180deg) translateZ(26px)"],
];

/** A cube that turns with the view; its faces are buttons to the standard views. */
export function Cube(props: { view: Viewport }) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const matrix = new Matrix4();
    let shown = "";
    return props.view.onDrawn(() => {
      if (!box.current) return;
      matrix.makeRotationFromQuaternion(props.view.rig.orientation).transpose();
      const m = matrix.elements;
      // CSS has y pointing down: flip it on both sides of the rotation.
      const css = [
        m[0],
        -m[1]!,
        m[2],
        0,
        -m[4]!,
        m[5],
        -m[6]!,
        0,
        m[8],
        -m[9]!,
        m[10],
        0,
        0,
        0,
        0,
        1,
      ];
      const turned = `matrix3d(${css.map((x) => (x ?? 0).toFixed(5)).join(",")})`;
      if (turned !== shown) box.current.style.transform = turned;
      shown = turned;
    });
  }, [props.view]);
  return (
    <nav className="cube" aria-label="Standard views">
      <div className="cube-box" ref={box}>
        {FACES.map(([name, title, transform]) => (
          <button
            key={name}
            type="button"
            className="cube-face"
            data-testid={`look-${name}`}
            style={{ transform }}
            onClick={() => props.view.look(name)}
          >
            {title}
          </button>
        ))}
      </div>
    </nav>
  );
}
