// One hash over everything that decides the bundle, written beside it as `SOURCE`.
// A Python test computes the same hash, so that a bundle older than its sources is noticed
// where no Node is installed.
import { createHash } from "node:crypto";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import type { Plugin } from "vite";

const ROOTS = ["src", "public"];
const FILES = [
  ".npmrc",
  "bundle-source.ts",
  "index.html",
  "package-lock.json",
  "package.json",
  "tsconfig.json",
  "viewer.html",
  "vite.config.ts",
  "vite.viewer.config.ts",
];

function* walk(folder: string, prefix: string): Generator<string> {
  if (!existsSync(folder)) return;
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = `${prefix}/${entry.name}`;
    if (entry.isDirectory()) yield* walk(join(folder, entry.name), path);
    else yield path;
  }
}

export function hashOfSources(root: string): string {
  const paths = [...FILES];
  for (const folder of ROOTS) paths.push(...walk(join(root, folder), folder));
  paths.sort((a, b) => (a < b ? -1 : a > b ? 1 : 0));
  const total = createHash("sha256");
  for (const path of paths) {
    const content = createHash("sha256")
      .update(readFileSync(join(root, path)))
      .digest("hex");
    total.update(`${path} ${content}\n`);
  }
  return total.digest("hex");
}

export function bundleSource(root: string): Plugin {
  return {
    name: "voxsoft-bundle-source",
    apply: "build",
    generateBundle() {
      this.emitFile({ type: "asset", fileName: "SOURCE", source: `${hashOfSources(root)}\n` });
    },
  };
}
