/** Tells when the graphics have done all that was asked of them before. */
export class Stopwatch {
  private running = false;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly done: (milliseconds: number) => void,
  ) {}

  /** Measure from now, unless an earlier measurement still runs. */
  start(): void {
    const { gl } = this;
    const fence = this.running ? null : gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return;
    this.running = true;
    gl.flush();
    const start = performance.now();
    const look = () => {
      // The state of a fence changes between tasks only, and not at all once the context is lost.
      if (gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED && !gl.isContextLost()) {
        setTimeout(look, 2);
        return;
      }
      gl.deleteSync(fence);
      this.running = false;
      this.done(performance.now() - start);
    };
    setTimeout(look, 0);
  }
}
