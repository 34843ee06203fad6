// Backdrop of the body: sky and ground. While the camera stands still they are drawn once
// and kept, as without a graphics card they would cost more than the body in front of them.
import {
  type Camera,
  NearestFilter,
  Scene,
  Vector2,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { Copy } from "./copy";
import { Ground, Sky } from "./ground";

export class Backdrop {
  readonly ground = new Ground();
  private readonly sky = new Sky();
  private readonly scene = new Scene();
  private readonly kept = new WebGLRenderTarget(1, 1, {
    depthBuffer: false,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
  });
  private readonly copy = new Copy(this.kept.texture);
  private readonly size = new Vector2();
  private keptKey = "";
  private lastKey = "";
  private theme = 0;

  constructor() {
    this.scene.add(this.sky.mesh, this.ground.mesh);
  }

  recolor(): void {
    this.sky.recolor();
    this.ground.recolor();
    this.theme += 1;
  }

  /** Draw onto the target of the renderer; it covers every pixel. */
  paint(renderer: WebGLRenderer, camera: Camera): void {
    const key = this.key(renderer, camera);
    // A camera that moves makes another picture each time: a picture asked for twice is kept.
    if (key !== this.keptKey && key === this.lastKey) this.keep(renderer, camera, key);
    this.lastKey = key;
    renderer.render(key === this.keptKey ? this.copy.scene : this.scene, camera);
  }

  private keep(renderer: WebGLRenderer, camera: Camera, key: string): void {
    const before = renderer.getRenderTarget();
    this.kept.setSize(this.size.x, this.size.y);
    renderer.setRenderTarget(this.kept);
    renderer.render(this.scene, camera);
    renderer.setRenderTarget(before);
    this.keptKey = key;
  }

  private key(renderer: WebGLRenderer, camera: Camera): string {
    const { mesh, cell } = this.ground;
    renderer.getDrawingBufferSize(this.size);
    camera.updateMatrixWorld();
    return [
      this.theme,
      ...this.size,
      ...camera.matrixWorld.elements,
      ...camera.projectionMatrix.elements,
      mesh.visible,
      cell,
      ...mesh.position,
      mesh.scale.x,
    ].join(" ");
  }
}
