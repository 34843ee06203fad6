// Puts a picture that was drawn aside onto the one that is drawn, pixel for pixel.
import { GLSL3, Mesh, PlaneGeometry, Scene, ShaderMaterial, type Texture } from "three";
import { COPY_FRAGMENT, SKY_VERTEX } from "./shaders";

export class Copy {
  readonly scene = new Scene();
  private readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;

  constructor(texture: Texture) {
    this.mesh = new Mesh(
      new PlaneGeometry(2, 2),
      new ShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: SKY_VERTEX,
        fragmentShader: COPY_FRAGMENT,
        depthTest: false,
        depthWrite: false,
        uniforms: { uPicture: { value: texture } },
      }),
    );
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }
}
