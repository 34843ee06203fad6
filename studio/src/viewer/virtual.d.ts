declare module "virtual:voxsoft-core" {
  /** The WebAssembly core, base64; empty where it was not built. */
  const core: string;
  export default core;
}
