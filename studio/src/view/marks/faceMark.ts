// The face that was pressed, laid over the body in the color of chosen things.
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  Vector3,
} from "three";
import type { Face } from "../hands/face";
import type { Places } from "../hands/target";

export class FaceMark {
  readonly mesh = new Mesh(
    new BufferGeometry(),
    new MeshBasicMaterial({
      color: "#ffaa33",
      transparent: true,
      opacity: 0.45,
      side: DoubleSide,
      depthWrite: false,
      // In front of the face that it lies on.
      polygonOffset: true,
      polygonOffsetFactor: -2,
      polygonOffsetUnits: -2,
    }),
  );
  private face: Face | null = null;

  constructor() {
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 5;
    this.mesh.visible = false;
  }

  /** Draw a face where the body is now; nothing where it is none of this body. */
  place(face: Face | null, places: Places | null, exaggeration: number): void {
    const shown = face && places?.topology.id === face.topology ? face : null;
    this.mesh.visible = shown !== null;
    if (!shown || !places) return;
    if (this.face !== shown) {
      const positions = new Float32Array(3 * shown.triangles.length);
      this.mesh.geometry.dispose();
      this.mesh.geometry = new BufferGeometry();
      this.mesh.geometry.setAttribute("position", new BufferAttribute(positions, 3));
      this.face = shown;
    }
    const attribute = this.mesh.geometry.getAttribute("position");
    const point = new Vector3();
    shown.triangles.forEach((vertex, i) => {
      places.place(vertex, exaggeration, point);
      attribute.setXYZ(i, point.x, point.y, point.z);
    });
    attribute.needsUpdate = true;
  }
}
